// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
namespace waymark {

/// How far the share of true ones among an image's candidates lies from the share that their log odds were
/// fitted with, as log odds to add to each: expectation and maximisation over the image's own candidates
/// (Saerens, Latinne & Decaestecker 2002), the share kept within 2 to 98 %, four candidates of the fitted
/// share imagined, since a few prove little. People who mark images, and grounds, differ in how many there
/// are; the log odds are not perfect either, so callers go only a part of the way. O(n), at most 100 rounds.
double share_shift(std::span<const double> log_odds, double fitted_share);

}  // namespace waymark
