// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_curbs.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>

#include "localization/detectors/cloud_ground.hpp"

namespace waymark::localization {
namespace {

constexpr int kSectors = 720;
constexpr double kProfileTop = 0.5;                     // m above the ground of points of a profile
constexpr double kRise = 0.04, kFaceDepth = 0.25;       // m: a step rises by so much within so much
constexpr double kMaxRowGap = 1.2;                      // m between the rows on both sides of a step
constexpr double kSide = 1.2;                           // m of level surface looked at on each side
constexpr double kLevel = 0.03, kSlope = 0.05;          // m, m/m: by which a level surface may vary
constexpr double kMinSide = 0.15;                       // m of it that must be seen
constexpr double kCurbOffset = 0.1;                     // m of a step from its line
constexpr double kCurbSd = 0.02, kCurbAngleSd = 0.006;  // m, rad: of kerbs that are not straight
constexpr std::size_t kMaxCurbs = 8;

struct ProfilePoint {
  double range, z;
  bool operator<(const ProfilePoint& b) const { return std::tuple(range, z) < std::tuple(b.range, b.z); }
};
using Profile = std::vector<ProfilePoint>;

/// A step in one direction.
struct CurbStep {
  Eigen::Vector2d at;
  double sd, height;
};

std::vector<Profile> profiles_of(const PointCloud& cloud, double max_range) {
  const CloudGround ground(cloud.points, max_range + 2);
  std::vector<Profile> profiles(kSectors);
  for (const Eigen::Vector3f& p : cloud.points) {
    const double range = static_cast<double>(p.head<2>().norm());
    if (!(range < max_range && range > 0.5) || !std::isfinite(p.z())) continue;
    if (!(p.z() - ground.at(p.x(), p.y()) < static_cast<float>(kProfileTop))) continue;
    const double turn =
        std::atan2(static_cast<double>(p.y()), static_cast<double>(p.x())) / (2 * std::numbers::pi);
    const auto sector = static_cast<int>(std::floor(turn * kSectors)) + kSectors / 2;
    profiles[static_cast<std::size_t>(std::clamp(sector, 0, kSectors - 1))].push_back(
        {range, static_cast<double>(p.z())});
  }
  for (Profile& profile : profiles) std::ranges::sort(profile, std::less<>{});
  return profiles;
}

/// Returns the height of a level piece of a profile, from one range to another; `std::nullopt` if it is not
/// level.
std::optional<double> level_height(const Profile& profile, double from, double to) {
  double sum = 0, low = 1e9, high = -1e9, first = 1e9, last = -1e9;
  int count = 0;
  const auto begin = std::ranges::lower_bound(profile, from, {}, &ProfilePoint::range);
  for (auto p = begin; p != profile.end() && p->range <= to; ++p) {
    sum += p->z, ++count;
    low = std::min(low, p->z), high = std::max(high, p->z);
    first = std::min(first, p->range), last = std::max(last, p->range);
  }
  if (count < 2 || last - first < kMinSide || high - low > kLevel + kSlope * (last - first)) return {};
  return sum / count;
}

void find_steps(const Profile& profile, double azimuth, const CloudCurbOptions& options,
                std::vector<CurbStep>& steps) {
  const Eigen::Vector2d direction(std::cos(azimuth), std::sin(azimuth));
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const ProfilePoint& foot = profile[i];
    // The first point that lies higher, on or above the face.
    std::size_t j = i + 1;
    while (j < profile.size() && profile[j].range - foot.range <= kFaceDepth && profile[j].z - foot.z < kRise)
      ++j;
    if (j >= profile.size() || !(profile[j].z - foot.z >= kRise)) continue;
    if (j > i + 1 && profile[j].range - foot.range > kFaceDepth) continue;
    if (!(profile[j].range - foot.range <= kMaxRowGap)) continue;
    const double edge = profile[j].range;
    const auto lower = level_height(profile, foot.range - kSide, foot.range);
    if (!lower || std::abs(foot.z - *lower) > kLevel) continue;
    std::optional<double> upper;  // behind the face
    for (const double behind : {0.0, 0.1, 0.2}) {
      upper = level_height(profile, edge + behind, edge + behind + kSide);
      if (upper) break;
    }
    if (!upper || !(*upper - *lower >= options.min_step && *upper - *lower <= options.max_step)) continue;
    double sum = 0;
    int count = 0;
    for (std::size_t k = i; k <= j + 8 && k < profile.size() && profile[k].range < edge + kFaceDepth; ++k)
      if (profile[k].z > *lower + 0.02 && profile[k].z < *upper - 0.02) sum += profile[k].range, ++count;
    const double gap = edge - foot.range;
    const double range = count > 0 ? sum / count : (edge + foot.range) / 2;
    steps.push_back({range * direction, count > 0 ? 0.03 : 0.02 + gap / std::sqrt(12.0), *upper - *lower});
    while (i + 1 < profile.size() && profile[i + 1].range < edge + kFaceDepth) ++i;  // on to the next step
  }
}

struct CurbLine {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero(), along = Eigen::Vector2d::UnitX();
  double across_variance = 0, spread = 0, weight = 0;
};

bool is_on(const CurbStep& step, const Eigen::Vector2d& on, const Eigen::Vector2d& along) {
  const Eigen::Vector2d d = step.at - on;
  return std::abs(along.x() * d.y() - along.y() * d.x()) <= std::max(kCurbOffset, 1.5 * step.sd);
}

CurbLine fit_curb(const std::vector<CurbStep>& steps) {
  CurbLine line;
  for (const CurbStep& s : steps) line.weight += 1 / (s.sd * s.sd);
  for (const CurbStep& s : steps) line.centre += s.at / (s.sd * s.sd * line.weight);
  double xx = 0, xy = 0, yy = 0;
  for (const CurbStep& s : steps) {
    const Eigen::Vector2d d = s.at - line.centre;
    const double w = 1 / (s.sd * s.sd * line.weight);
    xx += w * d.x() * d.x(), xy += w * d.x() * d.y(), yy += w * d.y() * d.y();
  }
  const double angle = std::atan2(2 * xy, xx - yy) / 2, half = std::hypot((xx - yy) / 2, xy);
  line.along = {std::cos(angle), std::sin(angle)};
  line.spread = (xx + yy) / 2 + half, line.across_variance = std::max(0.0, (xx + yy) / 2 - half);
  return line;
}

/// Returns the longest run of steps along a line without a gap, in order along it.
std::vector<CurbStep> longest_run(std::vector<CurbStep> steps, const Eigen::Vector2d& along, double max_gap) {
  std::ranges::sort(steps, {},
                    [&](const CurbStep& s) { return std::tuple(along.dot(s.at), s.at.x(), s.at.y()); });
  std::size_t best = 0, best_size = 0;
  for (std::size_t first = 0; first < steps.size();) {
    std::size_t end = first + 1;
    while (end < steps.size() && along.dot(steps[end].at - steps[end - 1].at) <= max_gap) ++end;
    if (end - first > best_size) best = first, best_size = end - first;
    first = end;
  }
  return {steps.begin() + static_cast<std::ptrdiff_t>(best),
          steps.begin() + static_cast<std::ptrdiff_t>(best + best_size)};
}

/// Returns the steps of the line through two of them on which most lie.
std::vector<CurbStep> best_line(const std::vector<CurbStep>& steps, const CloudCurbOptions& options) {
  std::vector<CurbStep> best;
  for (std::size_t i = 0; i < steps.size(); ++i)
    for (std::size_t j = i + 1; j < steps.size(); ++j) {
      const Eigen::Vector2d run = steps[j].at - steps[i].at;
      if (!(run.norm() > 1.5 && run.norm() < 6)) continue;
      const Eigen::Vector2d along = run.normalized();
      const auto on =
          std::ranges::count_if(steps, [&](const CurbStep& s) { return is_on(s, steps[i].at, along); });
      if (on <= std::ssize(best)) continue;
      std::vector<CurbStep> of;
      for (const CurbStep& s : steps)
        if (is_on(s, steps[i].at, along)) of.push_back(s);
      of = longest_run(std::move(of), along, options.max_gap);
      if (of.size() > best.size()) best = std::move(of);
    }
  return best;
}

}  // namespace

std::vector<CloudCurb> find_curbs(const PointCloud& cloud, const CloudCurbOptions& options) {
  const std::vector<Profile> profiles = profiles_of(cloud, options.max_range);
  std::vector<CurbStep> steps;
  for (std::size_t k = 0; k < profiles.size(); ++k)
    find_steps(profiles[k], (static_cast<double>(k) + 0.5 - kSectors / 2) * 2 * std::numbers::pi / kSectors,
               options, steps);
  std::vector<CloudCurb> curbs;
  while (curbs.size() < kMaxCurbs) {
    std::vector<CurbStep> of = best_line(steps, options);
    if (static_cast<int>(of.size()) < options.min_columns) break;
    CurbLine line = fit_curb(of);
    // Again with all steps near the fitted line.
    of.clear();
    for (const CurbStep& s : steps)
      if (is_on(s, line.centre, line.along)) of.push_back(s);
    of = longest_run(std::move(of), line.along, options.max_gap);
    if (static_cast<int>(of.size()) < options.min_columns) break;
    line = fit_curb(of);
    CloudCurb curb;
    curb.centre = line.centre;
    curb.normal = {-line.along.y(), line.along.x()};
    if (curb.normal.dot(curb.centre) > 0) curb.normal = -curb.normal;
    for (const CurbStep& s : of) {
      const double t = curb.along().dot(s.at - curb.centre);
      curb.begin = std::min(curb.begin, t), curb.end = std::max(curb.end, t);
      curb.step += s.height / static_cast<double>(of.size());
    }
    curb.columns = static_cast<int>(of.size());
    // Neighbouring directions see the same rows: a quarter of them counts.
    const double count = std::max(1.0, static_cast<double>(of.size()) / 4);
    const double variance = std::max(line.across_variance, static_cast<double>(of.size()) / line.weight);
    curb.centre_variance = variance / count + kCurbSd * kCurbSd;
    curb.angle_variance = variance / (count * std::max(line.spread, 1e-6)) + kCurbAngleSd * kCurbAngleSd;
    if (curb.end - curb.begin >= options.min_length && -curb.normal.dot(curb.centre) > 0.5)
      curbs.push_back(curb);
    std::erase_if(steps, [&](const CurbStep& s) {
      return is_on(s, line.centre, line.along) &&
             std::abs(line.along.dot(s.at - line.centre)) < curb.end - curb.begin + 1;
    });
  }
  return curbs;
}

}  // namespace waymark::localization
