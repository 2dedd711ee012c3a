// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
namespace waymark::geodb {

/// Returns "r,g,b,alpha" of "#rrggbb", as QGIS writes colours; grey if it is not a colour. Opacity: 0 to 1.
std::string qml_colour(const std::string& colour, double opacity = 1);

}  // namespace waymark::geodb
