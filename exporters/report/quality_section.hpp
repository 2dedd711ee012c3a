// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "exporters/report/landmark_section.hpp"
#include "exporters/report/report_html.hpp"
namespace waymark::exporters {

/// Returns how well the landmarks were observed: per type the counts of images that saw them and could have,
/// the mean confidences, rejections by reason, and calibration curves if there are checks. Empty if no
/// landmark was seen in an image and there are no checks.
std::string quality_section(const geodb::MapStore& map, const std::vector<LandmarkSection>& sections,
                            const std::vector<QualityCheck>& checks);

}  // namespace waymark::exporters
