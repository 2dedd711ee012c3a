// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include "localization/consistency.hpp"
#include "localization/robot_log.hpp"
#include "localization/track.hpp"
namespace waymark {

/// How a track is laid over the truth before errors are measured (Umeyama 1991).
enum class TrackAlignment { none, se2, sim2 };

/// A similarity of the plane: p -> scale R(yaw) p + (x, y).
struct PlaneAlignment {
  Pose2 motion;
  double scale = 1;
  Eigen::Vector2d operator()(const Eigen::Vector2d& p) const;
};

/// Least squares over pairs of points; identity with fewer than two different ones.
PlaneAlignment align(std::span<const Eigen::Vector2d> from, std::span<const Eigen::Vector2d> to,
                     TrackAlignment kind);

struct TrackScore {
  std::size_t poses = 0;                                 ///< rows with a true pose at their time
  double ate_rmse = 0, ate_median = 0, ate_largest = 0;  ///< m, absolute trajectory error
  double rpe = 0;                                        ///< m, RMSE of the motion over `rpe_seconds`
  std::optional<double> heading_rmse_deg;                ///< absent where the truth has no heading
  std::optional<Consistency> consistency;                ///< of covariances (x, y, yaw)
  std::optional<Consistency> innovations;                ///< NIS over its rows; from the track alone
  std::optional<double> update_seconds;                  ///< mean, where the track tells it
  std::int64_t matches = 0, rejected = 0, wrong_matches = 0;
  double lost = 0;  ///< part of the rows
};

/// `headings`: whether the yaw of the truth means anything (a GNSS track has none). ANEES is measured with
/// alignment `none` only. `longest_gap`: s between two true poses that may be interpolated.
TrackScore score(const Track& track, std::span<const StampedPose> truth, TrackAlignment alignment,
                 bool headings, double rpe_seconds = 1, double longest_gap = 0.5);

}  // namespace waymark
