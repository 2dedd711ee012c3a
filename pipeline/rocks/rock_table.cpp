// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/rock_table.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "pipeline/rocks/synthetic_rock.hpp"
namespace waymark::pipeline {
namespace {

constexpr double kFirstRadius = 0.45, kRadiusStep = 1.36;  // pixels, factor
constexpr double kMinHeight = 0.12, kMaxHeight = 1.6;      // height / diameter, range of the table
constexpr double kMeanHeight = 0.45;    // height / diameter, median of rocks (Golombek 2008: about 0.5)
constexpr double kHeightSpread = 0.45;  // sd of its logarithm
constexpr double kCylinderFraction = 0.25;

// One drawn rock, measured. Smooth maps of weak shadows have no segment above the seed: then the whole
// picture is measured, which keeps the table continuous.
ShadowMeasure measure_rendered(const SyntheticRock& rock) {
  const double length = rock.reach + 2 * rock.radius;  // rock and shadow of a cylinder
  const double cos_turn = std::cos(rock.sun_angle.value), sin_turn = std::sin(rock.sun_angle.value);
  const auto size = [&](double length_fraction) {
    return static_cast<std::int64_t>(std::ceil(2 * rock.radius + length_fraction * rock.reach)) + 8;
  };
  const std::int64_t columns = size(std::abs(cos_turn)), rows = size(std::abs(sin_turn));
  SyntheticRock centred = rock;
  const double back = 0.5 * length - rock.radius;
  centred.x = 0.5 * static_cast<double>(columns - 1) + cos_turn * back + rock.x;
  centred.y = 0.5 * static_cast<double>(rows - 1) + sin_turn * back + rock.y;
  ShadowMap map;
  map.alpha = render_rock_shadow(centred, columns, rows);
  map.smooth = smooth_alpha(map.alpha);
  const auto segments = find_segments(map, {.grow = 0.02F, .seed = 0.02F});
  if (segments.empty()) return {-9, -1, -1, 0};
  const auto largest = std::max_element(segments.begin(), segments.end(), [](const auto& a, const auto& b) {
    return a.cells.size() < b.cells.size();
  });
  const LightFrame light = LightFrame::of(rock.sun_angle);
  const ShadowShape shape = measure_shadow(map, *largest, light);
  ShadowMeasure measure = shadow_measure(shape);
  measure.offset = light.along(shape.x - centred.x, shape.y - centred.y);
  return measure;
}

ShadowMeasure interpolate(const ShadowMeasure& a, const ShadowMeasure& b, double fraction) {
  return {a.log_area + fraction * (b.log_area - a.log_area),
          a.log_across + fraction * (b.log_across - a.log_across),
          a.log_along + fraction * (b.log_along - a.log_along), a.offset + fraction * (b.offset - a.offset)};
}

}  // namespace

ShadowMeasure shadow_measure(const ShadowShape& shape) {
  return {std::log(std::max(1e-3, shape.area)), 0.5 * std::log(std::max(0.02, shape.across_variance)),
          0.5 * std::log(std::max(0.02, shape.along_variance)), 0};
}

RockTable::RockTable(Radians elevation, bool known, double blur)
    : tan_elevation_(std::tan(elevation.value)), known_(known) {
  ratio_mean_ = std::log(2 * kMeanHeight / tan_elevation_);
  ratio_sd_ = known ? kHeightSpread : 0.8;
  first_ratio_ = std::log(2 * kMinHeight / tan_elevation_);
  ratio_step_ = std::log(kMaxHeight / kMinHeight) / (kHeights - 1);
  // Two directions of light and four places within a pixel stand for all.
  static constexpr double kTurn[] = {0.1, 0.35}, kX[] = {0.1, -0.35}, kY[] = {-0.2, 0.3};
  for (int i = 0; i < kRadii; ++i)
    for (int j = 0; j < kHeights; ++j) {
      const double radius = kFirstRadius * std::pow(kRadiusStep, i);
      SyntheticRock rock{.radius = radius,
                         .reach = radius * std::exp(first_ratio_ + ratio_step_ * j),
                         .elevation = elevation,
                         .blur = blur};
      ShadowMeasure mean;
      for (int k = 0; k < 2; ++k) {
        rock.sun_angle = {kTurn[k]};
        rock.x = kX[k];
        rock.y = kY[k];
        rock.upright = false;
        const ShadowMeasure round = measure_rendered(rock);
        rock.upright = true;
        mean = interpolate(mean, interpolate(round, measure_rendered(rock), kCylinderFraction),
                           k == 0 ? 1.0 : 0.5);
      }
      nodes_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = mean;
    }
}

ShadowMeasure RockTable::at(double log_radius, double log_ratio) const {
  const double last = kRadii - 1.0;
  double u = (log_radius - std::log(kFirstRadius)) / std::log(kRadiusStep);
  // Beyond the largest rendered rock all lengths scale in proportion.
  const double beyond = u > last ? (u - last) * std::log(kRadiusStep) : 0;
  u = std::clamp(u, 0.0, last - 1e-9);
  const double v = std::clamp((log_ratio - first_ratio_) / ratio_step_, 0.0, kHeights - 1 - 1e-9);
  const auto i = static_cast<std::size_t>(u), j = static_cast<std::size_t>(v);
  const double fu = u - static_cast<double>(i), fv = v - static_cast<double>(j);
  ShadowMeasure m = interpolate(interpolate(nodes_[i][j], nodes_[i + 1][j], fu),
                                interpolate(nodes_[i][j + 1], nodes_[i + 1][j + 1], fu), fv);
  m.log_area += 2 * beyond;
  m.log_across += beyond;
  m.log_along += beyond;
  m.offset *= std::exp(beyond);
  return m;
}

RockSize RockTable::estimate_size(const ShadowShape& shape, double noise, double texture) const {
  const ShadowMeasure seen = shadow_measure(shape);
  // Standard deviations of the three logarithms: pixel noise, texture (correlated, so it does not average
  // out), and a floor for model errors.
  const double cells = std::max(4.0, static_cast<double>(shape.cells) + 6);
  const double area_sd = (noise * std::sqrt(cells) + 0.15 * texture * cells) / std::max(0.3, shape.area);
  const Eigen::Vector3d sd{std::hypot(0.07, area_sd), std::hypot(0.05, 0.6 * area_sd),
                           std::hypot(0.06, 0.6 * area_sd)};
  const auto residual = [&](const ShadowMeasure& m) {
    return Eigen::Vector3d{(seen.log_area - m.log_area) / sd[0], (seen.log_across - m.log_across) / sd[1],
                           (seen.log_along - m.log_along) / sd[2]};
  };
  // Initial value: closed form of a half ellipsoid without blur.
  const double r0 = 2 * std::sqrt(std::max(0.05, shape.across_variance - 1.0 / 12 - 0.3));
  const double length = 2 * shape.area / (3.14159265358979 * r0);
  const double tip = 0.5 * (length + std::sqrt(length * length + 4 * r0 * r0));
  Eigen::Vector2d p{std::log(r0), std::clamp(std::log(std::sqrt(length * tip) / r0), first_ratio_,
                                             first_ratio_ + (kHeights - 1) * ratio_step_)};
  Eigen::Matrix2d normal = Eigen::Matrix2d::Identity();
  constexpr double kStep = 0.02;
  for (int iteration = 0; iteration < 12; ++iteration) {
    const Eigen::Vector3d here = residual(at(p[0], p[1]));
    Eigen::Matrix<double, 3, 2> slope;
    slope.col(0) = (residual(at(p[0] + kStep, p[1])) - residual(at(p[0] - kStep, p[1]))) / (2 * kStep);
    slope.col(1) = (residual(at(p[0], p[1] + kStep)) - residual(at(p[0], p[1] - kStep))) / (2 * kStep);
    normal = slope.transpose() * slope;
    normal(1, 1) += 1 / (ratio_sd_ * ratio_sd_);
    normal(0, 0) += 1e-3;
    Eigen::Vector2d gradient = slope.transpose() * here;
    gradient[1] += (p[1] - ratio_mean_) / (ratio_sd_ * ratio_sd_);
    Eigen::Vector2d change = -normal.inverse() * gradient;
    change = change.cwiseMax(-0.4).cwiseMin(0.4);
    p += change;
    p[0] = std::clamp(p[0], std::log(0.3), std::log(300.0));
    if (change.norm() < 1e-3) break;
  }
  const ShadowMeasure model = at(p[0], p[1]);
  const Eigen::Matrix2d covariance = normal.inverse();
  RockSize size;
  size.radius = std::exp(p[0]);
  size.reach = size.radius * std::exp(p[1]);
  size.radius_sd = size.radius * std::sqrt(covariance(0, 0));
  size.reach_sd =
      size.reach * std::sqrt(std::max(0.0, covariance(0, 0) + covariance(1, 1) + 2 * covariance(0, 1)));
  size.offset = model.offset;
  size.misfit = residual(model).norm();
  return size;
}

}  // namespace waymark::pipeline
