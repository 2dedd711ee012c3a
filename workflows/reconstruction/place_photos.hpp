// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/reconstruction/adjustment/observations.hpp"
#include "workflows/reconstruction/pose_photos.hpp"
namespace waymark::workflows {

/// Places posed pictures without a frame in the map image of the request and adjusts them with points of it.
/// - Heights are those of `request.dem`; without it they are above the mean level of the terrain, whose tilt
///   is taken as 0 +- 1 degree, and a message says so.
/// - If they are not found there, the frame stays arbitrary and `posed.messages` state why.
void place_photos_in_image(PosedPhotos& posed, const Photos& photos, const pipeline::Observations& seen,
                           const std::vector<std::vector<std::string>>& free_lens_parameters,
                           const PosePhotosRequest& request);

}  // namespace waymark::workflows
