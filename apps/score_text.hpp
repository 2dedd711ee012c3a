// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include "localization/track_score.hpp"
#include "testbed/score.hpp"
#include "workflows/evaluation/track_study.hpp"
namespace waymark::apps {

/// Prints scores by landmark type. Undefined numbers are "-" and null.
std::string scores_as_text(const std::map<std::string, testbed::Score>& scores);
std::string scores_as_json(const std::map<std::string, testbed::Score>& scores);

/// Prints the score of a track under an alignment ("none", "se2", "sim2"): ate_rmse, ate_median, rpe,
/// heading_rmse_deg, anees, wrong_matches, matches, time_per_update_us and others, a line or member each.
std::string track_score_as_text(const localization::TrackScore& score, const std::string& align);
std::string track_score_as_json(const localization::TrackScore& score, const std::string& align);

/// Prints a summary over several drives: a table of medians with 95 % confidence intervals, best and worst,
/// and counts; as JSON also the score of each drive.
std::string track_study_as_text(const workflows::TrackStudy& study, const std::string& align);
std::string track_study_as_json(const workflows::TrackStudy& study, const std::string& align);

}  // namespace waymark::apps
