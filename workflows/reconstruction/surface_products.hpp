// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>
#include "pipeline/reconstruction/surface/orthophoto.hpp"
#include "pipeline/reconstruction/surface/sweep_heights.hpp"
#include "workflows/reconstruction/posed_images.hpp"
namespace waymark::workflows {

/// Returns the fraction of cells per reason of no data, the most frequent first.
std::string reasons_text(const pipeline::SurfaceHeights& heights);

/// Writes dem.tif: a band for each grid, codes of the reasons as items.
void write_dem(const std::filesystem::path& file, const pipeline::SurfaceHeights& dem, const Crs& crs);

/// Writes orthophoto.tif: brightness and index of the source image, whose names are items.
void write_orthophoto(const std::filesystem::path& file, const pipeline::Orthophoto& ortho,
                      const std::vector<pipeline::SurfaceView>& views, const Crs& crs);

/// Returns job.json, which makes the map from dem.tif and the images. Paths are relative to the folder.
std::string job_text(const PosedImages& posed, const pipeline::SurfaceHeights& dem,
                     const std::filesystem::path& folder);

}  // namespace waymark::workflows
