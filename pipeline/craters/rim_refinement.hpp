// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include "core/detection.hpp"
#include "core/units.hpp"
#include "geo/image_source.hpp"
#include "pipeline/craters/crater_candidate.hpp"
namespace waymark {

/// A rim read off the image.
struct Rim {
  PixelEllipse ellipse;
  double centre_sd = 0;    ///< pixels, of either coordinate
  double diameter_sd = 0;  ///< pixels
};

/// Where the rim crest really is. Along 36 azimuths the brightness changes fastest outwards across the crest,
/// from dark to bright on the sunward side and from bright to dark opposite; that place, to a fraction of a
/// pixel, gives r(azimuth). Fitted by r0 + a cos + b sin + c cos 2 + d sin 2 (to first order an ellipse off
/// the centre), reweighted against outliers (Huber), drawn softly towards the candidate's own circle where
/// the light shows no edge. `image` has no NaN. Two passes, the second about the first one's centre. Nothing
/// where the edges are too few or carry the rim away by more than 30 % of the radius.
std::optional<Rim> refine_rim(const Pixels& image, const CraterCandidate& candidate, Radians sun_angle);

}  // namespace waymark
