// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "core/landmark.hpp"
#include "geo/local_frame.hpp"
#include "landmarks/landmark_type.hpp"
#include "workflows/mapping/drive_looks.hpp"
namespace waymark::workflows {

/// Landmarks of a drive, with quality, and their evidence.
struct DriveLandmarks {
  std::vector<Landmark> landmarks;
  std::vector<Observation> evidence;
  std::int64_t improbable = 0;  ///< landmarks removed as too improbable
  std::int64_t too_far = 0;     ///< sightings beyond `max_range`
  std::int64_t unplaced = 0;    ///< sightings with a bearing or a range alone
  std::int64_t untyped = 0;     ///< sightings without a type, or whose type is open
};

/// Merges the sightings of looks into landmarks and values them (Rossmann et al. 3.2 and 3.3, a look in place
/// of an image). They are in the CRS of `frame`, that of the looks; heights are unknown.
/// - A look covers a landmark if it detected it. So does one no farther than the farthest look that did (eq.
///   4), if the beam towards the landmark reaches it from the open side.
/// - Looks through the place of an upright object count strongly against it: people and cars move on.
DriveLandmarks landmarks_of_looks(std::span<const DriveLook> looks, const TypeRegistry& types,
                                  const LocalFrame& frame, const DriveMappingOptions& options = {});

}  // namespace waymark::workflows
