// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/register_by_heights.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/error.hpp"
#include "core/units.hpp"
#include "pipeline/reconstruction/adjustment/register_heights.hpp"
#include "workflows/reconstruction/coarse_dem.hpp"

namespace waymark::workflows {
namespace {

constexpr std::int64_t kNodes = 1024;  // across each DEM

std::string dem_of_map(const RegisterRequest& request, const geodb::MapStore& map) {
  if (!request.dem.empty()) return request.dem;
  if (!map.has_dem_coverage())
    throw Error(ErrorCode::usage, "the map has no elevation tiles to compare with the DEM", request.map,
                "name the DEM of the map by --dem, in the map's coordinates");
  return "GPKG:" + request.map + ":dem";
}

std::optional<Crs> target_crs(const RegisterRequest& request, const Crs& map) {
  if (!request.crs.empty()) return Crs::from_text(request.crs);
  if (map.kind() == CrsKind::projected) return map;
  return std::nullopt;
}

// Only the part within reach, if one is given: other places cannot be mistaken then.
pipeline::CoarseHeights reference_heights(const RegisterRequest& request, const CoarseDem& reference,
                                          const pipeline::SurfaceGrid& map) {
  if (!std::isfinite(request.rules.max_shift)) return reference.sample_all(kNodes);
  const double side = double(std::max(map.columns, map.rows)) * map.cell;
  const Eigen::Vector2d middle(map.west + double(map.columns) * map.cell / 2,
                               map.north - double(map.rows) * map.cell / 2);
  return reference.sample(middle, side * request.rules.max_scale + 2 * request.rules.max_shift, kNodes);
}

std::string text_of(const pipeline::HeightRegistration& found) {
  const pipeline::LevelSimilarity& s = found.reference_from_map;
  const auto sd = [&](int k) { return std::sqrt(found.covariance(k, k)); };
  return fmt::format(
      "scale {:.5g} ({:.2g}), yaw {:.3f} ({:.2g}) degrees, middle at {:.1f}, {:.1f}, {:.1f} ({:.2g}, {:.2g}, "
      "{:.2g}) m; standard deviations in parentheses\n  {} cells differ by {:.3g} m in height (root mean "
      "square) at a relief of {:.3g} m; {}\n",
      std::exp(s.log_scale), std::exp(s.log_scale) * sd(3), to_degrees(Radians{s.yaw}).value,
      to_degrees(Radians{sd(2)}).value, found.pivot.x(), found.pivot.y(), found.pivot.z(), sd(0), sd(1),
      sd(4), found.cells, found.residual, found.relief,
      std::isfinite(found.next_best_residual)
          ? fmt::format("at the next best place by {:.3g} m", found.next_best_residual)
          : std::string("no other place is similar"));
}

}  // namespace

MapPlace register_by_heights(const RegisterRequest& request, const geodb::MapStore& map) {
  const CoarseDem own(dem_of_map(request, map), map.crs());
  const CoarseDem reference(request.catalogue, target_crs(request, map.crs()));
  const pipeline::CoarseHeights heights = own.sample_all(kNodes);
  const pipeline::HeightRegistrationResult placed = pipeline::register_heights(
      heights, reference_heights(request, reference, heights.grid),
      {.max_scale = request.rules.max_scale, .placement = {.max_chance = request.rules.max_wrong}});
  if (!placed.found)
    throw Error(ErrorCode::input, "the map is not registered: " + placed.message, request.map,
                "pass a smaller --max-scale, or --within, if they are known; or a finer DEM");
  const pipeline::HeightRegistration& found = *placed.found;
  const pipeline::LevelSimilarity& s = found.reference_from_map;
  return {.move = {.plane = {.log_scale = s.log_scale, .yaw = s.yaw, .shift = s.shift},
                   .lift = s.lift,
                   .pivot = found.pivot,
                   .covariance = found.covariance},
          .crs = reference.map(),
          .text = text_of(found),
          .compared = std::int64_t(found.cells),
          .agreed = std::int64_t(found.cells),
          .disagreed = "",
          .residual = found.residual};
}

}  // namespace waymark::workflows
