// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include "localization/laser_scan.hpp"
namespace waymark::importers {

/// Reads the points of a 3-D scan, /vsi paths included: KITTI (.bin: little-endian float32 x, y, z,
/// intensity) or PLY (.ply: ascii, binary of either byte order; vertices x, y, z and, if it stands there,
/// intensity, reflectance or reflectivity). Points that are not finite are left out. Throws Error{input} for
/// another format, a file that breaks off, and one whose coordinates are no metres of a scanner (beyond 10
/// km).
localization::PointCloud read_point_file(const std::filesystem::path& file);

/// Returns whether the name is that of a point file.
bool is_point_file(const std::filesystem::path& file);

}  // namespace waymark::importers
