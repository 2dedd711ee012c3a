// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>
#include <vector>
#include "localization/robot_log.hpp"
#include "localization/track_score.hpp"
namespace waymark::localization {

/// A number over several drives.
struct SpreadOverDrives {
  double median = 0, min = 0, max = 0;
  double low = 0, high = 0;  ///< confidence interval of the median, of 95 % from six drives on
};

/// Returns median and spread of at least one value. The interval is that of order statistics: it assumes
/// nothing about the distribution. Fewer than six values give min and max.
SpreadOverDrives spread_over_drives(std::vector<double> values);

/// Error of one row of a track.
struct TrackErrorAt {
  double t = 0;      ///< s since the first row with a true pose
  double error = 0;  ///< m
  double sd = 0;     ///< m, claimed: root of the trace of the covariance of the position
};

/// Returns the position errors of the rows with a true pose, without alignment.
std::vector<TrackErrorAt> track_errors(const Track& track, std::span<const StampedPose> truth,
                                       double max_gap);

/// Errors of several drives at one time.
struct ErrorBand {
  double t = 0;                                          ///< s, middle of the bin
  std::size_t drives = 0;                                ///< that last so long
  double p5 = 0, p25 = 0, median = 0, p75 = 0, p95 = 0;  ///< m, over the drives' mean errors in the bin
  double claimed = 0;  ///< m, median of the drives' mean standard deviations
};

/// Returns the bands of `bins` equal times up to the end of the longest drive; bins without drives are left
/// out.
std::vector<ErrorBand> error_bands(std::span<const std::vector<TrackErrorAt>> drives, std::size_t bins = 100);

}  // namespace waymark::localization
