// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "workflows/reconstruction/photo_control.hpp"
#include "workflows/reconstruction/pose_photos.hpp"
namespace waymark::workflows {

/// Moves posed pictures into a CRS by surveyed points, their GPS positions and gimbals, or a coarse DEM, and
/// adjusts them together. Without enough of these, or if all cameras would look up, the frame stays arbitrary
/// and `posed.messages` state why. Observations left out are named in warnings.
void georeference_photos(PosedPhotos& posed, const Photos& photos, const PhotoControl& control,
                         const pipeline::CalibratedAdjustment& calibrated, const PosePhotosRequest& request,
                         const Callbacks& callbacks);

}  // namespace waymark::workflows
