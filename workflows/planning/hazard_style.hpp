// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
namespace waymark::workflows {

/// Returns a QGIS style of a hazard map: the probability from green to red, transparent where unknown.
std::string hazard_style();

}  // namespace waymark::workflows
