// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <numbers>
#include <unordered_map>

#include "localization/global/chance_matches.hpp"
#include "localization/global/constellation_search.hpp"

namespace waymark::localization {
namespace {

constexpr std::size_t kKept = 10;
constexpr std::int64_t kSupportTests = 50;  // poses compared with all sightings for each that is fitted
constexpr std::size_t kFirstCompared = 8;   // sightings of a pose that votes alone do not rank
constexpr double kSupportSlack = 1.5;       // a guess uses three sightings only
constexpr double kNearby = 16;              // area about a sighting over that of its gate

template <class Crowd>
void keep_best(std::vector<Crowd>& crowds, std::size_t max_count) {
  const auto count = std::min(crowds.size(), max_count);
  std::partial_sort(crowds.begin(), crowds.begin() + static_cast<std::ptrdiff_t>(count), crowds.end(),
                    [](const Crowd& a, const Crowd& b) {
                      return a.weight != b.weight ? a.weight > b.weight : a.first < b.first;
                    });
  crowds.resize(count);
}

}  // namespace

Eigen::Matrix2d rotation(double yaw) {
  return Eigen::Rotation2Dd(yaw).toRotationMatrix();
}

double volume_of(const Eigen::Matrix3d& covariance) {
  return std::pow(2 * std::numbers::pi, 1.5) * std::sqrt(std::max(covariance.determinant(), 1e-300));
}

std::vector<ConstellationFix> ConstellationSearch::fit_guesses() {
  double sd = index_.typical_sd_;
  for (const Seen& s : points_) sd = std::max(sd, s.sd);
  const double cell = std::max(3 * sd, 1e-6), turn = 0.15;
  std::unordered_map<std::uint64_t, Crowd> crowds;
  const auto key = [&](const Guess& g) {
    const Eigen::Vector3d at = plane_at(index_.positions_[g.anchor]).point(g.middle) / cell;
    std::uint64_t k = mix_bits(static_cast<std::uint64_t>(std::llround(wrap_angle(g.yaw) / turn)));
    for (int i = 0; i < 3; ++i) k = mix_bits(k ^ static_cast<std::uint64_t>(std::llround(at[i])));
    return k;
  };
  for (std::size_t i = 0; i < guesses_.size(); ++i) {
    auto [crowd, fresh] = crowds.try_emplace(key(guesses_[i]), Crowd{.weight = 0, .first = i});
    crowd->second.weight += guesses_[i].weight;
  }
  std::vector<Crowd> ranked;
  for (const auto& [k, crowd] : crowds) ranked.push_back(crowd);
  std::vector<ConstellationFix> fixes;
  for (const std::size_t i : best_guesses(std::move(ranked)))
    if (auto fix = fit(guesses_[i])) keep(fixes, std::move(*fix));
  std::ranges::stable_sort(fixes, {}, badness);
  if (fixes.size() > kKept) fixes.resize(kKept);
  return fixes;
}

// Triangles are of neighbours. Where a robot sees one landmark in five, as terrain and height of its sensor
// hide the others, few triangles of its sightings are in the index, and votes alone do not rank the right
// pose.
std::vector<std::size_t> ConstellationSearch::best_guesses(std::vector<Crowd> by_votes) const {
  const auto max_supported = static_cast<std::size_t>(kSupportTests * o_.max_tried);
  std::vector<Crowd> by_sample;
  if (!o_.had_pose && by_votes.size() > max_supported) {
    by_sample = by_votes;
    for (Crowd& crowd : by_sample) crowd.weight = support(guesses_[crowd.first], kFirstCompared);
    keep_best(by_sample, max_supported);
  }
  keep_best(by_votes, max_supported);
  std::vector<std::size_t> best;
  for (std::vector<Crowd>* crowds : {&by_votes, &by_sample}) {
    for (Crowd& crowd : *crowds) crowd.weight = support(guesses_[crowd.first], points_.size());
    keep_best(*crowds, static_cast<std::size_t>(o_.max_tried));
    for (const Crowd& crowd : *crowds)
      if (std::ranges::find(best, crowd.first) == best.end()) best.push_back(crowd.first);
  }
  return best;
}

// A vote counts three sightings, and many poses share a cell of the votes: this compares all of them.
double ConstellationSearch::support(const Guess& g, std::size_t max_count) const {
  const LandmarkPosition& anchor = index_.positions_[g.anchor];
  const TangentPlane plane = plane_at(anchor);
  const bool is_plane = plane.east == Eigen::Vector3d::UnitX();
  const Eigen::Matrix2d r = rotation(g.yaw);
  const double density = static_cast<double>(index_.size()) / index_.area_;
  double sum = 0;
  const std::size_t count = std::min(max_count, points_.size());
  for (std::size_t k = 0; k < count; ++k) {
    const Seen& s = points_[k * points_.size() / count];
    Eigen::Vector3d at = plane.point(g.middle + r * (s.at - middle_));
    if (!is_plane) at *= anchor.at.norm() / at.norm();
    const double radius = kSupportSlack * o_.sigmas * std::hypot(s.sd, index_.typical_sd_);
    bool fits = false;
    index_.cells_.near(at, radius, [&](std::uint32_t i, double) {
      fits = fits || (alike(s, i) && faces_alike(s, i, g.yaw));
    });
    if (fits) sum -= std::log(-std::expm1(-density * s.rarity * std::numbers::pi * radius * radius));
  }
  return sum;
}

void ConstellationSearch::keep(std::vector<ConstellationFix>& fixes, ConstellationFix fix) const {
  for (ConstellationFix& other : fixes) {
    const Eigen::Vector3d apart =
        other.plane.point(other.plane_pose.pose.at()) - fix.plane.point(fix.plane_pose.pose.at());
    std::size_t shared = 0;
    for (std::size_t i = 0; i < fix.landmarks.size(); ++i)
      shared += fix.landmarks[i] && fix.landmarks[i] == other.landmarks[i];
    if (2 * shared < static_cast<std::size_t>(fix.matched) && apart.norm() > 3 * combined_sd(fix, other))
      continue;
    if (2 * shared < static_cast<std::size_t>(fix.matched)) continue;
    if (badness(fix) < badness(other)) other = std::move(fix);
    return;
  }
  fixes.push_back(std::move(fix));
}

double ConstellationSearch::combined_sd(const ConstellationFix& a, const ConstellationFix& b) {
  return std::sqrt(a.plane_pose.covariance.diagonal().head<2>().sum() +
                   b.plane_pose.covariance.diagonal().head<2>().sum());
}

std::optional<ConstellationFix> ConstellationSearch::fit(const Guess& g) const {
  // The plane touches the surface at the expected centroid of the sightings, where distances are true.
  LandmarkPosition middle = index_.positions_[g.anchor];
  const TangentPlane first = plane_at(middle);
  TangentPlane plane = first;
  Eigen::Vector2d offset = g.middle;
  std::vector<Local> locals;
  const double reach = 1.3 * extent_ + 3 * o_.sigmas * index_.typical_sd_ + 1e-9;
  index_.cells_.near(first.point(offset), reach, [&](std::uint32_t i, double) {
    locals.push_back({i, flatten(plane, index_.positions_[i].at)});
  });
  if (locals.size() < 2) return {};
  std::ranges::sort(locals, {}, &Local::landmark);

  // From the pose of the centroid to that of the robot.
  const Eigen::Vector2d robot = offset - rotation(g.yaw) * middle_;
  PoseEstimate e{{robot.x(), robot.y(), wrap_angle(g.yaw)}, Eigen::Matrix3d::Zero()};
  double slack = 2;  // a guess uses three sightings only; tightened as more are matched
  Matches matches, last;
  for (int round = 0; round < 6; ++round) {
    matches = match(e.pose, locals, slack);
    if (round > 1 && matches == last) break;
    last = matches;
    if (!adjust(e, matches, locals)) return {};
    slack = std::max(1.0, slack * 0.7);
  }
  matches = match(e.pose, locals, 1);
  if (!adjust(e, matches, locals)) return {};
  return evaluate_fix(e, plane, matches, locals);
}

Eigen::Matrix2d ConstellationSearch::spread(const Seen& s, const Pose2& pose, std::uint32_t landmark) const {
  const Eigen::Matrix2d r = rotation(pose.yaw);
  return r * s.covariance * r.transpose() + index_.landmarks_[landmark].covariance;
}

ConstellationSearch::Matches ConstellationSearch::match(const Pose2& pose, const std::vector<Local>& locals,
                                                        double slack) const {
  struct Pair {
    double squares;
    std::size_t seen;
    std::uint32_t local;
  };
  std::vector<Pair> pairs;
  const double gate = o_.sigmas * o_.sigmas * slack * slack;
  const Eigen::Matrix2d r = rotation(pose.yaw);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Eigen::Vector2d at = pose.at() + r * points_[i].at;
    const Eigen::Matrix2d seen = r * points_[i].covariance * r.transpose();
    for (std::uint32_t k = 0; k < locals.size(); ++k) {
      const double dx = locals[k].at.x() - at.x(), dy = locals[k].at.y() - at.y(), square = dx * dx + dy * dy;
      const Eigen::Matrix2d& mapped = index_.landmarks_[locals[k].landmark].covariance;
      const double a = seen(0, 0) + mapped(0, 0), d = seen(1, 1) + mapped(1, 1);
      if (square > gate * (a + d)) continue;
      const double b = seen(0, 1) + mapped(0, 1);
      const double squares = (d * dx * dx - 2 * b * dx * dy + a * dy * dy) / (a * d - b * b);
      if (squares <= gate && alike(points_[i], locals[k].landmark) &&
          faces_alike(points_[i], locals[k].landmark, pose.yaw))
        pairs.push_back({squares, i, k});
    }
  }
  std::ranges::stable_sort(pairs, {}, &Pair::squares);
  Matches matches(points_.size());
  std::vector<bool> taken(locals.size(), false);
  for (const Pair& p : pairs)
    if (!matches[p.seen] && !taken[p.local]) {
      matches[p.seen] = p.local;
      taken[p.local] = true;
    }
  return matches;
}

bool ConstellationSearch::adjust(PoseEstimate& e, const Matches& matches,
                                 const std::vector<Local>& locals) const {
  for (int step = 0; step < 2; ++step) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d information_vector = Eigen::Vector3d::Zero();
    const Eigen::Matrix2d r = rotation(e.pose.yaw);
    int count = 0;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      if (!matches[i]) continue;
      const Local& l = locals[*matches[i]];
      const Eigen::Vector2d seen = r * points_[i].at;
      Eigen::Matrix<double, 2, 3> j;
      j << 1, 0, -seen.y(), 0, 1, seen.x();
      const Eigen::Matrix2d weight = spread(points_[i], e.pose, l.landmark).inverse();
      information += j.transpose() * weight * j;
      information_vector += j.transpose() * weight * (l.at - e.pose.at() - seen);
      ++count;
    }
    if (count < 2) return false;
    const Eigen::LDLT<Eigen::Matrix3d> solver(information);
    if (solver.info() != Eigen::Success || !solver.isPositive()) return false;
    const Eigen::Vector3d change = solver.solve(information_vector);
    if (!change.allFinite()) return false;
    e.pose = pose_of(e.pose.vector() + change);
    e.covariance = solver.solve(Eigen::Matrix3d::Identity());
  }
  return e.covariance.allFinite();
}

// Landmarks cluster, and sightings in a cluster match more often by chance than the mean density says.
double ConstellationSearch::intensity_near(const Seen& s, const Pose2& pose, const std::vector<Local>& locals,
                                           std::optional<std::uint32_t> except, double area) const {
  const Eigen::Vector2d at = pose.at() + rotation(pose.yaw) * s.at;
  const double square = area / std::numbers::pi;
  double count = 0;
  for (std::uint32_t k = 0; k < locals.size(); ++k)
    if (k != except && (locals[k].at - at).squaredNorm() < square) count += alike(s, locals[k].landmark);
  return count / area;
}

ConstellationFix ConstellationSearch::evaluate_fix(const PoseEstimate& e, const TangentPlane& plane,
                                                   const Matches& matches,
                                                   const std::vector<Local>& locals) const {
  ConstellationFix fix{
      .plane = plane, .plane_pose = e, .landmarks = {}, .matched = 0, .squares = 0, .log_false_alarms = 0};
  fix.landmarks.resize(total_);
  const double reach = 1.3 * extent_ + 1e-9;
  const double density = static_cast<double>(locals.size()) / (std::numbers::pi * reach * reach);
  std::vector<ChanceMatch> chances;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::uint32_t typical = matches[i] ? locals[*matches[i]].landmark : locals[0].landmark;
    const double area = std::numbers::pi * o_.sigmas * o_.sigmas *
                        std::sqrt(spread(points_[i], e.pose, typical).determinant());
    const double intensity = std::max(density * points_[i].rarity,
                                      intensity_near(points_[i], e.pose, locals, matches[i], kNearby * area));
    chances.push_back({-std::expm1(-intensity * area), matches[i].has_value(), 0});
    if (!matches[i]) continue;
    const Local& l = locals[*matches[i]];
    const Eigen::Vector2d d = l.at - e.pose.at() - rotation(e.pose.yaw) * points_[i].at;
    chances.back().squares = d.dot(spread(points_[i], e.pose, l.landmark).inverse() * d);
    fix.squares += chances.back().squares;
    fix.landmarks[points_[i].index] = l.landmark;
    ++fix.matched;
  }
  const double chance = chance_of_matches(chances, o_.sigmas * o_.sigmas);
  // Number of distinguishable poses: the volume of all over the volume of one.
  fix.log_false_alarms =
      std::log(std::max(chance, 1e-300)) + std::log(std::max(1.0, volume_ / volume_of(e.covariance)));
  return fix;
}

}  // namespace waymark::localization
