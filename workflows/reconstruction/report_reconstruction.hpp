// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "exporters/report/reconstruction_report.hpp"
#include "pipeline/reconstruction/surface/orthophoto.hpp"
#include "pipeline/reconstruction/surface/sweep_heights.hpp"
#include "workflows/reconstruction/pose_photos.hpp"
#include "workflows/reconstruction/posed_images.hpp"
namespace waymark::workflows {

/// Returns the report of solved poses: plan, images, lens, surveyed points, failures.
exporters::ReconstructionReport report_of_poses(const PosedPhotos& posed);

/// Returns the report of given poses. Footprints lie at `height`, metres.
exporters::ReconstructionReport report_of_cameras(const PosedImages& posed, double height);

/// Returns the pictures of a DEM and its orthophoto, reduced to about `pixels` on the longer side. An
/// orthophoto without pixels is left out.
exporters::ReportedSurface reported_surface(const pipeline::SurfaceHeights& dem,
                                            const pipeline::Orthophoto& ortho, std::int64_t pixels = 900);

}  // namespace waymark::workflows
