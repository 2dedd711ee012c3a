// SPDX-License-Identifier: Apache-2.0
#include "workflows/detection/detection_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "core/options/option_reader.hpp"
#include "importers/images/image.hpp"
#include "workflows/registries.hpp"

namespace waymark::workflows {
namespace {

constexpr const char* kUnused = "its georeference is not used";

[[noreturn]] void throw_usage(const std::string& problem, const std::string& hint) {
  throw Error(ErrorCode::usage, problem, "", hint);
}

/// Returns "write `waymark detect craters IMAGE`, `detect rocks IMAGE` or `detect trees IMAGE`".
std::string all_commands() {
  const std::vector<std::string> names = image_detectors().names();
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += fmt::format("{}`{}detect {} IMAGE`",
                        i == 0                 ? "write "
                        : i + 1 < names.size() ? ", "
                                               : " or ",
                        i == 0 ? "waymark " : "", names[i]);
  return text;
}

/// Finds a detector by its name or by its type: "craters" or "crater".
const ImageDetectorSpec& find_detector(const std::string& word) {
  if (const ImageDetectorSpec* named = image_detectors().find(word)) return *named;
  for (const ImageDetectorSpec& one : image_detectors())
    if (one.type == word) return one;
  const std::string nearest = nearest_name(word, image_detectors().names());
  throw_usage(fmt::format("'{}' cannot be detected", word),
              nearest.empty() ? all_commands() : "did you mean '" + nearest + "'?");
}

void check_method(const ImageDetectorSpec& spec, const std::string& method) {
  std::vector<std::string> known;
  for (const DetectionMethod& one : spec.methods) known.push_back(one.name);
  if (std::ranges::count(known, method) > 0) return;
  const std::string nearest = nearest_name(method, known);
  throw_usage(fmt::format("{} are found by {}, not by '{}'", spec.name, fmt::join(known, " or "), method),
              nearest.empty() ? "leave out --method for the usual one" : "did you mean '" + nearest + "'?");
}

/// Returns "--verifier is for craters that the method bowl finds", by all detectors that have the setting.
std::string owners_of_setting(const std::string& setting) {
  std::string text;
  for (const ImageDetectorSpec& one : image_detectors())
    for (const OptionRow& row : settings_of(one)) {
      if (row.name != setting) continue;
      const std::vector<std::string> methods = use_of_setting(one, setting).methods;
      text += fmt::format("{}{}", text.empty() ? "" : ", ", one.name);
      if (!methods.empty()) text += fmt::format(" that the method {} finds", fmt::join(methods, " or "));
    }
  if (text.empty()) throw_usage(fmt::format("no detector has a setting '{}'", setting), "leave it out");
  std::string option = setting;
  std::ranges::replace(option, '_', '-');
  return fmt::format("--{} is for {}", option, text);
}

/// Sets the settings that are given. Throws Error{usage} for those of other detectors or methods.
void set_own(const DetectRequest& request, const ImageDetectorSpec& spec, const std::string& method,
             ImageDetector& detector) {
  const std::vector<OptionRow> own = settings_of(spec);
  for (const auto& [name, text] : request.settings) {
    if (text.empty()) continue;
    const std::vector<std::string> methods = use_of_setting(spec, name).methods;
    if (std::ranges::find(own, name, &OptionRow::name) == own.end() ||
        (!methods.empty() && std::ranges::count(methods, method) == 0))
      throw_usage(owners_of_setting(name), "leave it out");
    for (const std::string& warning :
         set_option(detector.describe, name, text, {.owner = "detector " + spec.name, .where = name}))
      throw_usage(warning, "use the present name");
  }
  if (detector.prepare) detector.prepare();
}

bool given(double value) {
  return !std::isnan(value);
}

void check_range(const char* option, double value, double lowest, double highest, const char* unit) {
  if (given(value))
    check_number(option, value, unit,
                 {.help = "`waymark detect --help` says what it means", .min = lowest, .max = highest});
}

void check_numbers(const DetectRequest& request, const ImageDetectorSpec& spec) {
  if (given(request.sun_elevation) && !(request.sun_elevation > 0))
    throw_usage(fmt::format("the sun is not above the ground: --sun-elevation is {:g} degrees",
                            request.sun_elevation),
                "elevation counts from the horizon; it is 90 degrees less the incidence angle");
  check_range("--sun-elevation", request.sun_elevation, 0, 90, "deg");
  check_range("--sun-azimuth", request.sun_azimuth, -360, 720, "deg");
  check_range("--image-sun-angle", request.image_sun_angle, -360, 720, "deg");
  check_range("--min-confidence", request.min_confidence, 0, 1, "");
  check_range("--min-diameter", request.min_diameter, spec.smallest, 1e6, "px");
  check_range("--max-diameter", request.max_diameter, spec.smallest, 1e6, "px");
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

PlannedDetection plan_detection(const DetectRequest& request) {
  const ImageDetectorSpec& spec = find_detector(request.kind);
  check_numbers(request, spec);
  PlannedDetection planned{spec, spec.make(), {}};
  DetectionPlan& plan = planned.plan;
  plan.types = &all_types();
  plan.type = plan.types->id(spec.type);
  const std::string method = request.method.empty() ? spec.methods[0].name : request.method;
  check_method(spec, method);
  plan.method = spec.method_by.empty() ? method : request.method;
  if (given(request.min_confidence)) plan.min_confidence = request.min_confidence;
  plan.search = spec.search;
  if (given(request.min_diameter)) plan.search.min_diameter = request.min_diameter;
  if (given(request.max_diameter)) plan.search.max_diameter = request.max_diameter;
  if (plan.search.max_diameter > 0 && plan.search.min_diameter >= plan.search.max_diameter)
    throw_usage(fmt::format("no {} are looked for: the smallest would be {:g} px, the largest {:g} px",
                            spec.name, plan.search.min_diameter, plan.search.max_diameter),
                "give both --min-diameter and --max-diameter");
  plan.search.piece = request.piece;
  plan.search.threads = request.threads;
  set_own(request, spec, method, planned.detector);
  plan.image = open_image(request, plan.warnings);
  set_sun(plan, request);
  set_scale(plan, request);
  return planned;
}

}  // namespace waymark::workflows
