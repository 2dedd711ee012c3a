// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
namespace waymark::workflows {

/// Colours of a band between values; transparent where it has no data.
struct RasterStyle {
  struct Colour {
    double value;
    const char *rgb, *label;
  };
  int band = 1;
  std::vector<Colour> colours;  ///< ascending values
};

/// Returns a QGIS style (.qml).
std::string raster_style(const RasterStyle& style);

}  // namespace waymark::workflows
