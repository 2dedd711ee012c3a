// SPDX-License-Identifier: Apache-2.0
#include "localization/track_score.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cassert>
#include <vector>

#include "core/median.hpp"
#include "localization/chi_square.hpp"
#include "localization/robot_log.hpp"

namespace waymark::localization {
namespace {

constexpr std::size_t kMaxValues = 4096;  // autocorrelations cost up to the square of it

double mean(std::span<const double> values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

// Resamples to equally spaced times, holding values: autocorrelations are by lag in time, not in rows.
std::vector<double> evenly(std::span<const double> t, std::span<const double> values) {
  const std::size_t count = std::min(values.size(), kMaxValues);
  const double step = (t.back() - t.front()) / static_cast<double>(std::max<std::size_t>(count, 2) - 1);
  std::vector<double> even;
  std::size_t row = 0;
  for (std::size_t i = 0; i < count; ++i) {
    while (row + 1 < t.size() && t[row + 1] <= t.front() + step * static_cast<double>(i)) ++row;
    even.push_back(values[row]);
  }
  return even;
}

double effective_number(std::vector<double> x) {
  const double middle = mean(x);
  for (double& v : x) v -= middle;
  const auto product = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t i = 0; i + lag < x.size(); ++i) sum += x[i] * x[i + lag];
    return sum;
  };
  const double variance = product(0);
  if (!(variance > 0)) return 1;
  double sum = 0, before = 2;
  for (std::size_t lag = 0; lag + 1 < x.size(); lag += 2) {
    const double pair = std::min(before, (product(lag) + product(lag + 1)) / variance);
    if (!(pair > 0)) break;
    sum += before = pair;
  }
  const auto count = static_cast<double>(x.size());
  return std::clamp(count / std::max(2 * sum - 1, 1e-12), 1.0, count);
}

double root_mean_square(const std::vector<double>& errors) {
  double sum = 0;
  for (const double e : errors) sum += e * e;
  return errors.empty() ? 0 : std::sqrt(sum / static_cast<double>(errors.size()));
}

struct Pair {
  const TrackRow* row;
  Pose2 truth;
};

double relative_error(const std::vector<Pair>& pairs, double seconds) {
  std::vector<double> errors;
  std::size_t j = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    while (j < pairs.size() && pairs[j].row->t < pairs[i].row->t + seconds) ++j;
    if (j == pairs.size() || pairs[j].row->t > pairs[i].row->t + 2 * seconds) continue;
    const Pose2 estimated = inverse(pairs[i].row->at.pose) * pairs[j].row->at.pose;
    const Pose2 real = inverse(pairs[i].truth) * pairs[j].truth;
    errors.push_back((estimated.at() - real.at()).norm());
  }
  return root_mean_square(errors);
}

// Without headings, compares the motion in the aligned frame.
double relative_place_error(const std::vector<Pair>& pairs, double seconds, const PlaneAlignment& aligned) {
  std::vector<double> errors;
  std::size_t j = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    while (j < pairs.size() && pairs[j].row->t < pairs[i].row->t + seconds) ++j;
    if (j == pairs.size() || pairs[j].row->t > pairs[i].row->t + 2 * seconds) continue;
    const Eigen::Vector2d estimated =
        aligned(pairs[j].row->at.pose.at()) - aligned(pairs[i].row->at.pose.at());
    errors.push_back((estimated - (pairs[j].truth.at() - pairs[i].truth.at())).norm());
  }
  return root_mean_square(errors);
}

}  // namespace

Consistency consistency(std::span<const double> t, std::span<const double> squares, double dimensions) {
  assert(!squares.empty() && t.size() == squares.size() && dimensions > 0);
  Consistency c{.anees = mean(squares) / dimensions, .independent = effective_number(evenly(t, squares))};
  const double freedom = dimensions * c.independent;
  c.low = chi_square_quantile(0.025, freedom) / freedom;
  c.high = chi_square_quantile(0.975, freedom) / freedom;
  return c;
}

Eigen::Vector2d PlaneAlignment::operator()(const Eigen::Vector2d& p) const {
  const double c = std::cos(motion.yaw), s = std::sin(motion.yaw);
  return {motion.x + scale * (c * p.x() - s * p.y()), motion.y + scale * (s * p.x() + c * p.y())};
}

PlaneAlignment align(std::span<const Eigen::Vector2d> from, std::span<const Eigen::Vector2d> to,
                     TrackAlignment kind) {
  if (kind == TrackAlignment::none || from.size() < 2) return {};
  Eigen::Vector2d a = Eigen::Vector2d::Zero(), b = a;
  for (std::size_t i = 0; i < from.size(); ++i) a += from[i], b += to[i];
  a /= static_cast<double>(from.size());
  b /= static_cast<double>(from.size());
  double dot = 0, cross = 0, spread = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Eigen::Vector2d p = from[i] - a, q = to[i] - b;
    dot += p.dot(q);
    cross += p.x() * q.y() - p.y() * q.x();
    spread += p.squaredNorm();
  }
  if (!(spread > 0)) return {};
  PlaneAlignment result;
  result.motion.yaw = std::atan2(cross, dot);
  if (kind == TrackAlignment::sim2) result.scale = std::hypot(dot, cross) / spread;
  const Eigen::Vector2d shift = b - result(a);
  result.motion.x = shift.x(), result.motion.y = shift.y();
  return result;
}

namespace {

// Scores innovations and times, which need no truth.
void score_updates(TrackScore& s, const Track& track) {
  std::vector<double> times, squares;
  double rows = 0, seconds = 0, updates = 0;
  for (const TrackRow& row : track.rows) {
    if (row.seconds > 0) seconds += row.seconds, ++updates;
    if (row.nis_rows == 0) continue;
    times.push_back(row.t), squares.push_back(row.nis);
    rows += row.nis_rows;
  }
  if (!times.empty()) s.innovations = consistency(times, squares, rows / static_cast<double>(times.size()));
  if (updates > 0) s.update_seconds = seconds / updates;
}

}  // namespace

TrackScore score(const Track& track, std::span<const StampedPose> truth, TrackAlignment alignment,
                 bool headings, double rpe_seconds, double max_gap) {
  TrackScore s;
  std::vector<Pair> pairs;
  std::vector<Eigen::Vector2d> from, to;
  std::int64_t wrong = 0;
  for (const TrackRow& row : track.rows) {
    s.matches += row.matched;
    s.rejected += row.rejected;
    wrong += row.wrong;
    s.lost += row.lost;
    if (const auto real = pose_at(truth, row.t, max_gap)) {
      pairs.push_back({&row, *real});
      from.push_back(row.at.pose.at());
      to.push_back(real->at());
    }
  }
  if (s.matches == 0 || track.named > 0)
    s.wrong_matches = wrong;
  else
    s.wrong_matches.reset();
  if (!track.rows.empty()) s.lost /= static_cast<double>(track.rows.size());
  score_updates(s, track);
  s.poses = pairs.size();
  if (pairs.empty()) return s;
  const PlaneAlignment aligned = align(from, to, alignment);
  std::vector<double> places, turns, times, squares;
  for (const Pair& p : pairs) {
    const Eigen::Vector2d off = aligned(p.row->at.pose.at()) - p.truth.at();
    places.push_back(off.norm());
    const double turn = wrap_angle(p.row->at.pose.yaw + aligned.motion.yaw - p.truth.yaw);
    turns.push_back(turn / kRadiansPerDegree);
    const Eigen::Vector3d e(off.x(), off.y(), turn);
    const Eigen::LLT<Eigen::Matrix3d> cholesky(p.row->at.covariance);
    if (alignment != TrackAlignment::none || !headings || cholesky.info() != Eigen::Success) continue;
    const double square = cholesky.matrixL().solve(e).squaredNorm();
    if (!std::isfinite(square)) continue;
    times.push_back(p.row->t);
    squares.push_back(square);
  }
  s.ate_rmse = root_mean_square(places);
  s.ate_median = median(places);
  s.ate_largest = *std::ranges::max_element(places);
  if (headings) s.heading_rmse_deg = root_mean_square(turns);
  s.rpe = headings ? relative_error(pairs, rpe_seconds) : relative_place_error(pairs, rpe_seconds, aligned);
  if (!squares.empty()) s.consistency = consistency(times, squares, 3);
  return s;
}

}  // namespace waymark::localization
