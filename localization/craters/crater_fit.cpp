// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <limits>
#include <numbers>

#include "core/units.hpp"
#include "localization/craters/crater_search.hpp"

namespace waymark::localization {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kMaxChance = 0.2;   // craters in a gate by chance, while a position is uncertain
constexpr double kBandwidth = 0.25;  // of ln of radii of arbitrary detections
constexpr double kSizeMargin = 1.3;  // of the radii that an image may show
constexpr double kMinMargin = 0.9;
constexpr int kRounds = 12;
constexpr double kScales = 4.6;  // range of ln of an unknown scale: a factor of 100

double log_normal_density(double squares, double log_volume) {
  return -squares / 2 - log_volume;
}

}  // namespace

CraterFitter::CraterFitter(const CraterIndex& index, const CraterImage& image,
                           const CraterSearchOptions& options, std::span<const std::uint32_t> used)
    : index_(index), image_(image), o_(options), used_(used), half_(image.size / 2) {
  if (!(half_.minCoeff() > 0)) {
    half_ = Eigen::Vector2d::Constant(1);
    for (const std::uint32_t i : used_) half_ = half_.cwiseMax(image.craters[i].at.cwiseAbs());
  }
  min_radius_ = max_radius_ = image.craters[used_[0]].radius;
  for (const std::uint32_t i : used_) {
    min_radius_ = std::min(min_radius_, image.craters[i].radius);
    max_radius_ = std::max(max_radius_, image.craters[i].radius);
  }
  for (const std::uint32_t i : used_) {
    double sum = 0;
    for (const std::uint32_t j : used_) {
      const double z = std::log(image.craters[i].radius / image.craters[j].radius) / kBandwidth;
      sum += std::exp(-z * z / 2);
    }
    clutter_.push_back(sum / (std::sqrt(2 * kPi) * kBandwidth * static_cast<double>(used_.size())) /
                       (4 * half_.prod()));
  }
}

std::optional<ImagePoint> CraterFitter::project(const ImagePose& pose, std::uint32_t crater) const {
  const Eigen::Vector3d& at = index_.craters_[crater].at;
  return image_.camera.project(pose, at, index_.surface_.up(at));
}

CraterFitter::Jacobian CraterFitter::jacobian(const ImagePose& pose, std::uint32_t crater) const {
  const double scale = std::exp(pose.log_scale);
  ImagePose::Step step;
  step << scale, scale, 1e-4, 1e-4, 1e-4, 1e-4;
  Jacobian j = Jacobian::Zero();
  for (int k = 0; k < free_parameters(); ++k) {
    ImagePose::Step one = ImagePose::Step::Zero();
    one[k] = step[k];
    const auto more = project(pose.moved(one, index_.surface_), crater),
               less = project(pose.moved(-one, index_.surface_), crater);
    if (more && less) j.col(k) = (more->at - less->at) / (2 * step[k]);
  }
  return j;
}

double CraterFitter::variance(std::uint32_t seen, std::uint32_t mapped, double pixels_per_metre) const {
  const double fraction = o_.position_error * image_.craters[seen].radius,
               map = index_.craters_[mapped].sd * pixels_per_metre;
  return o_.position_sd * o_.position_sd + fraction * fraction + map * map;
}

bool CraterFitter::adjust(CraterFix& fix, const Matches& matches) const {
  constexpr int n = ImagePose::kParameters;
  const int free = free_parameters();
  const double tilt_sd = o_.tilt_sd * kRadiansPerDegree;
  for (int round = 0; round < 3; ++round) {
    ImagePose::Covariance information = ImagePose::Covariance::Zero();
    ImagePose::Step right = ImagePose::Step::Zero();
    for (int k = 4; k < n; ++k) {
      information(k, k) = free == n ? 1 / (tilt_sd * tilt_sd) : 1;
      right[k] = -information(k, k) * fix.pose.tilt[k - 4];
    }
    double squares = 0, residual = 0;
    int count = 0;
    for (std::size_t i = 0; i < matches.size(); ++i) {
      if (!matches[i]) continue;
      const auto at = project(fix.pose, *matches[i]);
      if (!at) continue;
      const Jacobian j = jacobian(fix.pose, *matches[i]);
      const double v = variance(used_[i], *matches[i], at->pixels_per_metre);
      const Eigen::Vector2d miss = image_.craters[used_[i]].at - at->at;
      information += j.transpose() * j / v;
      right += j.transpose() * miss / v;
      squares += miss.squaredNorm() / v, residual += miss.squaredNorm();
      ++count;
    }
    if (count < 3) return false;
    const Eigen::LDLT<ImagePose::Covariance> solver(information);
    if (solver.info() != Eigen::Success || !solver.isPositive()) return false;
    const ImagePose::Step change = solver.solve(right);
    if (!change.allFinite() || !(std::abs(change[2]) < 0.5) || !(change.tail<2>().norm() < 0.5)) return false;
    fix.pose = fix.pose.moved(change, index_.surface_);
    const double freedom = 2.0 * count - free + (free == n ? 2 : 0);
    fix.covariance = solver.solve(ImagePose::Covariance::Identity()) * std::max(1.0, squares / freedom);
    fix.residual = std::sqrt(residual / count);
  }
  return fix.covariance.allFinite();
}

CraterFitter::Matches CraterFitter::match(const CraterFix& fix) const {
  struct Pair {
    double squares;
    std::size_t seen;
    std::uint32_t mapped;
  };
  std::vector<Pair> pairs;
  const double gate = o_.sigmas * o_.sigmas, scale = std::exp(fix.pose.log_scale);
  for (std::size_t i = 0; i < used_.size(); ++i) {
    const ImageCrater& seen = image_.craters[used_[i]];
    const auto at = image_.camera.ground(fix.pose, seen.at, index_.surface_);
    if (!at) continue;
    // The error of the position is that of a point at this position.
    Jacobian j = Jacobian::Zero();
    ImagePose::Step step;
    step << scale, scale, 1e-4, 1e-4, 1e-4, 1e-4;
    const Eigen::Vector3d up = index_.surface_.up(*at);
    const auto here = image_.camera.project(fix.pose, *at, up);
    if (!here) continue;
    for (int k = 0; k < free_parameters(); ++k) {
      ImagePose::Step one = ImagePose::Step::Zero();
      one[k] = step[k];
      if (const auto moved = image_.camera.project(fix.pose.moved(one, index_.surface_), *at, up))
        j.col(k) = (moved->at - here->at) / step[k];
    }
    const Eigen::Matrix2d position = j * fix.covariance * j.transpose();
    const double radius = seen.radius / here->pixels_per_metre;
    const double own = variance(used_[i], 0, 0);
    const Eigen::Matrix2d spread = position + own * Eigen::Matrix2d::Identity();
    const double area =
        kPi * gate * std::sqrt(spread.determinant()) / (here->pixels_per_metre * here->pixels_per_metre);
    if (index_.density(std::log(radius)) * area * 2 * o_.sigmas * o_.radius_error > kMaxChance &&
        position.trace() > 2 * own)
      continue;
    const double reach = o_.sigmas * std::sqrt(spread.trace()) / here->pixels_per_metre * 1.5;
    index_.near(*at, reach, radius * std::exp(-o_.sigmas * o_.radius_error), [&](std::uint32_t k, double) {
      const double size = std::log(index_.craters_[k].radius / radius) / o_.radius_error;
      if (size * size > gate) return;
      const auto seen_at = project(fix.pose, k);
      if (!seen_at) return;
      const Eigen::Vector2d miss = seen.at - seen_at->at;
      const Eigen::Matrix2d s =
          position + variance(used_[i], k, seen_at->pixels_per_metre) * Eigen::Matrix2d::Identity();
      const double squares = miss.dot(s.inverse() * miss);
      if (squares <= gate) pairs.push_back({squares + size * size, i, k});
    });
  }
  std::ranges::sort(pairs, [](const Pair& a, const Pair& b) {
    return std::tie(a.squares, a.seen, a.mapped) < std::tie(b.squares, b.seen, b.mapped);
  });
  Matches matches(used_.size());
  std::vector<std::uint32_t> taken;
  for (const Pair& p : pairs) {
    if (matches[p.seen] || std::ranges::find(taken, p.mapped) != taken.end()) continue;
    matches[p.seen] = p.mapped;
    taken.push_back(p.mapped);
  }
  return matches;
}

double CraterFitter::craters_in_view(const ImagePose& pose) const {
  const double scale = std::exp(pose.log_scale), smallest = kMinMargin * min_radius_ * scale;
  const double reach = 1.2 * half_.norm() * scale;
  double count = 0;
  index_.near(pose.ground, reach, 0.8 * smallest, [&](std::uint32_t k, double) {
    const auto at = project(pose, k);
    if (!at) return;
    const double radius = index_.craters_[k].radius * at->pixels_per_metre;
    count += (at->at.cwiseAbs().array() <= half_.array()).all() && radius >= kMinMargin * min_radius_ &&
             radius <= kSizeMargin * max_radius_;
  });
  return std::max(count, 1.0);
}

void CraterFitter::evaluate(CraterFix& fix, const Matches& matches) const {
  fix.craters.assign(image_.craters.size(), std::nullopt);
  fix.matched = 0, fix.log_false_alarms = 0;
  const double in_view = craters_in_view(fix.pose);
  for (std::size_t i = 0; i < matches.size(); ++i) {
    double ratio = 1 - o_.mapped;
    if (matches[i]) {
      fix.craters[used_[i]] = matches[i];
      ++fix.matched;
      const ImageCrater& seen = image_.craters[used_[i]];
      if (const auto at = project(fix.pose, *matches[i])) {
        const double v = variance(used_[i], *matches[i], at->pixels_per_metre);
        const double size =
            std::log(index_.craters_[*matches[i]].radius * at->pixels_per_metre / seen.radius) /
            o_.radius_error;
        const double squares = (seen.at - at->at).squaredNorm() / v + size * size;
        const double volume = 1.5 * std::log(2 * kPi) + std::log(v * o_.radius_error);
        ratio += o_.mapped * std::exp(log_normal_density(squares, volume)) / (in_view * clutter_[i]);
      }
    }
    fix.log_false_alarms -= std::log(ratio);
  }
  // Positions that can be distinguished: the volume of all over that of one (Laplace's approximation).
  const int free = free_parameters();
  const bool bounded = o_.min_scale > 0 && o_.max_scale > o_.min_scale;
  double positions = std::log(index_.surface_.area() * 2 * kPi) +
                     std::log(bounded ? std::log(o_.max_scale / o_.min_scale) : kScales);
  if (free > 4) positions += 2 * std::log(std::sqrt(2 * kPi) * o_.tilt_sd * kRadiansPerDegree);
  const double one = std::sqrt(std::max(fix.covariance.topLeftCorner(free, free).determinant(), 1e-300));
  fix.log_false_alarms += std::max(0.0, positions - free / 2.0 * std::log(2 * kPi) - std::log(one));
}

std::optional<CraterFix> CraterFitter::fit(ImagePose pose, std::span<const std::uint32_t> seen,
                                           std::span<const std::uint32_t> mapped) const {
  CraterFix fix{.pose = pose, .covariance = ImagePose::Covariance::Identity(), .craters = {}};
  Matches matches(used_.size()), last;
  for (std::size_t i = 0; i < used_.size(); ++i)
    for (std::size_t k = 0; k < seen.size(); ++k)
      if (used_[i] == seen[k]) matches[i] = mapped[k];
  for (int round = 0; round < kRounds && matches != last; ++round) {
    if (!adjust(fix, matches)) return {};
    last = std::move(matches);
    matches = match(fix);
  }
  if (!adjust(fix, matches)) return {};
  evaluate(fix, matches);
  return fix;
}

}  // namespace waymark::localization
