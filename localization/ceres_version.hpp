// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
namespace waymark::localization {

/// Returns the version of the Ceres Solver that the program was built with: "2.1.0". The library does not
/// state its own.
std::string ceres_version();

}  // namespace waymark::localization
