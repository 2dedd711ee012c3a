// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
namespace waymark::inline geo {

/// Returns the version of the PROJ library that is loaded: "9.1.1".
std::string proj_version();

}  // namespace waymark::inline geo
