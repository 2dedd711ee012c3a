// SPDX-License-Identifier: Apache-2.0
#include "pipeline/vision/opencv_version.hpp"

#include <opencv2/core/utility.hpp>

namespace waymark::pipeline {

std::string opencv_version() {
  return cv::getVersionString();
}

}  // namespace waymark::pipeline
