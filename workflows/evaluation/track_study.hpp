// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
#include <vector>
#include "localization/drive_statistics.hpp"
#include "workflows/evaluation/evaluate.hpp"
namespace waymark::workflows {

/// One measure of a track over the drives that have it.
struct StudyRow {
  std::string name;  ///< with unit
  std::size_t drives = 0;
  localization::SpreadOverDrives spread;
};

/// Scores of several drives (Monte Carlo runs) and their summary.
struct TrackStudy {
  std::vector<localization::TrackScore> drives;
  std::vector<StudyRow> rows;
  std::size_t with_covariances = 0, consistent = 0;  ///< drives; those whose ANEES lies inside its band
};

/// Evaluates the drive of a request and more drives "TRACK=TRUTH" with its other options. Draws the errors of
/// all drives over time if the request has a picture. Throws Error{usage} for other texts, for `also`, and
/// for a picture of aligned tracks; otherwise as evaluate().
TrackStudy evaluate_drives(const TrackEvaluation& first, const std::vector<std::string>& more);

}  // namespace waymark::workflows
