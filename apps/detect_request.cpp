// SPDX-License-Identifier: Apache-2.0
#include "apps/detect_request.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "importers/images/image.hpp"

namespace waymark {
namespace {

constexpr double kLeastCrater = 6, kLeastRock = 1, kLeastTree = 0.1;  // pixels

struct Kind {
  const char* word;
  const char* type;
  std::vector<std::string> methods;  // the first is used where none is named
  double min_diameter, max_diameter, least;
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {{"craters", "crater", {"bowl", "edges"}, 8, 0, kLeastCrater},
                                        {"rocks", "rock", {"shadow", "classic"}, 1.5, 100, kLeastRock},
                                        {"trees", "tree", {"imagery", "peaks", "lmf"}, 1, 0, kLeastTree}};
  return all;
}

[[noreturn]] void refuse(const std::string& problem, const std::string& hint) {
  throw Error(ErrorCode::usage, problem, "", hint);
}

const Kind& kind_called(std::string word) {
  if (word == "crater" || word == "rock" || word == "tree") word += 's';
  for (const Kind& kind : kinds())
    if (kind.word == word) return kind;
  const std::string nearest = nearest_name(word, std::vector<std::string>{"craters", "rocks", "trees"});
  refuse(fmt::format("'{}' cannot be detected", word),
         nearest.empty()
             ? "write `waymark detect craters IMAGE`, `detect rocks IMAGE` or `detect trees IMAGE`"
             : "did you mean '" + nearest + "'?");
}

void check_method(const Kind& kind, const std::string& method) {
  if (std::ranges::count(kind.methods, method) > 0) return;
  const std::string nearest = nearest_name(method, kind.methods);
  refuse(fmt::format("{} are found by {}, not by '{}'", kind.word, fmt::join(kind.methods, " or "), method),
         nearest.empty() ? "leave out --method for the usual one" : "did you mean '" + nearest + "'?");
}

bool given(double value) {
  return !std::isnan(value);
}

void check_range(const char* option, double value, double lowest, double highest, const char* unit) {
  if (given(value) && !(value >= lowest && value <= highest))
    refuse(fmt::format("{} is {:g}, outside {:g} to {:g} {}", option, value, lowest, highest, unit),
           "`waymark detect --help` says what it means");
}

void check_numbers(const DetectRequest& request, const Kind& kind) {
  if (given(request.sun_elevation) && !(request.sun_elevation > 0))
    refuse(fmt::format("the sun is not above the ground: --sun-elevation is {:g} degrees",
                       request.sun_elevation),
           "elevation counts from the horizon; it is 90 degrees less the incidence angle");
  check_range("--sun-elevation", request.sun_elevation, 0, 90, "degrees");
  check_range("--sun-azimuth", request.sun_azimuth, -360, 720, "degrees");
  check_range("--image-sun-angle", request.image_sun_angle, -360, 720, "degrees");
  check_range("--min-confidence", request.min_confidence, 0, 1, "");
  check_range("--min-diameter", request.min_diameter, kind.least, 1e6, "pixels");
  check_range("--max-diameter", request.max_diameter, kind.least, 1e6, "pixels");
  check_range("--tile-pixels", static_cast<double>(request.piece), 256, 65536, "pixels");
  if (given(request.gsd) && !(request.gsd > 0 && request.gsd < 1e6))
    refuse(fmt::format("--gsd is {:g} m: a pixel measures more than nothing", request.gsd),
           "give the size of a pixel on the ground in metres");
  if (request.min_diameter >= request.max_diameter)
    refuse(fmt::format("--min-diameter {:g} is not below --max-diameter {:g}", request.min_diameter,
                       request.max_diameter),
           "both are pixels");
  if (given(request.sun_azimuth) && given(request.image_sun_angle))
    refuse("--sun-azimuth and --image-sun-angle both say where the light comes from",
           "keep --image-sun-angle for an image, --sun-azimuth for an orthophoto");
}

std::shared_ptr<const ImageSource> open_image(const DetectRequest& request,
                                              std::vector<std::string>& warnings) {
  ImageImport how{.crs = request.crs, .band = static_cast<int>(request.band)};
  const auto opened = [&] {
    auto image = import_image(request.image, how);
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
    warnings.push_back(fmt::format("its georeference is not used, results are in pixels: {}", error.what()));
    return image;
  }
}

/// Azimuth clockwise from map north as an angle in the image, from right towards down.
Degrees angle_in_image(double azimuth, const Georeference& place) {
  const double a = azimuth * kRadiansPerDegree;
  return {std::atan2(std::cos(a) / place.dy, std::sin(a) / place.dx) / kRadiansPerDegree};
}

double azimuth_of(Degrees angle, const Georeference& place) {
  const double a = angle.value * kRadiansPerDegree;
  const double azimuth = std::atan2(std::cos(a) * place.dx, std::sin(a) * place.dy) / kRadiansPerDegree;
  return azimuth < 0 ? azimuth + 360 : azimuth;
}

void place_sun(DetectPlan& plan, const DetectRequest& request) {
  const ImageInfo& info = plan.image->info();
  if (given(request.sun_azimuth) && !info.ortho)
    refuse("--sun-azimuth counts from map north, but the image has no georeference",
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
    plan.image_sun_angle = angle_in_image(plan.sun_azimuth->value, *info.ortho);
  else
    plan.image_sun_angle = info.image_sun_angle;
  if (plan.image_sun_angle) plan.image_sun_angle->value = std::remainder(plan.image_sun_angle->value, 360);
  if (info.ortho && plan.image_sun_angle && !plan.sun_azimuth)
    plan.sun_azimuth = Degrees{azimuth_of(*plan.image_sun_angle, *info.ortho)};
}

void place_scale(DetectPlan& plan, const DetectRequest& request) {
  const ImageInfo& info = plan.image->info();
  plan.gsd = info.gsd;
  if (!given(request.gsd)) return;
  plan.gsd = Meters{request.gsd};
  if (!info.ortho) return;
  const double own = info.ortho->dx * info.ortho->crs.metres_per_unit();
  if (info.ortho->crs.kind() != CrsKind::local && !(std::abs(own / request.gsd - 1) < 0.01))
    plan.warnings.push_back(fmt::format(
        "--gsd {:g} is not used: the image's georeference says {:g} m per pixel", request.gsd, own));
}

}  // namespace

std::vector<Argument> arguments(DetectRequest& request) {
  return {
      Argument{"", "craters|rocks|trees", &request.kind, "What to look for"}.needed().offering(
          {"craters", "rocks", "trees"}),
      file_word("IMAGE", &request.image, "Image that GDAL opens, /vsi paths too"),
      Argument{"-o,--output", "OUT", &request.output,
               "Table to write: .csv, .geojson or .gpkg; an older one is replaced"}
          .needed()
          .offering(Offer::file),
      Argument{"--method", "NAME", &request.method,
               "How to look: bowl or edges for craters, shadow or classic for "
               "rocks; imagery (colour), peaks or lmf (heights above ground) for trees"}
          .offering({"bowl", "edges", "shadow", "classic", "imagery", "peaks", "lmf"})
          .or_else("bowl, shadow; of trees by the bands of the image"),
      Argument{"--image-sun-angle", "DEG", &request.image_sun_angle,
               "Direction towards the sun in the image, from x (right) towards y (down)"}
          .or_else("estimated from the image"),
      {"--sun-azimuth", "DEG", &request.sun_azimuth,
       "Azimuth of the sun, clockwise from map north, of a georeferenced image"},
      {"--sun-elevation", "DEG", &request.sun_elevation, "Sun above the horizon: gives rocks their heights"},
      {"--gsd", "M", &request.gsd, "Size of a pixel on the ground, of an image without georeference"},
      Argument{"--min-diameter", "PX", &request.min_diameter, "Smallest thing looked for"}.or_else(
          "8 for craters, 1.5 for rocks"),
      Argument{"--max-diameter", "PX", &request.max_diameter, "Largest thing looked for"}.or_else(
          "0.6 of the shorter side for craters, 100 for rocks"),
      Argument{"--min-confidence", "P", &request.min_confidence, "Leave out what is less probable"}.or_else(
          "0.5; nothing of trees told by heights"),
      Argument{"--band", "N", &request.band, "Band of the image, from 1"}.or_else(
          "brightness of a colour image, else the first"),
      Argument{"--crs", "CRS", &request.crs, "CRS of a georeferenced image that names none, or a wrong one"},
      Argument{"--tile-pixels", "N", &request.piece, "Side of the pieces a large image is searched in"}
          .or_else("8192")};
}

DetectPlan plan_of(const DetectRequest& request) {
  const Kind& kind = kind_called(request.kind);
  check_numbers(request, kind);
  DetectPlan plan;
  plan.type = kind.type;
  plan.method = request.method.empty() ? kind.methods[0] : request.method;
  check_method(kind, plan.method);
  if (plan.type == "tree") plan.method = request.method;  // by the image's bands where none is named
  if (given(request.min_confidence))
    plan.min_confidence = plan.min_confidence_of_tops = request.min_confidence;
  plan.search.min_diameter = given(request.min_diameter) ? request.min_diameter : kind.min_diameter;
  plan.search.max_diameter = given(request.max_diameter) ? request.max_diameter : kind.max_diameter;
  if (plan.search.max_diameter > 0 && plan.search.min_diameter >= plan.search.max_diameter)
    refuse(fmt::format("no {} are looked for: the smallest would be {:g} px, the largest {:g} px", kind.word,
                       plan.search.min_diameter, plan.search.max_diameter),
           "give both --min-diameter and --max-diameter");
  plan.search.piece = request.piece;
  plan.search.reduce_for_large = plan.type == "crater";
  plan.image = open_image(request, plan.warnings);
  place_sun(plan, request);
  place_scale(plan, request);
  return plan;
}

}  // namespace waymark
