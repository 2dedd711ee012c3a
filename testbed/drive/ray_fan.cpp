// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/ray_fan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace waymark::testbed {
namespace {

constexpr int kSectors = 720;
constexpr double kPerRadian = kSectors / (2 * std::numbers::pi);

int sector(double azimuth) {
  const int s = static_cast<int>((azimuth + std::numbers::pi) * kPerRadian);
  return std::clamp(s, 0, kSectors - 1);
}

std::optional<double> intersect_stem(const StemSolid& stem, const Eigen::Vector3d& origin,
                                     const Eigen::Vector3d& along) {
  const Eigen::Vector2d d = along.head<2>();
  const double a = d.squaredNorm();
  if (!(a > 0)) return {};
  // Circle of the stem at the height where the ray passes: the error is the taper and lean over the rise of
  // the ray within one stem width, below a millimetre for flat rays.
  double t = (stem.foot.head<2>() - origin.head<2>()).dot(d) / a;
  for (int i = 0; i < 2; ++i) {
    const double above = origin.z() + t * along.z() - stem.foot.z();
    const double radius = stem.radius(above);
    if (!(radius > 0)) return {};
    const Eigen::Vector2d o = origin.head<2>() - stem.foot.head<2>() - above * stem.lean;
    const double b = o.dot(d), root = b * b - a * (o.squaredNorm() - radius * radius);
    if (!(root >= 0)) return {};
    t = (-b - std::sqrt(root)) / a;
  }
  return t > 0 ? std::optional(t) : std::nullopt;
}

std::optional<double> intersect_thicket(const Thicket& thicket, const Eigen::Vector3d& origin,
                                        const Eigen::Vector3d& along, Random& random) {
  const Eigen::Vector3d to = thicket.centre - origin;
  const double middle = to.dot(along);
  const double square = thicket.radius * thicket.radius - (to - middle * along).squaredNorm();
  if (!(square > 0)) return {};
  const double enter = std::max(0.0, middle - std::sqrt(square)), leave = middle + std::sqrt(square);
  if (!(leave > enter)) return {};
  const double t = enter - std::log(1 - random.uniform()) / thicket.density;
  return t < leave ? std::optional(t) : std::nullopt;
}

}  // namespace

RayFan::RayFan(const LaserTargets& targets, const Eigen::Vector3d& origin, double reach, double t)
    : targets_(targets), origin_(origin), reach_(reach) {
  struct Span {
    Candidate candidate;
    int from, to;
  };
  std::vector<Span> spans;
  for (const auto& target : targets.near(origin.head<2>(), reach)) {
    if (target.kind == TargetKind::stem && t >= targets.stems()[target.index].felled_at) continue;
    if (target.kind == TargetKind::thicket && t >= targets.thickets()[target.index].felled_at) continue;
    const double dx = double(target.x) - origin.x(), dy = double(target.y) - origin.y();
    const double distance = std::hypot(dx, dy), wide = double(target.reach) + 1e-3;
    Span span{{std::max(0.0, distance - wide), target.kind, target.index}, 0, kSectors - 1};
    if (distance > wide) {
      const double middle = std::atan2(dy, dx), half = std::asin(wide / distance) + 1e-6;
      span.from = static_cast<int>(std::floor((middle - half + std::numbers::pi) * kPerRadian));
      span.to = static_cast<int>(std::floor((middle + half + std::numbers::pi) * kPerRadian));
    }
    spans.push_back(span);
  }
  std::ranges::sort(spans, [](const Span& a, const Span& b) {
    return std::tie(a.candidate.near, a.candidate.kind, a.candidate.index) <
           std::tie(b.candidate.near, b.candidate.kind, b.candidate.index);
  });
  first_.assign(kSectors + 1, 0);
  const auto wrap = [](int s) { return static_cast<std::size_t>((s % kSectors + kSectors) % kSectors); };
  for (const Span& s : spans)
    for (int k = s.from; k <= s.to; ++k) ++first_[wrap(k) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  listed_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const Span& s : spans) {
    for (int k = s.from; k <= s.to; ++k)
      listed_[next[wrap(k)]++] = static_cast<std::uint32_t>(candidates_.size());
    candidates_.push_back(s.candidate);
  }
}

std::optional<double> RayFan::intersect_target(const Candidate& c, const Eigen::Vector3d& along,
                                               Random* random) const {
  if (c.kind == TargetKind::rock) {
    const auto hit = intersect(targets_.rocks()[c.index], origin_, along);
    return hit ? std::optional(hit->t) : std::nullopt;
  }
  if (c.kind == TargetKind::stem) return intersect_stem(targets_.stems()[c.index], origin_, along);
  return random ? intersect_thicket(targets_.thickets()[c.index], origin_, along, *random) : std::nullopt;
}

std::optional<FanHit> RayFan::first(std::span<const std::uint32_t> order, const Eigen::Vector3d& along,
                                    Random* random, bool sorted) const {
  FanHit best{reach_, TargetKind::ground, 0};
  bool any = false;
  const double level = along.head<2>().norm();
  for (const std::uint32_t i : order) {
    const Candidate& c = candidates_[i];
    if (c.near > best.range * level) {
      if (sorted) break;
      continue;
    }
    const auto t = intersect_target(c, along, random);
    if (t && *t < best.range) best = {*t, c.kind, c.index}, any = true;
  }
  const RayHit ground = targets_.terrain().cast({{origin_}, {along}}, best.range);
  if (ground.end == RayEnd::ground && ground.range < best.range)
    return FanHit{ground.range, TargetKind::ground, 0};
  return any ? std::optional(best) : std::nullopt;
}

std::optional<FanHit> RayFan::cast(const Eigen::Vector3d& along, Random* random) const {
  const auto s = static_cast<std::size_t>(sector(std::atan2(along.y(), along.x())));
  const std::span<const std::uint32_t> order(listed_.data() + first_[s], first_[s + 1] - first_[s]);
  return first(order, along, random, true);
}

std::optional<FanHit> RayFan::cast_exhaustively(const Eigen::Vector3d& along, Random* random) const {
  std::vector<std::uint32_t> all(candidates_.size());
  std::iota(all.begin(), all.end(), std::uint32_t{0});
  return first(all, along, random, false);
}

}  // namespace waymark::testbed
