// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "pipeline/reconstruction/adjustment/observations.hpp"
#include "workflows/reconstruction/read_photos.hpp"
namespace waymark::workflows {

/// Files of surveyed points.
struct PhotoControlRequest {
  std::string points = {};  ///< gcp_list.txt, or a layer or table of points
  std::string marks = {};   ///< table of their marks; empty: `points` is a gcp_list.txt
  std::string crs = {};     ///< of the map; empty: that of the points, or the UTM zone of the first
};

/// Surveyed points in the grid frame of a CRS.
struct PhotoControl {
  std::string crs = {};  ///< of the map
  std::vector<pipeline::ControlPoint> points = {};
  std::vector<std::string> warnings = {};  ///< marks and points that are left out
};

/// Reads surveyed points and converts them to observations. Heights are taken as they are.
/// - Marks in images that are not there, or outside them, are left out with a warning.
/// - Throws Error{input} for points without CRS, marks without any known image, and latitudes beyond 90
///   degrees.
/// - Throws Error{input} for coordinates that fit the positions of the pictures only if they are exchanged.
/// - Throws Error{usage} for a map in degrees.
PhotoControl photo_control(const PhotoControlRequest& request, const Photos& photos);

/// Returns the index of the picture of a name: of its whole name, else of its name without folders.
std::optional<std::size_t> picture_named(const Photos& photos, const std::string& name);

/// Returns why the positions of the pictures cannot be used beside the surveyed points, which they must be
/// within a degree of; empty if they can, or if there are none.
std::string contradiction_of_positions(const PhotoControl& control, const Photos& photos);

}  // namespace waymark::workflows
