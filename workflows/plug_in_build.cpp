// SPDX-License-Identifier: Apache-2.0
// Alone in its unit: a plug-in is linked with it.
#include <fmt/format.h>

#include "localization/laser_scan.hpp"
#include "pipeline/engine/stage.hpp"
#include "workflows/plug_in.hpp"

namespace waymark::workflows {

const char* plug_in_build() {
  static const std::string text = fmt::format(
      "waymark {}, compiler {}, ABI {}, layout {}.{}.{}.{}.{}.{}.{}.{}.{}.{}.{}", WAYMARK_VERSION,
      __VERSION__, __GXX_ABI_VERSION, sizeof(PlugIn), sizeof(LandmarkType),
      sizeof(localization::DetectorSpec), sizeof(localization::LaserScan), sizeof(localization::PointCloud),
      sizeof(localization::SeenLandmark), sizeof(ImageDetectorSpec), sizeof(DetectionPlan),
      sizeof(DetectResult), sizeof(pipeline::StageSpec), sizeof(Detection));
  return text.c_str();
}

}  // namespace waymark::workflows
