// SPDX-License-Identifier: Apache-2.0
#include "localization/global/skyline_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "localization/global/skyline_view.hpp"

namespace waymark::localization {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr int kRounds = 6, kRing = 720;
constexpr double kStandsOut = kTurn / kRing;
constexpr double kFinest = 0.0015;  // rad between rays
constexpr double kMissed = 0.05;    // probability that a top is not on the horizon of the DEM

class HorizonFit {
 public:
  HorizonFit(const SkylineScene& scene, std::span<const HorizonTop> tops)
      : terrain_(scene.terrain),
        summits_(scene.summits),
        o_(scene.options),
        tops_(tops),
        points_(tops.size()),
        named_(tops.size()),
        matches_(tops.size()),
        squares_(tops.size()),
        ground_([this](const Eigen::Vector2d& p) -> std::optional<double> {
          const double h = terrain_.height(p.x(), p.y());
          return std::isfinite(h) ? std::optional(h) : std::nullopt;
        }) {}

  std::optional<SkylineFix> find(const HorizonGuess& guess, double place) {
    PoseEstimate e{{guess.at.x(), guess.at.y(), guess.yaw}, Eigen::Matrix3d::Identity()};
    const double first = place;
    double turn = kTurn / kHorizonSectors;
    for (int round = 0; round < kRounds; ++round) {
      if (!match(e.pose, place, turn)) return {};
      const auto next = resection(tops_, points_, matches_, e, ground_, o_);
      if (!next || (next->pose.at() - guess.at).norm() > 4 * first + 4 * terrain_.cell()) return {};
      e = *next;
      if (round >= 2 && 4 * std::ranges::count_if(matches_, [](auto& m) { return !!m; }) < std::ssize(tops_))
        return {};  // too few matches to improve
      place *= 0.4, turn *= 0.4;
    }
    if (!match(e.pose, 0, 0)) return {};
    const auto last = resection(tops_, points_, matches_, e, ground_, o_);
    if (!last || !match(last->pose, 0, 0)) return {};
    return evaluate_fix(*last);
  }

 private:
  double eye(const Pose2& pose) const { return terrain_.height(pose.x, pose.y) + o_.eye; }

  /// Returns the squared distance of a top and a point of the terrain.
  double squared_distance(std::size_t i, const Pose2& pose, const SummitView& v, double place,
                          double turn) const {
    const HorizonTop& top = tops_[i];
    const double across = std::hypot(o_.position_sd, place) / v.distance;
    const double up = (o_.height_sd + 0.3 * place) / v.distance;
    const double db = wrap_angle(top.bearing - v.azimuth + pose.yaw), de = *top.elevation - v.elevation;
    return db * db / (top.bearing_sd * top.bearing_sd + across * across + turn * turn) +
           de * de / (top.elevation_sd * top.elevation_sd + up * up);
  }

  void match_horizon(std::size_t i, const Pose2& pose, double height, double place, double turn) {
    const double bend = curvature_drop(1, o_.body_radius, o_.refraction);
    const double azimuth = pose.yaw + tops_[i].bearing;
    const HorizonEdge middle = horizon_at(terrain_, pose.at(), height, azimuth, o_);
    const double far = std::max(double(middle.far), 5 * terrain_.cell());
    const double half =
        std::min(o_.sigmas * std::hypot(tops_[i].bearing_sd, o_.position_sd / far, turn + place / far), 0.3);
    const double fine = std::clamp(half / 12, kFinest, kStandsOut / 2);
    // A top is higher than all directions within kStandsOut of it.
    const int beside = static_cast<int>(std::lround(kStandsOut / fine)),
              n = static_cast<int>(std::ceil(half / fine)) + beside;
    std::vector<HorizonEdge> edge;
    for (int k = -n; k <= n; ++k)
      edge.push_back(k == 0 ? middle : horizon_at(terrain_, pose.at(), height, azimuth + k * fine, o_));
    for (int k = beside; k + beside <= 2 * n; ++k) {
      const HorizonEdge& h = edge[static_cast<std::size_t>(k)];
      const auto lower = [&](int j) { return edge[static_cast<std::size_t>(k + j)].rise <= h.rise; };
      bool top = h.far > 0;
      for (int j = 1; j <= beside && top; ++j) top = lower(j) && lower(-j);
      if (!top) continue;
      const double a = azimuth + (k - n) * fine, d = h.far;
      const double squares = squared_distance(i, pose, {a, std::atan(double(h.rise)), d}, place, turn);
      if (!(squares < squares_[i])) continue;
      squares_[i] = squares;
      matches_[i] = static_cast<std::uint32_t>(i);
      points_[i] = {.at = pose.at() + d * Eigen::Vector2d(std::cos(a), std::sin(a)),
                    .height = double(h.rise) * d + bend * d * d + height};
    }
  }

  bool is_unobstructed(const SkylineSummit& s, const Eigen::Vector3d& from) const {
    const Eigen::Vector3d top(s.at.x(), s.at.y(), s.height + o_.height_sd);
    return clears_terrain(from, top, ground_, o_, std::max(terrain_.cell(), o_.position_sd),
                          3 * o_.position_sd + 100);
  }

  bool match(const Pose2& pose, double place, double turn) {
    const double height = eye(pose);
    if (!std::isfinite(height)) return false;
    for (std::size_t i = 0; i < tops_.size(); ++i) {
      squares_[i] = o_.sigmas * o_.sigmas;
      matches_[i].reset(), named_[i].reset();
      if (tops_[i].elevation) match_horizon(i, pose, height, place, turn);
    }
    for (std::uint32_t j = 0; j < summits_.size(); ++j) {
      const SummitView v = view_summit(summits_[j], pose.at(), height, o_);
      if (v.distance > o_.reach) continue;
      for (std::size_t i = 0; i < tops_.size(); ++i) {
        if (!tops_[i].elevation) continue;
        if (std::abs(*tops_[i].elevation - v.elevation) >
            0.01 + o_.sigmas * (o_.height_sd + 0.3 * place) / v.distance)
          continue;
        // The summit at the position of a matched top names it.
        if (matches_[i] &&
            (points_[i].at - summits_[j].at).norm() < 2 * o_.position_sd + 2 * terrain_.cell() &&
            (!named_[i] ||
             (points_[i].at - summits_[*named_[i]].at).norm() > (points_[i].at - summits_[j].at).norm())) {
          named_[i] = j;
          // A summit's position is more precise than the point where a ray meets its flank.
          if (const double squares = squared_distance(i, pose, v, place, turn); squares < squares_[i] + 2) {
            squares_[i] = squares;
            points_[i] = summits_[j];
          }
          continue;
        }
        const double squares = squared_distance(i, pose, v, place, turn);
        if (!(squares < squares_[i]) || !is_unobstructed(summits_[j], {pose.x, pose.y, height})) continue;
        squares_[i] = squares;
        matches_[i] = static_cast<std::uint32_t>(i);
        points_[i] = summits_[j];
        named_[i] = j;
      }
    }
    return true;
  }

  /// Counts the local maxima of the whole horizon: the candidates for each top.
  int maxima(const Pose2& pose, double height) const {
    std::vector<float> rise;
    for (int k = 0; k < kRing; ++k)
      rise.push_back(horizon_at(terrain_, pose.at(), height, k * kTurn / kRing, o_).rise);
    int count = 0;
    for (std::size_t k = 0; k < kRing; ++k)
      count += rise[k] > -1e8F && rise[k] >= rise[(k + kRing - 1) % kRing] && rise[k] > rise[(k + 1) % kRing];
    return std::max(count, 1);
  }

  /// Computes the evidence for the pose: each top is one of the maxima of its horizon, or arbitrary.
  SkylineFix evaluate_fix(const PoseEstimate& e) const {
    SkylineFix fix{
        .at = e, .summits = named_, .matched = 0, .compared = 0, .squares = 0, .log_false_alarms = 0};
    const double of_all = (1 - kMissed) / maxima(e.pose, eye(e.pose));
    double sum = 0, squares = 0, usable = 0;
    for (const HorizonTop& t : tops_)
      if (t.elevation) sum += *t.elevation, squares += *t.elevation * *t.elevation, ++usable;
    const double mean = sum / std::max(usable, 1.0),
                 spread = std::sqrt(std::max(squares / std::max(usable, 1.0) - mean * mean, 1e-4));
    for (std::size_t i = 0; i < tops_.size(); ++i) {
      if (!tops_[i].elevation) continue;
      ++fix.compared;
      double ratio = kMissed;  // density of the top at this pose over that of an arbitrary top
      if (matches_[i]) {
        ++fix.matched;
        fix.squares += squares_[i];
        const double far = std::max(1.0, (points_[i].at - e.pose.at()).norm());
        const double sb = std::hypot(tops_[i].bearing_sd, o_.position_sd / far),
                     se = std::hypot(tops_[i].elevation_sd, o_.height_sd / far);
        // Arbitrary tops have the same elevations and any bearing; all factors 2 pi but one cancel.
        const double off = std::min(std::abs(*tops_[i].elevation - mean) / spread, 2.0);
        const double band = std::sqrt(kTurn) * spread * std::exp(off * off / 2);
        ratio += of_all * band * std::exp(-squares_[i] / 2) / (sb * se);
      }
      fix.log_false_alarms -= std::log(ratio);
    }
    const double one = std::pow(kTurn, 1.5) * std::sqrt(std::max(e.covariance.determinant(), 1e-300));
    fix.log_false_alarms += std::log(std::max(1.0, terrain_.area().volume() * kTurn / one));
    return fix;
  }

  const TerrainGrid& terrain_;
  std::span<const SkylineSummit> summits_;
  const SkylineOptions& o_;
  std::span<const HorizonTop> tops_;
  std::vector<SkylineSummit> points_;                          // on the terrain, one for each matched top
  std::vector<std::optional<std::uint32_t>> named_, matches_;  // summit; index into points_
  std::vector<double> squares_;
  TerrainHeight ground_;
};

}  // namespace

std::optional<SkylineFix> fit_horizon(const SkylineScene& scene, std::span<const HorizonTop> tops,
                                      const HorizonGuess& guess, double place) {
  return HorizonFit(scene, tops).find(guess, place);
}

}  // namespace waymark::localization
