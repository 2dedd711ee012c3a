// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>
#include "exporters/cameras/camera_file.hpp"
#include "workflows/reconstruction/pose_photos.hpp"
namespace waymark::workflows {

/// Returns the tie points with two marks or more, with their residuals.
std::vector<exporters::SparsePoint> sparse_points(const pipeline::Reconstruction& scene);

/// Writes cameras.json, colmap/ and points.ply into the folder, and points.las if the frame is metric.
void write_pose_products(const PosedPhotos& posed, const Photos& photos,
                         const std::vector<exporters::SparsePoint>& points,
                         const std::filesystem::path& folder);

}  // namespace waymark::workflows
