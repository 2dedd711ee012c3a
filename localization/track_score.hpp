// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include "localization/consistency.hpp"
#include "localization/track.hpp"
namespace waymark::localization {

struct StampedPose;

/// Alignment of a track to the truth before errors are measured (Umeyama 1991).
enum class TrackAlignment { none, se2, sim2 };

/// A similarity transform of the plane: p -> scale R(yaw) p + (x, y).
struct PlaneAlignment {
  Pose2 motion;
  double scale = 1;
  Eigen::Vector2d operator()(const Eigen::Vector2d& p) const;
};

/// Returns the least-squares alignment of pairs of points; the identity if fewer than two differ.
PlaneAlignment align(std::span<const Eigen::Vector2d> from, std::span<const Eigen::Vector2d> to,
                     TrackAlignment kind);

/// Errors and consistency of a track.
struct TrackScore {
  std::size_t poses = 0;                                 ///< rows with a true pose at their time
  double ate_rmse = 0, ate_median = 0, ate_largest = 0;  ///< m, absolute trajectory error
  double rpe = 0;                                        ///< m, RMSE of the motion over `rpe_seconds`
  std::optional<double> heading_rmse_deg;                ///< absent if the truth has no heading
  std::optional<Consistency> consistency;                ///< of the covariances (x, y, yaw)
  std::optional<Consistency> innovations;                ///< NIS over its rows; from the track alone
  std::optional<double> update_seconds;                  ///< mean, if the track has times
  std::int64_t matches = 0, rejected = 0;
  std::optional<std::int64_t> wrong_matches = 0;  ///< absent if the log has no identities to check by
  double lost = 0;                                ///< fraction of the rows
};

/// Compares a track with the truth. `headings`: whether the truth has yaw (a GNSS track has none). ANEES is
/// computed with alignment `none` only. True poses at most `max_gap` seconds apart are interpolated.
TrackScore score(const Track& track, std::span<const StampedPose> truth, TrackAlignment alignment,
                 bool headings, double rpe_seconds = 1, double max_gap = 0.5);

}  // namespace waymark::localization
