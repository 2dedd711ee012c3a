// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <vector>
#include "core/landmark.hpp"
#include "core/quality.hpp"
#include "geo/terrain.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/fusion/covering.hpp"
#include "pipeline/fusion/existence.hpp"
namespace waymark {

/// What "the image covers L" and "at least the resolution of i_0" mean in eqs. 4 and 5.
enum class CoverRule {
  /// L whole inside the image and not hidden by the ground; ground sample distance at L at most that of the
  /// coarsest image L was detected in (i_0), with a tolerance of 10 %.
  sound,
  /// The words of the paper: the footprint contains L's position; area(i) <= area(i_0), the image detecting
  /// L that covers the largest area.
  paper,
};

struct ValuationRules {
  CoverRule cover = CoverRule::sound;
  SpreadRule spread = SpreadRule::sound;
  CoveringRules covering = {};
  std::optional<ExistenceRules> existence = {};  ///< absent: those of each type
};

/// Values landmarks (Rossmann et al. 3.3): #I that detected and #I that cover each (eqs. 4-5), q_f per
/// feature (eqs. 6-7) and the probability that it exists. i_0 is chosen from the images that *detected* L,
/// for the paper expects L to be seen again "in other images showing the same region with the same or better
/// resolution"; an image that detected L counts as covering it. A source without an ImageView (a DEM, a
/// table) is a survey of its own: it detected L and could have.
/// What all images are off by together (ImageView::common) is added to the covariances.
/// `terrain` may be null. Positions in units of a CRS of `metres_per_unit`. `evidence` names landmarks by
/// uid.
void value_landmarks(std::span<Landmark> landmarks, std::span<const Observation> evidence,
                     std::span<const ImageView> images, const Terrain* terrain, const TypeRegistry& types,
                     double metres_per_unit, const ValuationRules& rules = {});

/// Takes out the landmarks that are less probable than their type's `least`; their evidence is kept as
/// rejected for that. Returns how many.
std::int64_t remove_improbable(std::vector<Landmark>& landmarks, std::vector<Observation>& evidence,
                               const TypeRegistry& types);

}  // namespace waymark
