// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "exporters/report/landmark_section.hpp"
namespace waymark {

/// Landmarks that claim about the same probability, and how many of them the truth confirms.
struct ClaimBin {
  double mean = 0;  ///< of what they claim, [0, 1]
  int found = 0, right = 0;
};

/// What a comparison with the truth says about one claim of one type.
struct QualityCheck {
  std::string type;
  std::string claim;  ///< "confidence" or "quality"
  std::vector<ClaimBin> bins;
  double expected_error = 0;  ///< mean |claimed - right| over the landmarks
};

/// How well the landmarks were observed: per type how many images saw them and could have, the means of the
/// confidences, and what was rejected for which reason; the calibration curves where there are checks. Empty
/// where no landmark was seen in an image and there is nothing to check.
std::string quality_section(const MapStore& map, const std::vector<LandmarkSection>& sections,
                            const std::vector<QualityCheck>& checks);

}  // namespace waymark
