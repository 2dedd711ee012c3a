// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "workflows/reconstruction/photo_altimeter.hpp"
#include "workflows/reconstruction/photo_control.hpp"
#include "workflows/reconstruction/pose_photos.hpp"
namespace waymark::workflows {

/// References that files beside the pictures give.
struct SurveyedReferences {
  PhotoControl control = {};
  PhotoAltimeter altimeter = {};
};

/// Moves posed pictures into a CRS and adjusts them together with their references: surveyed points, GPS
/// positions and gimbals, heights of an altimeter, or a coarse DEM.
/// - If heights are all that is known, they give a local frame of true size.
/// - Without enough, or if all cameras would look up, the frame stays arbitrary and `posed.messages` state
/// why.
/// - Observations left out are named in warnings.
void georeference_photos(PosedPhotos& posed, const Photos& photos, const SurveyedReferences& surveyed,
                         const pipeline::CalibratedAdjustment& calibrated, const PosePhotosRequest& request,
                         const Callbacks& callbacks);

}  // namespace waymark::workflows
