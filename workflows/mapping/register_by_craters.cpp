// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/register_by_craters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.hpp"
#include "importers/tables/table.hpp"
#include "importers/tables/table_landmarks.hpp"
#include "workflows/registries.hpp"

namespace waymark::workflows {
namespace {

using localization::Circle;

constexpr double kUnstatedSd = 0.05, kMinSd = 0.02;  // of the diameter: not stated; a rim's centre at best
constexpr double kDiameterSd = 0.1;                  // of the logarithm, in map and catalogue alike
constexpr std::size_t kMaxCraters = 200;             // craters of a map that are compared, the largest

const std::string& crater_type() {
  static const std::string name = all_types()[find_type(all_types(), EvidenceModel::bowl).value()].name;
  return name;
}

std::optional<Circle> circle_of(const Landmark& l, const LandmarkType& type, double unit) {
  const FeatureValue& body = l.features.at(feature_index(type, type.body.feature));
  const double diameter = 2 * type.body.radius_per_value * body.value;
  if (!body.known() || !(diameter > 0)) return std::nullopt;
  const double stated = std::sqrt((l.covariance(0, 0) + l.covariance(1, 1)) / 2);
  const double sd = stated > 0 ? stated : kUnstatedSd * diameter;
  return Circle{.at = l.position.xyz.head<2>() * unit,
                .diameter = diameter,
                .position_sd = std::max(sd, kMinSd * diameter),
                .log_diameter_sd = kDiameterSd};
}

struct MapCraters {
  std::vector<Circle> circles = {};
  double height = 0;  ///< mean, metres
};

MapCraters craters_of(const geodb::MapStore& map) {
  MapCraters out;
  const LandmarkType* type = map.types().find(crater_type());
  if (type == nullptr)
    throw Error(ErrorCode::input, "the map has no craters, which register by a catalogue",
                map.path().string(), "find them first: `waymark craters --help`");
  map.visit(type->name, [&](Landmark&& l) {
    const auto circle = circle_of(l, *type, metres_of(map.crs()));
    if (!circle) return;
    out.circles.push_back(*circle);
    out.height += l.position.xyz.z();
  });
  out.height /= std::max(1.0, double(out.circles.size()));
  std::ranges::stable_sort(out.circles, std::ranges::greater{}, &Circle::diameter);
  if (out.circles.size() > kMaxCraters) out.circles.resize(kMaxCraters);
  return out;
}

struct Catalogue {
  std::vector<Circle> circles = {};
  Crs crs = Crs::local();
};

Catalogue read_catalogue(const RegisterRequest& request, const Crs& map) {
  const std::string crs = !request.crs.empty()               ? request.crs
                          : map.kind() == CrsKind::projected ? map.wkt2()
                                                             : std::string();
  const auto table =
      importers::open_table(request.catalogue, importers::TableFormat::by_name, "", crater_type());
  std::vector<Landmark> landmarks;
  importers::TableImport how;
  how.type = crater_type();
  how.columns = request.columns;
  how.map_crs = crs;
  const auto read = importers::import_table(*table, all_types(), how,
                                            [&](Landmark&& l) { landmarks.push_back(std::move(l)); });
  if (read.crs.kind() == CrsKind::geographic)
    throw Error(ErrorCode::usage, "the catalogue is in degrees, but a registration needs metres",
                request.catalogue, "pass a projected CRS of the body by --crs");
  Catalogue out{.crs = read.crs};
  const LandmarkType& type = *all_types().find(crater_type());
  for (const Landmark& l : landmarks)
    if (const auto circle = circle_of(l, type, metres_of(out.crs))) out.circles.push_back(*circle);
  return out;
}

std::string text_of(const localization::CircleRegistration& placed, std::size_t craters) {
  const localization::CircleFit& fit = *placed.fit;
  const auto sd = [&](int k) { return std::sqrt(fit.covariance(k, k)); };
  return fmt::format(
      "scale {:.5g} ({:.2g}), yaw {:.3f} ({:.2g}) degrees, middle at {:.1f}, {:.1f} ({:.2g}, {:.2g}) m; "
      "standard deviations in parentheses\n{} of {} craters match within {:.3g} m; wrong with a "
      "probability of "
      "{:.2g}\n",
      std::exp(fit.catalogue_from_map.log_scale), std::exp(fit.catalogue_from_map.log_scale) * sd(3),
      to_degrees(Radians{fit.catalogue_from_map.yaw}).value, to_degrees(Radians{sd(2)}).value, fit.pivot.x(),
      fit.pivot.y(), sd(0), sd(1), fit.matched, craters, fit.residual, placed.wrong);
}

}  // namespace

MapPlace register_by_craters(const RegisterRequest& request, const geodb::MapStore& map) {
  const MapCraters craters = craters_of(map);
  const Catalogue catalogue = read_catalogue(request, map.crs());
  const localization::CircleRegistration placed =
      localization::register_circles(craters.circles, catalogue.circles, request.rules);
  if (!placed.fit)
    throw Error(
        ErrorCode::input, "the map is not registered: " + placed.message, request.map,
        "pass a smaller --max-scale, or --within, if they are known; or a catalogue with more craters of "
        "that size");
  const localization::CircleFit& fit = *placed.fit;
  MapPlace out{.crs = catalogue.crs,
               .compared = std::int64_t(craters.circles.size()),
               .agreed = std::int64_t(fit.matched),
               .disagreed = "not in the catalogue",
               .residual = fit.residual};
  const double scale = std::exp(fit.catalogue_from_map.log_scale);
  out.move.plane = fit.catalogue_from_map;
  out.move.lift = (1 - scale) * craters.height;  // catalogues hardly state heights: theirs stays
  out.move.pivot << fit.pivot, craters.height;
  out.move.covariance.topLeftCorner<4, 4>() = fit.covariance;
  out.text = text_of(placed, craters.circles.size()) +
             fmt::format("  heights keep their zero at {:.1f} m\n", craters.height);
  return out;
}

}  // namespace waymark::workflows
