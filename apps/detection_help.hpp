// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "apps/command.hpp"
#include "workflows/detection/image_detector.hpp"
namespace waymark::apps {

/// Texts of `waymark detect`, made from the declarations of its detectors.
struct DetectionHelp {
  std::string kinds;           ///< "craters, rocks or trees"
  std::string methods;         ///< "bowl or edges for craters, shadow or classic for rocks"
  std::string default_method;  ///< "bowl, shadow; of trees by the bands of the image"
  std::vector<std::string> method_names;
  std::string min_diameter;    ///< defaults: "8 for craters, 1.5 for rocks"
  std::string max_diameter;    ///< the same of the largest
  std::string min_confidence;  ///< "0.5; nothing of trees found by heights"
};
DetectionHelp detection_help(const workflows::ImageDetectorTable& detectors);

/// Returns an option for each setting that detectors declare, once by name: "--verifier FILE".
std::vector<Argument> setting_arguments(const workflows::ImageDetectorTable& detectors,
                                        workflows::DetectRequest& request);

}  // namespace waymark::apps
