// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
namespace waymark::pipeline {

/// Returns the version of the OpenCV library that is loaded: "4.6.0".
std::string opencv_version();

}  // namespace waymark::pipeline
