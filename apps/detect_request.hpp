// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "apps/command.hpp"
#include "apps/search_image.hpp"
#include "core/units.hpp"
#include "geo/image_source.hpp"
namespace waymark {

/// What `waymark detect` is asked for, as typed. Numbers not given are NaN.
struct DetectRequest {
  std::string kind;  ///< "craters", "rocks" or "trees"
  std::string image, output, method, crs;
  double sun_azimuth = std::numeric_limits<double>::quiet_NaN();
  double sun_elevation = std::numeric_limits<double>::quiet_NaN();
  double image_sun_angle = std::numeric_limits<double>::quiet_NaN();
  double gsd = std::numeric_limits<double>::quiet_NaN();
  double min_diameter = std::numeric_limits<double>::quiet_NaN();
  double max_diameter = std::numeric_limits<double>::quiet_NaN();
  double min_confidence = std::numeric_limits<double>::quiet_NaN();
  std::int64_t band = 0, piece = 8192;
};
std::vector<Argument> arguments(DetectRequest& request);

/// The request, checked, with its image opened and the sun turned into the image.
struct DetectPlan {
  std::string type;    ///< landmark type: "crater", "rock", "tree"
  std::string method;  ///< one the type has; of trees empty: by the bands
  std::shared_ptr<const ImageSource> image;
  std::optional<Degrees> image_sun_angle;  ///< towards the sun, from x towards y; nothing: to be estimated
  std::optional<Degrees> sun_elevation, sun_azimuth;
  std::optional<Meters> gsd;  ///< of an image without georeference
  ImageSearch search;
  double min_confidence = 0.5;
  /// Of trees told by heights, whose second tops are told by their confidence and not left out unasked.
  double min_confidence_of_tops = 0;
  std::vector<std::string> warnings;
};

/// Throws Error{usage} for options out of range or against each other, a method the type does not have, an
/// azimuth without a georeference; Error{input} for a missing or damaged image. An image whose georeference
/// cannot be used (degrees, rotated) is searched in pixels, with a warning that tells how to mend it.
DetectPlan plan_of(const DetectRequest& request);

}  // namespace waymark
