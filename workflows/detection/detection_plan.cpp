// SPDX-License-Identifier: Apache-2.0
#include "workflows/detection/detection_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/options/option_reader.hpp"
#include "core/text_file.hpp"
#include "importers/images/image.hpp"

namespace waymark::workflows {
namespace {

constexpr double kMinCrater = 6, kMinRock = 1, kMinTree = 0.1;  // pixels
constexpr const char* kUnused = "its georeference is not used";

struct SearchKind {
  const char* word;
  const char* type;
  std::vector<std::string> methods;  // the first is the default
  double min_diameter, max_diameter, smallest;
};

const std::vector<SearchKind>& kinds() {
  static const std::vector<SearchKind> all = {{"craters", "crater", {"bowl", "edges"}, 8, 0, kMinCrater},
                                              {"rocks", "rock", {"shadow", "classic"}, 1.5, 100, kMinRock},
                                              {"trees", "tree", {"imagery", "peaks", "lmf"}, 1, 0, kMinTree}};
  return all;
}

[[noreturn]] void throw_usage(const std::string& problem, const std::string& hint) {
  throw Error(ErrorCode::usage, problem, "", hint);
}

const SearchKind& find_kind(std::string word) {
  if (word == "crater" || word == "rock" || word == "tree") word += 's';
  for (const SearchKind& kind : kinds())
    if (kind.word == word) return kind;
  const std::string nearest = nearest_name(word, std::vector<std::string>{"craters", "rocks", "trees"});
  throw_usage(fmt::format("'{}' cannot be detected", word),
              nearest.empty()
                  ? "write `waymark detect craters IMAGE`, `detect rocks IMAGE` or `detect trees IMAGE`"
                  : "did you mean '" + nearest + "'?");
}

void check_method(const SearchKind& kind, const std::string& method) {
  if (std::ranges::count(kind.methods, method) > 0) return;
  const std::string nearest = nearest_name(method, kind.methods);
  throw_usage(
      fmt::format("{} are found by {}, not by '{}'", kind.word, fmt::join(kind.methods, " or "), method),
      nearest.empty() ? "leave out --method for the usual one" : "did you mean '" + nearest + "'?");
}

bool given(double value) {
  return !std::isnan(value);
}

void check_range(const char* option, double value, double lowest, double highest, const char* unit) {
  if (given(value))
    check_number(option, value, unit,
                 {.help = "`waymark detect --help` says what it means", .min = lowest, .max = highest});
}

void check_numbers(const DetectRequest& request, const SearchKind& kind) {
  if (given(request.sun_elevation) && !(request.sun_elevation > 0))
    throw_usage(fmt::format("the sun is not above the ground: --sun-elevation is {:g} degrees",
                            request.sun_elevation),
                "elevation counts from the horizon; it is 90 degrees less the incidence angle");
  check_range("--sun-elevation", request.sun_elevation, 0, 90, "deg");
  check_range("--sun-azimuth", request.sun_azimuth, -360, 720, "deg");
  check_range("--image-sun-angle", request.image_sun_angle, -360, 720, "deg");
  check_range("--min-confidence", request.min_confidence, 0, 1, "");
  check_range("--min-diameter", request.min_diameter, kind.smallest, 1e6, "px");
  check_range("--max-diameter", request.max_diameter, kind.smallest, 1e6, "px");
  check_range("--tile-pixels", static_cast<double>(request.piece), 256, 65536, "px");
  if (given(request.gsd) && !(request.gsd > 0 && request.gsd < 1e6))
    throw_usage(fmt::format("--gsd is {:g} m: a pixel measures more than nothing", request.gsd),
                "give the size of a pixel on the ground in metres");
  if (request.min_diameter >= request.max_diameter)
    throw_usage(fmt::format("--min-diameter {:g} is not below --max-diameter {:g}", request.min_diameter,
                            request.max_diameter),
                "both are pixels");
  if (given(request.sun_azimuth) && given(request.image_sun_angle))
    throw_usage("--sun-azimuth and --image-sun-angle both say where the light comes from",
                "keep --image-sun-angle for an image, --sun-azimuth for an orthophoto");
}

std::shared_ptr<const ImageSource> open_image(const DetectRequest& request,
                                              std::vector<std::string>& warnings) {
  importers::ImageImport how{.crs = request.crs, .band = static_cast<int>(request.band)};
  const auto opened = [&] {
    auto image = importers::import_image(request.image, how);
    for (const std::string& warning : image->warnings()) warnings.push_back(warning);
    return image;
  };
  try {
    return opened();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::input || !request.crs.empty()) throw;
    how.georeference = false;
    std::shared_ptr<const ImageSource> image;
    try {
      image = opened();
    } catch (const Error&) {
      throw error;  // not the georeference is at fault
    }
    warnings.push_back(fmt::format("{}, results are in pixels: {}", kUnused, error.what()));
    return image;
  }
}

/// Returns an azimuth (clockwise from map north) as an angle in the image, from right towards down.
Degrees image_angle(double azimuth, const Georeference& place) {
  const double a = azimuth * kRadiansPerDegree;
  return {std::atan2(std::cos(a) / place.dy, std::sin(a) / place.dx) / kRadiansPerDegree};
}

double map_azimuth(Degrees angle, const Georeference& place) {
  const double a = angle.value * kRadiansPerDegree;
  const double azimuth = std::atan2(std::cos(a) * place.dx, std::sin(a) * place.dy) / kRadiansPerDegree;
  return azimuth < 0 ? azimuth + 360 : azimuth;
}

void set_verifier(DetectionPlan& plan, const std::string& file) {
  if (file.empty()) return;
  if (plan.type != "crater" || plan.method != "bowl")
    throw_usage("--verifier is for craters that the method bowl finds", "leave it out");
  plan.verifier = std::make_shared<const pipeline::ReliefVerifier>(
      pipeline::parse_relief_verifier(read_text(file, "the verifier"), file));
}

void set_sun(DetectionPlan& plan, const DetectRequest& request) {
  const ImageInfo& info = plan.image->info();
  const auto unused =
      std::ranges::find_if(plan.warnings, [](const std::string& w) { return w.starts_with(kUnused); });
  if (given(request.sun_azimuth) && unused != plan.warnings.end())
    throw_usage("--sun-azimuth counts from map north, but " + *unused,
                "pass --image-sun-angle instead: towards the sun, degrees from right towards down");
  if (given(request.sun_azimuth) && !info.ortho)
    throw_usage("--sun-azimuth counts from map north, but the image has no georeference",
                "pass --image-sun-angle instead: towards the sun, degrees from right towards down");
  if (given(request.sun_azimuth)) plan.sun_azimuth = Degrees{request.sun_azimuth};
  if (given(request.sun_elevation)) plan.sun_elevation = Degrees{request.sun_elevation};
  if (info.sun && info.ortho && !given(request.sun_azimuth) && !given(request.image_sun_angle))
    plan.sun_azimuth = info.sun->azimuth;
  if (info.sun && !given(request.sun_elevation) && info.sun->elevation.value > 0)
    plan.sun_elevation = info.sun->elevation;
  if (given(request.image_sun_angle))
    plan.image_sun_angle = Degrees{request.image_sun_angle};
  else if (plan.sun_azimuth)
    plan.image_sun_angle = image_angle(plan.sun_azimuth->value, *info.ortho);
  else
    plan.image_sun_angle = info.image_sun_angle;
  if (plan.image_sun_angle) plan.image_sun_angle->value = std::remainder(plan.image_sun_angle->value, 360);
  if (info.ortho && plan.image_sun_angle && !plan.sun_azimuth)
    plan.sun_azimuth = Degrees{map_azimuth(*plan.image_sun_angle, *info.ortho)};
}

void set_scale(DetectionPlan& plan, const DetectRequest& request) {
  const ImageInfo& info = plan.image->info();
  plan.gsd = info.gsd;
  if (!given(request.gsd)) return;
  plan.gsd = Meters{request.gsd};
  if (!info.ortho) return;
  const double own = info.ortho->dx * info.ortho->crs.metres_per_unit();
  if (!(std::abs(own / request.gsd - 1) < 0.01))
    plan.warnings.push_back(fmt::format(
        "--gsd {:g} is not used: the image's georeference says {:g} m per pixel", request.gsd, own));
}

}  // namespace

DetectionPlan plan_detection(const DetectRequest& request) {
  const SearchKind& kind = find_kind(request.kind);
  check_numbers(request, kind);
  DetectionPlan plan;
  plan.type = kind.type;
  plan.method = request.method.empty() ? kind.methods[0] : request.method;
  check_method(kind, plan.method);
  if (plan.type == "tree") plan.method = request.method;  // empty: chosen by the image's bands
  if (given(request.min_confidence))
    plan.min_confidence = plan.min_treetop_confidence = request.min_confidence;
  plan.search.min_diameter = given(request.min_diameter) ? request.min_diameter : kind.min_diameter;
  plan.search.max_diameter = given(request.max_diameter) ? request.max_diameter : kind.max_diameter;
  if (plan.search.max_diameter > 0 && plan.search.min_diameter >= plan.search.max_diameter)
    throw_usage(fmt::format("no {} are looked for: the smallest would be {:g} px, the largest {:g} px",
                            kind.word, plan.search.min_diameter, plan.search.max_diameter),
                "give both --min-diameter and --max-diameter");
  plan.search.piece = request.piece;
  plan.search.reduce_for_large = plan.type == "crater";
  set_verifier(plan, request.verifier);
  plan.image = open_image(request, plan.warnings);
  set_sun(plan, request);
  set_scale(plan, request);
  return plan;
}

}  // namespace waymark::workflows
