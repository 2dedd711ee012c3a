// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/detection.hpp"
#include "pipeline/engine/progress.hpp"
#include "pipeline/rocks/rock_training.hpp"
#include "workflows/training/rock_scene.hpp"
#include "workflows/training/rock_views.hpp"
namespace waymark::workflows {

/// Assignment of detections to rocks: greedy, the largest rock first, nearest free detection within
/// max(0.75 D, 2 px). Rocks whose outline or shadow reaches the border, and detections as near to it, count
/// neither way.
struct RockMatch {
  std::vector<int> detection_of;                    ///< of each rock; -1: missed
  std::vector<int> rock_of;                         ///< of each detection; -1: none
  std::vector<char> rock_counts, detection_counts;  ///< false: too near to the border
};

/// Matches the detections in an image whose light comes from `sun_angle`, radians. O(rocks x detections).
RockMatch match_rocks(const RockImage& image, const std::vector<Detection>& found, double sun_angle);

/// Two overlapping sets of examples, from which two networks are trained and averaged.
struct RockTrainingSets {
  std::vector<pipeline::RockExample> first, second;
};

inline constexpr int kRockViews = 240;  ///< vertical testbed views that the shipped network is trained on

/// Returns the dark spots of synthetic images of rocks as the detector finds them, at most 400 per image:
/// - `views` vertical views of the testbed (synthetic_view);
/// - 45 scenes with random light, relief and rocks, and 24 of large rocks under a low sun, each twice;
/// - 150 oblique views (leaning_view) twice in the first set, 330 once in the second; the first set omits
///   scene 18.
/// The latter counts are for 240 views, and proportional for others. The same for any number of threads.
/// About two CPU seconds per view.
RockTrainingSets make_rock_examples(int views, int threads, const pipeline::ProgressListener& progress);

/// Returns the dark spots of a view, seeded by `number`. The sun elevation is known in six of ten cases; the
/// sun direction is off by a few degrees in half of them. At most `max_count`, chosen at random, so that
/// scenes have equal weight.
std::vector<pipeline::RockExample> rock_examples(const SyntheticView& view, int number,
                                                 std::size_t max_count);

}  // namespace waymark::workflows
