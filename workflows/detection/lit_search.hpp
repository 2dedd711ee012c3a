// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "workflows/detection/image_detector.hpp"
namespace waymark::workflows {

/// Direction of the light that an image shows.
struct Light {
  double angle = 0, sd = 0;  ///< degrees, towards the sun, from x towards y
  int support = 0;           ///< objects that agreed
};

/// How a detector works with the light of an image.
struct LitSearch {
  std::int64_t sample = 1536;  ///< side of the pieces that the light is estimated from, pixels
  std::function<std::optional<Light>(const Pixels&)> estimate;  ///< from one piece
  /// Returns the estimate of the image from those of its pieces.
  std::function<std::optional<Light>(const std::vector<Light>&)> choose;
  std::string witness;        ///< objects that show the light, for people: "craters"
  std::string unknown_light;  ///< warning for an image that does not show it
  bool needs_light = false;   ///< without it nothing is searched
  std::function<ObjectDetector(std::optional<Radians> sun)> make;  ///< towards the sun, if it is known
};

/// Smallest side of an image in which anything is searched, pixels.
inline constexpr std::int64_t kMinSide = 16;

/// Checks the brightness of the image, estimates the direction of the light or compares it with the given
/// one, and searches the image. An image in which nothing can be seen (one pixel, black, no data) has no
/// detections and a warning that says why; the result has a `sun_angle` only if the image was searched with
/// one.
DetectResult search_lit_image(const DetectionPlan& plan, const LitSearch& search);

}  // namespace waymark::workflows
