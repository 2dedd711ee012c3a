// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/particle_weights.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "localization/chi_square.hpp"

namespace waymark {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

/// atan2 for the small angles that pass a gate; to 1e-7 rad where it is a series.
double small_angle(double y, double x) {
  const double t = y / x;
  if (!(x > 0) || !(std::abs(t) < 0.25)) return std::atan2(y, x);
  const double s = t * t;
  return t * (1 - s * (1.0 / 3 - s * (0.2 - s * (1.0 / 7 - s / 9))));
}

}  // namespace

void WeightOptions::describe(OptionVisitor& option) {
  option("weights", weights,
         {.help = "How particles are weighed: by probability, or by eqs. 12-14",
          .choices = {"likelihood", "paper"}});
  option("temper", temper,
         {.help = "Power of each probability; below 1 where errors of successive sightings are alike",
          .min = 0.01,
          .max = 1});
  option("particle_gate", gate,
         {.help = "Probability that a right pairing passes", .min = 0.5, .max = 0.9999999});
  option("unmatched_cost", unmatched_cost,
         {.help = "paper: what a sighting without landmark costs; negative: the gate"});
  option("expect_unseen", expect_unseen,
         {.help = "likelihood: landmarks in view that were not seen speak against a place"});
  option("detection", detection,
         {.help = "Probability that a landmark in view is seen", .min = 0.01, .max = 0.999});
  option("view_range", view_range,
         {.help = "expect_unseen: how far the sensor sees, metres", .min = 0.1, .max = 1e5});
  option("view_angle", view_angle,
         {.help = "expect_unseen: the sensor's whole field of view, radians", .min = 0.01, .max = 6.2831854});
}

SightingScore::SightingScore(const SightingSet& seen, const LandmarkGrid& map, const FeatureScales& scales,
                             const WeightOptions& options, bool use_identities)
    : map_(&map),
      scales_(&scales),
      options_(options),
      robot_from_sensor_(seen.robot_from_sensor),
      paper_(options.weights == "paper") {
  const double gate = chi_square_quantile(options.gate, 2), sigmas = std::sqrt(gate);
  for (const SeenLandmark& s : seen.sightings) {
    if (!s.sound()) continue;
    Prepared p{.seen = s,
               .cosine = std::cos(s.bearing),
               .sine = std::sin(s.bearing),
               .range_variance = s.range ? s.range_sd * s.range_sd : 0,
               .bearing_variance = s.bearing_sd * s.bearing_sd,
               .radius = 0,
               .log_clutter = 0,
               .gate = gate,
               .landmark = {}};
    const double far = s.range ? *s.range : options.bearing_reach;
    p.radius =
        s.range ? sigmas * std::max(s.range_sd, far * std::min(s.bearing_sd, 1.0)) + sigmas * map.largest_sd()
                : far;
    p.log_clutter = std::log(options.clutter * (s.range ? 1 : far));
    if (use_identities && s.identity) {
      p.landmark = map.find(*s.identity);
      p.absent = !p.landmark;
    }
    if (s.type && std::ranges::find(types_, *s.type) == types_.end()) types_.push_back(*s.type);
    prepared_.push_back(p);
  }
}

double SightingScore::log_unseen(std::uint32_t landmark) const {
  return std::log1p(-options_.detection * std::max((*map_)[landmark].quality, options_.quality_floor));
}

double SightingScore::unseen(const Eigen::Vector2d& sensor, double cosine, double sine,
                             std::span<const std::uint32_t> matched) const {
  double sum = 0;
  const double least = std::cos(options_.view_angle / 2);
  map_->near(sensor, options_.view_range, [&](std::uint32_t i) {
    const MapLandmark& l = (*map_)[i];
    if (!types_.empty() && std::ranges::find(types_, l.type) == types_.end()) return;
    if (std::ranges::binary_search(hidden_, i)) return;
    const Eigen::Vector2d d = l.at - sensor;
    if (options_.view_angle < 6.28 && d.x() * cosine + d.y() * sine < least * d.norm()) return;
    if (std::ranges::find(matched, i) == matched.end()) sum += log_unseen(i);
  });
  return sum;
}

double SightingScore::unseen(const Pose2& robot, std::span<const std::uint32_t> matched) const {
  const Pose2 sensor = robot * robot_from_sensor_;
  return unseen(sensor.at(), std::cos(sensor.yaw), std::sin(sensor.yaw), matched);
}

double SightingScore::pair(const Prepared& p, std::uint32_t landmark, const Eigen::Vector2d& sensor,
                           const Eigen::Vector2d& along) const {
  const MapLandmark& l = (*map_)[landmark];
  if (!p.landmark && p.seen.type && *p.seen.type != l.type) return kNone;
  const double dx = l.at.x() - sensor.x(), dy = l.at.y() - sensor.y();
  const double ahead = along.x() * dx + along.y() * dy, left = along.x() * dy - along.y() * dx;
  const double range = std::max(std::sqrt(dx * dx + dy * dy), 1e-3);
  const double nx = dx / range, ny = dy / range;
  const double turn = small_angle(left, ahead);
  const Eigen::Matrix2d& c = l.covariance;
  const double tangential = (ny * ny * c(0, 0) - 2 * nx * ny * c(0, 1) + nx * nx * c(1, 1)) / (range * range);
  double squares = 0, log_det = 0;
  if (p.seen.range) {
    const double off = *p.seen.range - range;
    const double a = p.range_variance + nx * nx * c(0, 0) + 2 * nx * ny * c(0, 1) + ny * ny * c(1, 1);
    const double b = (nx * ny * (c(1, 1) - c(0, 0)) + (nx * nx - ny * ny) * c(0, 1)) / range;
    const double d = p.bearing_variance + tangential;
    const double det = a * d - b * b;
    squares = paper_ ? off * off / p.range_variance + turn * turn / p.bearing_variance
                     : (d * off * off + 2 * b * off * turn + a * turn * turn) / det;
    if (!(squares <= p.gate)) return kNone;
    log_det = std::log(det) + 2 * std::log(2 * std::numbers::pi);
  } else {
    const double d = p.bearing_variance + tangential;
    squares = turn * turn / (paper_ ? p.bearing_variance : d);
    if (!(squares <= p.gate)) return kNone;
    log_det = std::log(d) + std::log(2 * std::numbers::pi);
  }
  const bool comparable = p.seen.type && *p.seen.type == l.type;
  const FeatureComparison features =
      comparable ? compare_features(*scales_, l.type, p.seen.features, l.features, options_.feature_tolerance)
                 : FeatureComparison{};
  if (features.largest > options_.feature_limit) return kNone;
  const double quality = std::max(l.quality, options_.quality_floor);
  if (paper_) return (squares + features.squares) * quality;
  // As a cost, -2 ln of the density. A missing feature counts 1; right ones count 1 each on average.
  return squares + log_det + features.squares - features.used - 2 * std::log(quality * p.seen.confidence);
}

SightingScore::Best SightingScore::best(const Prepared& p, const Eigen::Vector2d& sensor, double cosine,
                                        double sine) const {
  const Eigen::Vector2d along(cosine * p.cosine - sine * p.sine, sine * p.cosine + cosine * p.sine);
  if (p.absent) return {kNone, 0};
  if (p.landmark) return {pair(p, *p.landmark, sensor, along), *p.landmark};
  Best least{kNone, 0};
  const Eigen::Vector2d centre = p.seen.range ? Eigen::Vector2d(sensor + *p.seen.range * along) : sensor;
  map_->near(centre, p.radius, [&](std::uint32_t i) {
    if (const double cost = pair(p, i, sensor, along); cost < least.cost) least = {cost, i};
  });
  return least;
}

double SightingScore::operator()(const Pose2& robot) const {
  double cosine = std::cos(robot.yaw), sine = std::sin(robot.yaw);
  const Pose2& mount = robot_from_sensor_;
  const Eigen::Vector2d sensor(robot.x + cosine * mount.x - sine * mount.y,
                               robot.y + sine * mount.x + cosine * mount.y);
  if (mount.yaw != 0) cosine = std::cos(robot.yaw + mount.yaw), sine = std::sin(robot.yaw + mount.yaw);
  double sum = 0;
  const bool expects = options_.expect_unseen && !paper_;
  const double seen = expects ? std::log(options_.detection) : 0;
  std::vector<std::uint32_t> matched;
  for (const Prepared& p : prepared_) {
    const auto [cost, landmark] = best(p, sensor, cosine, sine);
    if (expects && cost < kNone) matched.push_back(landmark);
    if (paper_) {
      sum += cost < kNone ? cost : options_.unmatched_cost < 0 ? p.gate : options_.unmatched_cost;
    } else if (cost < kNone) {
      const double fit = seen - cost / 2, high = std::max(fit, p.log_clutter),
                   low = std::min(fit, p.log_clutter);
      sum += options_.temper * (high + std::log1p(std::exp(low - high)));
    } else {
      sum += options_.temper * p.log_clutter;
    }
  }
  if (expects) sum += options_.temper * unseen(sensor, cosine, sine, matched);
  return sum;
}

std::vector<double> paper_weights(std::span<const double> errors) {
  std::vector<double> weights(errors.size(), 1);
  if (errors.empty()) return weights;
  const auto [least, most] = std::ranges::minmax_element(errors);
  if (!(*most - *least > 1e-12 * std::max(1.0, std::abs(*most)))) return weights;
  for (std::size_t i = 0; i < errors.size(); ++i) weights[i] = (*most - errors[i]) / *most;
  return weights;
}

std::vector<double> normalised(std::span<const double> log_weights) {
  std::vector<double> weights(log_weights.size());
  double most = -kNone, sum = 0;
  for (const double w : log_weights)
    if (w > most) most = w;
  if (!(most > -kNone)) {
    std::ranges::fill(weights, 1 / static_cast<double>(std::max<std::size_t>(1, weights.size())));
    return weights;
  }
  for (std::size_t i = 0; i < weights.size(); ++i)
    sum += weights[i] = log_weights[i] > -kNone ? std::exp(log_weights[i] - most) : 0;
  for (double& w : weights) w /= sum;
  return weights;
}

}  // namespace waymark
