// SPDX-License-Identifier: Apache-2.0
// Poses next to an expected one: every sighting votes with every landmark that it could be for the poses at
// which both agree (correlative matching; Olson 2009).
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/covariance.hpp"
#include "core/grid.hpp"
#include "localization/global/constellation_search.hpp"

namespace waymark::localization {
namespace {

constexpr double kPriorSigmas = 3;
constexpr double kVoteCell = 2;         // standard deviations of a pair
constexpr double kMaxVotes = 2e7;       // pairs times headings
constexpr int kMinVotes = 3;            // of a pose that is compared with all sightings
constexpr std::size_t kMaxNear = 3000;  // poses that are

}  // namespace

ConstellationAnswer ConstellationSearch::find_near(const PoseEstimate& prior) {
  if (index_.size() == 0) return {.fix = {}, .reason = "the map is empty", .candidates = {}};
  if (points_.size() < static_cast<std::size_t>(o_.min_matches))
    return {.fix = {}, .reason = kTooFewSightings, .candidates = {}};
  volume_ = std::min(volume_, volume_of(prior.covariance));
  guess_near(prior);
  if (guesses_.empty()) return {.fix = {}, .reason = "no such constellation near", .candidates = {}};
  ConstellationAnswer answer{.fix = {}, .reason = {}, .candidates = fit_guesses()};
  answer.reason = verdict(answer.candidates, 0);
  if (answer.reason.empty()) answer.fix = answer.candidates[0];
  return answer;
}

void ConstellationSearch::guess_near(const PoseEstimate& prior) {
  std::vector<double> sds;
  for (const Seen& s : points_) sds.push_back(s.sd);
  std::ranges::nth_element(sds, sds.begin() + std::ssize(sds) / 2);
  const double cell = kVoteCell * std::max(1e-3, std::hypot(sds[sds.size() / 2], index_.typical_sd_));
  const double reach = kPriorSigmas * largest_sd(prior.covariance.topLeftCorner<2, 2>()) + cell;
  const double turn = std::min(std::numbers::pi, kPriorSigmas * std::sqrt(prior.covariance(2, 2)));
  const double step = cell / std::max(extent_, cell);
  const auto turns = static_cast<std::int64_t>(std::ceil(turn / step));
  const auto side = static_cast<std::int64_t>(std::ceil(reach / cell)) * 2 + 1;
  const double density = static_cast<double>(index_.size()) / index_.area_;
  const double votes = static_cast<double>(points_.size()) * std::numbers::pi * reach * reach * density;
  if (!(std::max(votes, static_cast<double>(side * side)) * static_cast<double>(2 * turns + 1) < kMaxVotes))
    return;

  const Eigen::Vector2d origin = index_.positions_[0].at.head<2>();
  const double height = index_.positions_[0].at.z();
  Grid<std::uint16_t> found(side, side);
  for (std::int64_t t = -turns; t <= turns; ++t) {
    const double yaw = wrap_angle(prior.pose.yaw + static_cast<double>(t) * step);
    const Eigen::Matrix2d r = rotation(yaw);
    std::ranges::fill(found.cells(), std::uint16_t{0});
    for (const Seen& s : points_) {
      const Eigen::Vector2d at = prior.pose.at() + r * s.at;
      index_.cells_.near({at.x(), at.y(), height}, reach, [&](std::uint32_t i, double) {
        if (!alike(s, i)) return;
        const Eigen::Vector2d d = (index_.positions_[i].at.head<2>() - at) / cell;
        const auto c = static_cast<std::int64_t>(std::floor(d.x())) + side / 2,
                   row = static_cast<std::int64_t>(std::floor(d.y())) + side / 2;
        if (found.contains(c, row)) ++found(c, row);
      });
    }
    for (std::int64_t row = 0; row + 1 < side; ++row)
      for (std::int64_t c = 0; c + 1 < side; ++c) {
        const int count = found(c, row) + found(c + 1, row) + found(c, row + 1) + found(c + 1, row + 1);
        if (count < kMinVotes) continue;
        const Eigen::Vector2d shift =
            cell * Eigen::Vector2d(double(c + 1 - side / 2), double(row + 1 - side / 2));
        guesses_.push_back({0, prior.pose.at() + shift + r * middle_ - origin, yaw, double(count)});
      }
  }
  std::ranges::stable_sort(guesses_, std::greater<>{}, &Guess::weight);
  if (guesses_.size() > kMaxNear) guesses_.resize(kMaxNear);
}

ConstellationAnswer ConstellationIndex::find_near(const SightingSet& seen, const PoseEstimate& prior) const {
  return ConstellationSearch(*this, seen).find_near(prior);
}

}  // namespace waymark::localization
