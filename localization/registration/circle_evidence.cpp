// SPDX-License-Identifier: Apache-2.0
#include "localization/registration/circle_evidence.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace waymark::localization {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kReach = 4;           // standard deviations that are compared
constexpr double kFractions = 9;       // of true circles: 0.1 to 0.9
constexpr double kTrueFraction = 0.7;  // assumed while a place is adjusted

std::vector<Eigen::Vector3d> in_space(const std::vector<Circle>& circles) {
  std::vector<Eigen::Vector3d> out;
  for (const Circle& c : circles) out.emplace_back(c.at.x(), c.at.y(), 0);
  return out;
}

double normal_density(double x, double variance) {
  return std::exp(-x * x / (2 * variance)) / std::sqrt(2 * kPi * variance);
}

Eigen::Vector2d across(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

}  // namespace

Eigen::Matrix2d PlaneSimilarity::linear() const {
  const double c = std::exp(log_scale) * std::cos(yaw), s = std::exp(log_scale) * std::sin(yaw);
  Eigen::Matrix2d out;
  out << c, -s, s, c;
  return out;
}

CircleEvidence::CircleEvidence(std::span<const Circle> map, std::span<const Circle> catalogue)
    : map_(map.begin(), map.end()), catalogue_(catalogue.begin(), catalogue.end()) {
  std::ranges::stable_sort(map_, std::ranges::greater{}, &Circle::diameter);
  cells_ = PointCells(in_space(catalogue_));
  low_ = high_ = map_.front().at;
  double mean = 0, squares = 0;
  const double count = double(map_.size());
  for (const Circle& c : map_) {
    low_ = low_.cwiseMin(c.at);
    high_ = high_.cwiseMax(c.at);
    mean += std::log(c.diameter) / count;
    squares += std::log(c.diameter) * std::log(c.diameter) / count;
  }
  const Eigen::Vector2d size = high_ - low_;
  middle_ = (low_ + high_) / 2;
  extent_ = size.norm();
  // The box of n points of uniform position is smaller than their area by (n - 1) / (n + 1) on each side.
  const double margin = std::pow((count + 1) / std::max(1.0, count - 1), 2);
  map_area_ = margin * std::max(size.prod(), 0.1 * size.maxCoeff() * size.maxCoeff());
  bandwidth_ = std::max(0.2, 1.06 * std::sqrt(std::max(0.0, squares - mean * mean)) * std::pow(count, -0.2));
  for (const Circle& circle : map_) {
    double sum = 0;
    for (const Circle& c : map_)
      sum += normal_density(std::log(c.diameter / circle.diameter), bandwidth_ * bandwidth_);
    clutter_.push_back(sum / count / map_area_);
  }
  Eigen::Vector2d min_corner = catalogue_.front().at, max_corner = min_corner;
  for (const Circle& c : catalogue_) {
    min_corner = min_corner.cwiseMin(c.at);
    max_corner = max_corner.cwiseMax(c.at);
    largest_sd_ = std::max(largest_sd_, c.position_sd / c.diameter);
  }
  catalogue_area_ = std::max((max_corner - min_corner).prod(), 1e-9);
}

std::vector<CircleEvidence::Near> CircleEvidence::near(const Circle& circle, const PlaneSimilarity& place,
                                                       double extra_variance) const {
  const double scale = std::exp(place.log_scale), own = scale * circle.position_sd;
  const double possible = 2 * largest_sd_ * scale * circle.diameter;  // of a catalogue circle twice as large
  const double reach = kReach * std::sqrt(own * own + possible * possible + extra_variance);
  const Eigen::Vector2d at = place * circle.at;
  std::vector<Near> out;
  cells_.near({at.x(), at.y(), 0}, reach, [&](std::uint32_t k, double square) {
    const Circle& other = catalogue_[k];
    const double variance = own * own + other.position_sd * other.position_sd + extra_variance;
    const double size = std::log(other.diameter / circle.diameter) - place.log_scale;
    const double spread =
        circle.log_diameter_sd * circle.log_diameter_sd + other.log_diameter_sd * other.log_diameter_sd;
    if (size * size > kReach * kReach * spread || square > kReach * kReach * variance) return;
    out.push_back({k,
                   std::exp(-square / (2 * variance)) / (2 * kPi * variance) * normal_density(size, spread),
                   variance});
  });
  std::ranges::sort(out, {}, &Near::index);
  return out;
}

double CircleEvidence::clutter_density(std::size_t index, double scale) const {
  return clutter_[index] / (scale * scale);
}

double CircleEvidence::in_view(const PlaneSimilarity& place) const {
  const double scale = std::exp(place.log_scale);
  const Eigen::Vector2d middle = place * middle_, half = (high_ - low_) / 2 + Eigen::Vector2d::Constant(1e-9);
  const Eigen::Matrix2d inverse = place.linear().inverse();
  const double smallest = map_.back().diameter * scale / 1.3, largest = map_.front().diameter * scale * 1.3;
  double count = 0;
  cells_.near({middle.x(), middle.y(), 0}, scale * extent_ / 2, [&](std::uint32_t k, double) {
    const Circle& c = catalogue_[k];
    const Eigen::Vector2d at = (inverse * (c.at - middle)).cwiseAbs();
    if (at.x() <= half.x() && at.y() <= half.y() && c.diameter >= smallest && c.diameter <= largest) ++count;
  });
  return std::max(1.0, count);
}

double CircleEvidence::log_ratio(const PlaneSimilarity& place) const {
  const double seen = in_view(place), scale = std::exp(place.log_scale);
  std::vector<double> ratios;
  for (const Circle& circle : map_) {
    double sum = 0;
    for (const Near& n : near(circle, place, 0)) sum += n.density;
    ratios.push_back(sum / seen / clutter_density(ratios.size(), scale));
  }
  double largest = -1e300;
  std::vector<double> logs;
  for (double k = 1; k <= kFractions; ++k) {
    const double p = k / (kFractions + 1);
    double log = 0;
    for (const double r : ratios) log += std::log(1 - p + p * r);
    logs.push_back(log);
    largest = std::max(largest, log);
  }
  double sum = 0;
  for (const double log : logs) sum += std::exp(log - largest);
  return largest + std::log(sum / kFractions);
}

double CircleEvidence::quick_score(const PlaneSimilarity& place, const Eigen::Vector2d& between, double base,
                                   std::size_t count) const {
  const double scale = std::exp(place.log_scale);
  const double seen = std::max(
      1.0, double(catalogue_.size()) * scale * scale * map_area_ / std::max(catalogue_area_, map_area_));
  double score = 0;
  for (std::size_t i = 0; i < std::min(count, map_.size()); ++i) {
    const double lever = (place * map_[i].at - between).norm() / base;
    const double sd = lever * 2 * scale * map_[i].position_sd;
    double sum = 0;
    for (const Near& n : near(map_[i], place, sd * sd)) sum += n.density;
    score += std::log(1 - kTrueFraction + kTrueFraction * sum / seen / clutter_density(i, scale));
  }
  return score;
}

std::optional<CircleFit> CircleEvidence::fit(PlaneSimilarity place) const {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  CircleFit out;
  double squares = 0;
  // The variances shrink to their values, so that a rough place draws its matches first.
  for (const double widening : {8.0, 4.0, 2.0, 1.0, 0.0, 0.0, 0.0, 0.0}) {
    const double scale = std::exp(place.log_scale), seen = in_view(place);
    normal.setZero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    out.pivot = place * middle_;
    out.matches.assign(map_.size(), std::nullopt);
    out.matched = 0;
    squares = out.residual = 0;
    std::vector<double> best(catalogue_.size(), 0);
    for (std::size_t i = 0; i < map_.size(); ++i) {
      const double wide = widening * std::pow(scale * map_[i].position_sd, 2);
      const auto candidates = near(map_[i], place, wide);
      double sum = (1 - kTrueFraction) * seen * clutter_density(i, scale) / kTrueFraction;
      for (const Near& n : candidates) sum += n.density;
      const Eigen::Vector2d at = place * map_[i].at, arm = at - out.pivot;
      Eigen::Matrix<double, 2, 4> rows;
      rows << Eigen::Matrix2d::Identity(), across(arm), arm;
      for (const Near& n : candidates) {
        const double weight = n.density / sum;
        const Eigen::Vector2d miss = catalogue_[n.index].at - at;
        normal += weight / n.variance * rows.transpose() * rows;
        right += weight / n.variance * rows.transpose() * miss;
        if (!(weight > 0.5) || best[n.index] > 0) continue;
        best[n.index] = weight;
        out.matches[i] = n.index;
        ++out.matched;
        squares += miss.squaredNorm() / n.variance;
        out.residual += miss.squaredNorm();
      }
    }
    if (out.matched < 3) return std::nullopt;
    const Eigen::Vector4d step = normal.ldlt().solve(right);
    if (!step.allFinite() || !(std::abs(step[3]) < 0.5)) return std::nullopt;
    PlaneSimilarity next{.log_scale = place.log_scale + step[3], .yaw = place.yaw + step[2]};
    next.shift = out.pivot + step.head<2>() - next.linear() * middle_;
    place = next;
  }
  place.yaw = std::remainder(place.yaw, 2 * kPi);
  out.catalogue_from_map = place;
  out.residual = std::sqrt(out.residual / double(out.matched));
  const double freedom = 2 * double(out.matched) - 4;
  out.covariance = normal.inverse() * std::max(1.0, squares / freedom);
  return out;
}

}  // namespace waymark::localization
