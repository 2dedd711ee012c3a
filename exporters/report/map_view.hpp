// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "exporters/report/landmark_section.hpp"
#include "exporters/report/relief_source.hpp"
#include "geo/crs.hpp"
namespace waymark::exporters {

/// Mapping from the map to the drawing: x right, y down, drawing units.
struct MapView {
  Crs crs = Crs::local();
  Extent extent;
  GroundScale scale;             ///< metres per CRS unit
  double width = 0, height = 0;  ///< of the map inside its frame; the longer one is 1000

  double x(double map_x) const { return (map_x - extent.west) / extent.width() * width; }
  double y(double map_y) const { return (extent.north - map_y) / extent.height() * height; }
  double metres_per_unit() const { return extent.width() * scale.x / width; }
  /// Returns a longitude shifted by whole turns to be nearest to the middle of the view; other coordinates
  /// unchanged.
  double unwrap(double map_x) const;
};

/// Returns a view of `extent` in the proportions of the ground.
MapView view_of(const Crs& crs, const Extent& extent);

/// Returns the extent of the landmarks with a margin, a kilometre about a single one; `std::nullopt` without
/// landmarks.
std::optional<Extent> extent_of(const std::vector<LandmarkSection>& sections, const Crs& crs);

/// Formats a position: "32.6533° S 70.0122° W", "E 412 345  N 3 789 012" or "x 12.50  y -3.20".
std::string position_text(const Crs& crs, double x, double y);

/// Draws lines of round coordinates as an SVG group, with their values outside the frame.
std::string svg_graticule(const MapView& view);
/// Draws a bar of a round length, lower left, and an arrow to true north, upper right.
std::string svg_scale_bar(const MapView& view);
std::string svg_north_arrow(const MapView& view);

/// Returns the largest of 1, 2 or 5 times a power of ten that is not above `at_most` > 0.
double round_length(double at_most);

}  // namespace waymark::exporters
