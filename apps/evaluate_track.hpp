// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "apps/command.hpp"
namespace waymark {

/// `waymark evaluate track`.
struct TrackEvaluation {
  std::string align = "none", log_format;
  std::int64_t robot = 0;
  double longest_gap = 0.5;
  std::string picture, map;  ///< SVG to draw; map whose landmarks are drawn and whose frame truth is put in
  std::vector<std::string> also;  ///< NAME=TRACK.csv: more tracks of the picture
};

/// Options that only this comparison has; they point into `into`.
std::vector<Argument> track_arguments(TrackEvaluation& into);

/// The comparison as text or JSON: ate_rmse, ate_median, rpe, heading_rmse_deg, anees, wrong_matches,
/// matches, time_per_update_us. `truth` is a log with true poses or another track.
std::string evaluate_track(const std::string& track, const std::string& truth, const std::string& format,
                           const TrackEvaluation& how);

}  // namespace waymark
