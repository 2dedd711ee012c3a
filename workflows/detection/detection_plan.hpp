// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "core/units.hpp"
#include "geo/image_source.hpp"
#include "pipeline/craters/relief_verifier.hpp"
#include "workflows/detection/detect.hpp"
#include "workflows/detection/search_image.hpp"
namespace waymark::workflows {

/// A checked request with its image opened and the sun's direction turned into the image.
struct DetectionPlan {
  std::string type;    ///< landmark type: "crater", "rock", "tree"
  std::string method;  ///< of that type; for trees empty: chosen by the bands
  std::shared_ptr<const ImageSource> image;
  std::optional<Degrees> image_sun_angle;  ///< towards the sun, from x towards y; nothing: to be estimated
  std::optional<Degrees> sun_elevation, sun_azimuth;
  std::optional<Meters> gsd;  ///< of an image without georeference
  ImageSearch search;
  std::shared_ptr<const pipeline::ReliefVerifier> verifier;  ///< of craters; null: the shipped one
  double min_confidence = 0.5;
  double min_treetop_confidence = 0;  ///< of trees found by heights; all are kept unless asked otherwise
  std::vector<std::string> warnings;
};

/// Throws Error{usage} for options out of range or in conflict, a method of another type, or an azimuth
/// without a georeference; Error{input} for a missing or damaged image. An image whose georeference cannot be
/// used (degrees, rotated) is searched in pixels, with a warning that names the remedy.
DetectionPlan plan_detection(const DetectRequest& request);

}  // namespace waymark::workflows
