// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/upright_shape.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "core/median.hpp"

namespace waymark::localization {
namespace {

constexpr double kShapeLayer = 0.25;  // m
constexpr double kRangeSd = 0.03;     // m of a range, and of what the beam's width adds
constexpr double kUsualRadius = 0.1, kUsualRadiusSd = 0.08;  // m, of poles in towns
constexpr double kLean = 0.02;                               // m: poles lean and carry things
constexpr double kRough = 0.04;                              // m about a circle: poles carry things
constexpr double kMinStem = 0.15;                            // m, radius: noise falsifies smaller arcs
constexpr std::size_t kMany = 40;    // points: that fewer are so precise may be chance
constexpr double kPrecise = 0.01;    // m about such an arc
constexpr double kStemSd = 0.05;     // m of that radius
constexpr double kMinPlate = 0.15;   // m, half of its width
constexpr double kSurelyFlat = 4.6;  // logarithm of the ratio of likelihoods, 100
constexpr double kWider = 1.5;       // of the narrow layers: what is wider shows something else

struct Circle {
  Eigen::Vector2d centre;
  double radius = 0, radius_variance = 0;
};

using Points = std::vector<Eigen::Vector2d>;

Eigen::Vector2d mean(const Points& points) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) sum += p;
  return sum / static_cast<double>(points.size());
}

// Returns the mean squared distance from a circle.
double mean_square(const Points& points, const Circle& circle) {
  double squares = 0;
  for (const Eigen::Vector2d& p : points) {
    const double error = (p - circle.centre).norm() - circle.radius;
    squares += error * error;
  }
  return squares / static_cast<double>(points.size());
}

// Returns the mean squared distance from the straight line that fits best.
double mean_square_of_line(const Points& points) {
  const Eigen::Vector2d middle = mean(points);
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : points) scatter += (p - middle) * (p - middle).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(scatter, Eigen::EigenvaluesOnly);
  return axes.eigenvalues()[0] / static_cast<double>(points.size());
}

// Returns a circle by linear least squares (Kasa 1976); one of usual size behind the points if that lies
// before them.
Circle first_circle(const Points& points) {
  const Eigen::Vector2d middle = mean(points);
  Eigen::Matrix2d squares = 1e-12 * Eigen::Matrix2d::Identity();
  Eigen::Vector2d cubes = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d off = p - middle;
    squares += off * off.transpose(), cubes += off.squaredNorm() * off;
  }
  const Eigen::Vector2d off = squares.inverse() * cubes / 2;
  const double radius = std::sqrt(off.squaredNorm() + squares.trace() / static_cast<double>(points.size()));
  if (off.dot(middle.normalized()) > -kRangeSd && radius < 1) return {middle + off, radius};
  return {middle + kUsualRadius * middle.normalized(), kUsualRadius};
}

// Fits a circle to the arc alone (Gauss-Newton).
Circle fit_arc(const Points& points) {
  Circle circle = first_circle(points);
  Eigen::Matrix3d information;
  for (int step = 0; step < 8; ++step) {
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    information = 1e-3 * Eigen::Matrix3d::Identity();
    const double variance = kRangeSd * kRangeSd + mean_square(points, circle);
    for (const Eigen::Vector2d& p : points) {
      const Eigen::Vector2d from = p - circle.centre;
      const double distance = std::max(1e-6, from.norm());
      const Eigen::Vector3d row(from.x() / distance, from.y() / distance, 1);
      information += row * row.transpose() / variance;
      gradient += row * (distance - circle.radius) / variance;
    }
    const Eigen::Vector3d correction = information.inverse() * gradient;
    circle.centre += correction.head<2>();
    circle.radius = std::clamp(circle.radius + correction[2], 0.01, 1.0);
  }
  circle.radius_variance = information.inverse()(2, 2);
  return circle;
}

// Returns whether points lie on all sides of a circle, as in clouds of several scans.
bool surround(const Points& points, const Circle& circle) {
  const Eigen::Vector2d middle = mean(points), along = middle.normalized();
  double squares = 0;
  for (const Eigen::Vector2d& p : points) squares += std::pow(along.dot(p - middle), 2);
  const double depth_sd = std::sqrt(squares / static_cast<double>(points.size()));
  return depth_sd > 1.5 * kRangeSd && depth_sd > 0.6 * circle.radius &&
         mean_square(points, circle) < kRangeSd * kRangeSd;
}

// Returns whether an arc gives the circle: that of a stem, one whose ranges are precise, or a whole circle.
bool is_circle(const Circle& arc, const Points& points, double max_diameter) {
  if (!arc.centre.allFinite() || 2 * arc.radius > max_diameter) return false;
  if (surround(points, arc)) return true;
  const double squares = mean_square(points, arc);
  const double max_rms = arc.radius > kMinStem ? 2 * kRangeSd : points.size() >= kMany ? kPrecise : 0;
  return arc.radius_variance < kStemSd * kStemSd && squares < max_rms * max_rms &&
         squares < mean_square_of_line(points);
}

// Returns whether points lie on a plane rather than on a circle.
bool is_plate(const Circle& circle, const Points& points) {
  const double of_line = mean_square_of_line(points), of_circle = mean_square(points, circle);
  const double noise = kRangeSd * kRangeSd, count = static_cast<double>(points.size());
  const double log_ratio = count * (of_circle - of_line) / (2 * noise);
  return circle.radius > kMinPlate && of_line < noise && log_ratio > kSurelyFlat;
}

// What a pole hides: the points of its narrow layers, and the angle that they fill.
struct Silhouette {
  Points points;
  double width = 0;  // rad
};

// A sign on a post is wider than the post: the narrowest quarter of the layers says what belongs to it.
Silhouette narrow_layers(std::span<const RaisedPoint> points, const Eigen::Vector2d& along, double step) {
  struct Layer {
    double count = 0, sum = 0, squares = 0, width = 0;
  };
  const Eigen::Vector2d across(-along.y(), along.x());
  const float lowest = std::ranges::min(points, {}, &RaisedPoint::height).height;
  std::vector<Layer> layers;
  const auto layer_of = [&](const RaisedPoint& p) {
    return static_cast<std::size_t>(static_cast<double>(p.height - lowest) / kShapeLayer);
  };
  for (const RaisedPoint& p : points) {
    const std::size_t l = layer_of(p);
    if (l >= layers.size()) layers.resize(l + 1);
    const double angle = across.dot(p.at.cast<double>()) / along.dot(p.at.cast<double>());
    layers[l].count += 1, layers[l].sum += angle, layers[l].squares += angle * angle;
  }
  std::vector<double> widths;
  for (Layer& l : layers) {
    if (l.count == 0) continue;
    // n columns fill n steps; the variance of their angles is that of n values.
    const double mean = l.sum / l.count;
    l.width = std::sqrt(12 * std::max(0.0, l.squares / l.count - mean * mean) + step * step);
    widths.push_back(l.width);
  }
  const auto quarter = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 4);
  std::ranges::nth_element(widths, quarter);
  const double widest = std::max(kWider * *quarter, *quarter + kWider * step);
  std::erase_if(widths, [&](double width) { return width > widest; });
  Silhouette found{
      .points = {},
      .width = std::accumulate(widths.begin(), widths.end(), 0.0) / static_cast<double>(widths.size())};
  for (const RaisedPoint& p : points)
    if (layers[layer_of(p)].width <= widest) found.points.push_back(p.at.cast<double>());
  return found;
}

// Returns the circle between the tangents at both sides of a silhouette.
Circle circle_within(const Silhouette& pole, double step) {
  const Eigen::Vector2d middle = mean(pole.points), along = middle.normalized();
  const double depth = middle.norm(), quantum = depth * step;
  // radius = (depth + pi / 4 * radius) * sin(width / 2): the mean depth of an arc
  constexpr double kMeanDepth = std::numbers::pi / 4;  // radii before the axis
  const double sine = std::sin(std::min(pole.width / 2, 1.0)), seen = depth * sine / (1 - kMeanDepth * sine);
  constexpr double kExact = 1e-8;  // m2: no width is known better
  const double seen_variance = quantum * quantum / 24 + kExact,
               usual_variance = kUsualRadiusSd * kUsualRadiusSd;
  Circle circle;
  circle.radius_variance = seen_variance * usual_variance / (usual_variance + seen_variance);
  circle.radius = circle.radius_variance * (seen / seen_variance + kUsualRadius / usual_variance);
  std::vector<double> depths;
  for (const Eigen::Vector2d& p : pole.points) {
    const double off = along.x() * p.y() - along.y() * p.x();
    depths.push_back(along.dot(p) + std::sqrt(std::max(0.0, circle.radius * circle.radius - off * off)));
  }
  circle.centre = median(std::move(depths)) * along;
  return circle;
}

}  // namespace

std::optional<UprightShape> fit_upright(std::span<const RaisedPoint> points, double step,
                                        double max_diameter) {
  if (points.empty()) return {};
  Silhouette pole;
  for (const RaisedPoint& p : points) pole.points.push_back(p.at.cast<double>());
  Circle circle = fit_arc(pole.points);
  if (!is_circle(circle, pole.points, max_diameter)) {
    pole = narrow_layers(points, mean(pole.points).normalized(), step);
    circle = circle_within(pole, step);
    if (is_plate(circle, pole.points)) return {};
  }
  const double squares = mean_square(pole.points, circle),
               max_rms = kRough + 0.3 * std::max(circle.radius, kUsualRadius);
  if (!(squares < max_rms * max_rms) || 2 * circle.radius > max_diameter) return {};
  const Eigen::Vector2d sight = circle.centre.normalized(), side(-sight.y(), sight.x());
  const double quantum = circle.centre.norm() * step, own = kLean * kLean + squares / 4;
  const double range_variance = kRangeSd * kRangeSd / static_cast<double>(pole.points.size());
  return UprightShape{
      .axis = circle.centre,
      .covariance = (own + range_variance + circle.radius_variance) * sight * sight.transpose() +
                    (own + quantum * quantum / 24) * side * side.transpose(),
      .diameter = 2 * circle.radius,
      .diameter_sd = std::sqrt(4 * circle.radius_variance + squares + quantum * quantum)};
}

}  // namespace waymark::localization
