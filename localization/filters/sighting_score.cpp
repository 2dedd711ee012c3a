// SPDX-License-Identifier: Apache-2.0
#include "localization/filters/sighting_score.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "core/covariance.hpp"

namespace waymark::localization {
namespace {

constexpr double kLineSlack = 0.5;  // m along a line: its ends are hidden, or cut by cells
constexpr double kNone = std::numeric_limits<double>::infinity();

/// Number of poses evaluated side by side in vector registers.
constexpr int kLanes = 8;
using Lanes = Eigen::Array<double, kLanes, 1>;

// Computes atan2 for the small angles that pass a gate; to 1e-7 rad where it is a series.
template <class T>
T series(const T& t) {
  const T s = t * t;
  return t * (1 - s * (1.0 / 3 - s * (0.2 - s * (1.0 / 7 - s * (1.0 / 9)))));
}
double small_angle(double y, double x) {
  const double t = y / x;
  return x > 0 && std::abs(t) < 0.25 ? series(t) : std::atan2(y, x);
}
Lanes small_angle(const Lanes& y, const Lanes& x) {
  const Lanes t = y / x;
  Lanes angle = series(t);
  for (int i = 0; i < kLanes; ++i)
    if (!(x[i] > 0 && std::abs(t[i]) < 0.25)) angle[i] = std::atan2(y[i], x[i]);
  return angle;
}

/// For angles up to half a radian, to 1e-16.
Lanes cosine_of(const Lanes& angle) {
  const Lanes s = angle * angle;
  Lanes sum = Lanes::Ones();
  for (const double n : {14, 12, 10, 8, 6, 4, 2}) sum = 1 - s * (1 / (n * (n - 1))) * sum;
  return sum;
}
Lanes sine_of(const Lanes& angle) {
  const Lanes s = angle * angle;
  Lanes sum = Lanes::Ones();
  for (const double n : {13, 11, 9, 7, 5, 3}) sum = 1 - s * (1 / (n * (n - 1))) * sum;
  return angle * sum;
}

double at_least(double a, double low) {
  return std::max(a, low);
}
Lanes at_least(const Lanes& a, double low) {
  return a.max(low);
}
double larger(double a, double b) {
  return std::max(a, b);
}
Lanes larger(const Lanes& a, const Lanes& b) {
  return a.max(b);
}

}  // namespace

// Position of the sensor and direction of a sighting.
template <class T>
struct SightingScore::View {
  T x, y, cosine, sine;
};

SightingScore::GateBounds::GateBounds(const Prepared& p, double sd) {
  constexpr double kSlack = 1 + 1e-5, kMinRange = 2e-3;  // of rounding; m: matches take no range below 1 mm
  const double gate = kSlack * p.gate;
  off = p.seen.range ? std::sqrt(gate * (p.range_variance + sd * sd)) + kMinRange : kNone;
  const double nearest = p.seen.range ? std::max(0.0, *p.seen.range - off) : 0;
  const double farthest = p.seen.range ? *p.seen.range + off : kNone;
  min_square = nearest * nearest, max_square = farthest * farthest;
  near = p.seen.bearing ? gate * sd * sd : kNone, widening = gate * p.bearing_variance;
}

template <class T>
T SightingScore::GateBounds::excess(const T& left, const T& square) const {
  return larger(T(left * left - near - widening * square),
                larger(T(min_square - square), T(square - max_square)));
}

// Comparison of a landmark's position with the measured one: squared distance, and one over the determinant
// of its covariance.
template <class T>
struct SightingScore::PositionMatch {
  T squares, inverse_det;
};

SightingScore::SightingScore(const SightingSet& seen, const LandmarkGrid& map, const FeatureScales& scales,
                             const WeightOptions& options, const IdentificationOptions& identification,
                             MapErrorFactor map_error)
    : map_(&map),
      scales_(&scales),
      options_(options),
      identification_(identification),
      map_error_(std::move(map_error)),
      robot_from_sensor_(seen.robot_from_sensor),
      paper_(options.weights == "paper") {
  const double gate = -2 * std::log1p(-options.gate);  // chi-square quantile of two degrees of freedom
  const double sigmas = std::sqrt(gate);
  for (const SeenLandmark& s : seen.sightings) {
    if (!s.is_valid()) continue;
    const double far = s.range ? *s.range : identification.reach_of(s, scales);
    Prepared p{.seen = s,
               .cosine = std::cos(s.bearing.value_or(0)),
               .sine = std::sin(s.bearing.value_or(0)),
               .ahead = s.has_position() ? *s.range : 0,
               .range_variance = s.range ? s.range_sd * s.range_sd : 0,
               .bearing_variance = s.bearing_sd * s.bearing_sd,
               .radius = far,
               .clutter = identification.clutter_of(s),
               .gate = gate,
               .candidates = {}};
    if (s.extent)
      p.radius = std::hypot(far, std::max(std::abs(s.extent->from), std::abs(s.extent->to))) +
                 map.max_half_length() + kLineSlack;
    else if (!s.bearing)
      p.radius = far + sigmas * (s.range_sd + map.largest_sd());
    else if (s.range)
      p.radius = sigmas * std::max(s.range_sd, far * std::min(s.bearing_sd, 1.0)) + sigmas * map.largest_sd();
    p.known = identification.use_identities && s.identity && !s.extent;
    if (s.type)
      for (std::size_t i = 0; i < kMaxFeatures; ++i)
        p.turns = p.turns || (s.features.known(i) && scales.is_angle(*s.type, i));
    if (p.known) {
      if (const auto l = map.find(*s.identity))
        if (const auto alike = pose_free_terms(p, *l))
          p.candidates.push_back(
              {*l, map[*l].at, map_covariance(*l), GateBounds(p, largest_sd(map_covariance(*l))), *alike});
    }
    for (const TypeId type : types_of(s))
      if (std::ranges::find(types_, type) == types_.end()) types_.push_back(type);
    prepared_.push_back(std::move(p));
  }
}

Eigen::Matrix2d SightingScore::map_covariance(std::uint32_t landmark) const {
  const MapLandmark& l = (*map_)[landmark];
  return map_error_ ? Eigen::Matrix2d(map_error_(l.key) * l.covariance) : l.covariance;
}

double SightingScore::quality(std::uint32_t landmark) const {
  const MapLandmark& l = (*map_)[landmark];
  if (identification_.quality_floor >= 1) return 1;
  if (identification_.quality == "paper") return l.paper_quality;
  return paper_ ? l.quality : existence_prior(l, identification_);
}

bool SightingScore::is_left_out(std::uint32_t landmark) const {
  return !paper_ && localization::is_left_out((*map_)[landmark], identification_);
}

double SightingScore::log_unseen(std::uint32_t landmark) const {
  return std::log1p(-options_.detection * quality(landmark));
}

double SightingScore::unseen(const Eigen::Vector2d& sensor, double cosine, double sine,
                             std::span<const std::uint32_t> matched) const {
  double sum = 0;
  const double min_cosine = std::cos(options_.view_angle / 2);
  map_->near(sensor, options_.view_range, [&](std::uint32_t i) {
    const MapLandmark& l = (*map_)[i];
    if (!types_.empty() && std::ranges::find(types_, l.type) == types_.end()) return;
    if (is_left_out(i) || std::ranges::binary_search(hidden_, i)) return;
    const Eigen::Vector2d d = l.at - sensor;
    if (options_.view_angle < 6.28 && d.x() * cosine + d.y() * sine < min_cosine * d.norm()) return;
    if (std::ranges::find(matched, i) == matched.end()) sum += log_unseen(i);
  });
  return sum;
}

double SightingScore::unseen(const Pose2& robot, std::span<const std::uint32_t> matched) const {
  const Pose2 sensor = robot * robot_from_sensor_;
  return unseen(sensor.at(), std::cos(sensor.yaw), std::sin(sensor.yaw), matched);
}

// For a sighting with an angle: an upper bound, without it.
std::optional<SightingScore::PoseFreeTerms> SightingScore::pose_free_terms(const Prepared& p,
                                                                           std::uint32_t landmark) const {
  return feature_terms(
      p, landmark,
      p.turns ? features_without_angles(*scales_, *p.seen.type, p.seen.features) : p.seen.features);
}

std::optional<SightingScore::PoseFreeTerms> SightingScore::feature_terms(const Prepared& p,
                                                                         std::uint32_t landmark,
                                                                         const KnownFeatures& seen) const {
  const MapLandmark& l = (*map_)[landmark];
  if (!p.known && (!p.seen.may_be(l.type) || is_left_out(landmark))) return {};
  FeatureComparison features;
  if (p.seen.type == l.type)
    features = compare_features(*scales_, l.type, seen, l.features, identification_.feature_tolerance);
  else if (const KnownFeatures* possible = p.seen.features_as(l.type))
    features = compare_features(*scales_, l.type, *possible, l.features, identification_.feature_tolerance);
  if ((paper_ ? features.largest_weighted : features.largest) > identification_.feature_limit) return {};
  // A missing feature counts 1, which is what matching features count on average.
  const double alike = std::exp((features.used - features.squares) / 2);
  const double turns = 2 * std::numbers::pi;
  return PoseFreeTerms{.scale = quality(landmark) * p.seen.confidence * alike /
                                (p.seen.has_position() ? turns : std::sqrt(turns)),
                       .features = features.weighted_squares};
}

template <class T>
SightingScore::PositionMatch<T> SightingScore::match_position(const Prepared& p, const Eigen::Vector2d& at,
                                                              const Eigen::Matrix2d& c,
                                                              const View<T>& view) const {
  using std::sqrt;
  const T dx = at.x() - view.x, dy = at.y() - view.y;
  const T ahead = view.cosine * dx + view.sine * dy, left = view.cosine * dy - view.sine * dx;
  const T range = at_least(T(sqrt(dx * dx + dy * dy)), 1e-3), inverse = 1 / range;
  const T nx = dx * inverse, ny = dy * inverse, xx = nx * nx, xy = nx * ny, yy = ny * ny;
  if (!p.seen.bearing) {
    const T off = *p.seen.range - range;
    const T inverse_a = 1 / (p.range_variance + xx * c(0, 0) + 2 * c(0, 1) * xy + yy * c(1, 1));
    return {off * off * (paper_ ? T(0 * off + 1 / p.range_variance) : inverse_a), inverse_a};
  }
  const T turn = small_angle(left, ahead);
  const T across = yy * c(0, 0) - 2 * c(0, 1) * xy + xx * c(1, 1);
  const T d = p.bearing_variance + across * (inverse * inverse);
  if (!p.seen.range) {
    const T inverse_d = 1 / d;
    return {turn * turn * (paper_ ? T(0 * d + 1 / p.bearing_variance) : inverse_d), inverse_d};
  }
  const T off = *p.seen.range - range;
  const T a = p.range_variance + xx * c(0, 0) + 2 * c(0, 1) * xy + yy * c(1, 1);
  const T b = (xy * (c(1, 1) - c(0, 0)) + (xx - yy) * c(0, 1)) * inverse;
  const T inverse_det = 1 / (a * d - b * b);
  if (paper_) return {off * off / p.range_variance + turn * turn / p.bearing_variance, inverse_det};
  return {(d * off * off + 2 * b * off * turn + a * turn * turn) * inverse_det, inverse_det};
}

SightingScore::PositionMatch<double> SightingScore::match_line(const Prepared& p, std::uint32_t landmark,
                                                               const Eigen::Vector2d& sensor) const {
  const MapLandmark& l = (*map_)[landmark];
  const double off = *p.seen.range - l.normal.dot(sensor - l.at);
  const double inverse =
      1 / (p.range_variance + l.normal.dot(map_covariance(landmark) * l.normal) + swing_variance(l, sensor));
  return {off * off * (paper_ ? 1 / p.range_variance : inverse), inverse};
}

template <class T>
T SightingScore::value(const PositionMatch<T>& place, const PoseFreeTerms& pose_free_terms) const {
  using std::exp;
  using std::sqrt;
  if (paper_) return place.squares + pose_free_terms.features;
  return pose_free_terms.scale * exp(-0.5 * place.squares) * sqrt(place.inverse_det);
}

SightingScore::Best SightingScore::best(const Prepared& p, const View<double>& view, bool in_cloud,
                                        double sensor_yaw) const {
  Best best{paper_ ? kNone : 0, 0};
  KnownFeatures turned;
  if (p.turns) turned = features_in_map(*scales_, *p.seen.type, p.seen.features, sensor_yaw);
  const auto take = [&](const PositionMatch<double>& there, PoseFreeTerms alike, std::uint32_t landmark) {
    if (p.turns) {
      const auto all = feature_terms(p, landmark, turned);
      if (!all) return;
      alike = *all;
    }
    const double v = value(there, alike);
    if (paper_ ? v < best.value : v > best.value) best = {v, landmark};
  };
  const Eigen::Vector2d centre(view.x + p.ahead * view.cosine, view.y + p.ahead * view.sine);
  if (p.known || (in_cloud && p.prefetched)) {
    for (const Candidate& c : p.candidates) {
      const double dx = c.at.x() - view.x, dy = c.at.y() - view.y;
      if (!(c.bounds.excess(view.cosine * dy - view.sine * dx, dx * dx + dy * dy) <= 0)) continue;
      if (!p.known && !((c.at - centre).squaredNorm() <= p.radius * p.radius)) continue;
      if (const auto there = match_position(p, c.at, c.covariance, view); there.squares <= p.gate)
        take(there, c.pose_free_terms, c.landmark);
    }
    return best;
  }
  map_->near(centre, p.radius, [&](std::uint32_t i) {
    const MapLandmark& l = (*map_)[i];
    if (!p.seen.may_be(l.type)) return;
    const Eigen::Vector2d sensor(view.x, view.y);
    if (p.seen.extent && !(l.is_line() && may_overlap(*p.seen.extent, sensor, l, kLineSlack))) return;
    const auto there =
        p.seen.extent ? match_line(p, i, sensor) : match_position(p, l.at, map_covariance(i), view);
    if (!(there.squares <= p.gate)) return;
    if (const auto alike = pose_free_terms(p, i)) take(there, *alike, i);
  });
  return best;
}

// The hot loop of the particle filter.
void SightingScore::score_lanes(const Pose2* poses, double* fit) const {
  Lanes x, y, turn;
  for (int i = 0; i < kLanes; ++i) {
    x[i] = poses[i].x, y[i] = poses[i].y;
    turn[i] = wrap_angle(poses[i].yaw - cloud_.middle.yaw);
  }
  const double ahead = std::cos(cloud_.middle.yaw), across = std::sin(cloud_.middle.yaw);
  const Lanes c = cosine_of(turn), s = sine_of(turn);
  const Lanes cosine = ahead * c - across * s, sine = across * c + ahead * s;
  const Pose2& mount = robot_from_sensor_;
  x += cosine * mount.x - sine * mount.y;
  y += sine * mount.x + cosine * mount.y;
  Lanes sum = Lanes::Zero(), product = Lanes::Ones();
  const double mount_cosine = std::cos(mount.yaw), mount_sine = std::sin(mount.yaw);
  for (const Prepared& p : prepared_) {
    const double forward = mount_cosine * p.cosine - mount_sine * p.sine,
                 left = mount_sine * p.cosine + mount_cosine * p.sine;
    const View<Lanes> view{x, y, cosine * forward - sine * left, sine * forward + cosine * left};
    const double square = p.known ? kNone : p.radius * p.radius;
    const Lanes centre_x = x + p.ahead * view.cosine, centre_y = y + p.ahead * view.sine;
    Lanes best = Lanes::Zero();
    for (const Candidate& l : p.candidates) {
      const Lanes dx = l.at.x() - x, dy = l.at.y() - y;
      const Lanes excess =
          l.bounds.excess(Lanes(view.cosine * dy - view.sine * dx), Lanes(dx * dx + dy * dy));
      if (!(excess.minCoeff() <= 0)) continue;
      const Lanes away = (l.at.x() - centre_x).square() + (l.at.y() - centre_y).square();
      if (!(away.minCoeff() <= square)) continue;
      const PositionMatch<Lanes> there = match_position(p, l.at, l.covariance, view);
      if (!(there.squares.minCoeff() <= p.gate)) continue;
      const Lanes v = value(there, l.pose_free_terms);
      for (int i = 0; i < kLanes; ++i) {
        const double inside = away[i] <= square && there.squares[i] <= p.gate ? v[i] : 0;
        best[i] = std::max(best[i], inside);
      }
    }
    product *= p.clutter + best;
    if (!(product.minCoeff() > 1e-100 && product.maxCoeff() < 1e100))
      sum += product.log(), product = Lanes::Ones();
  }
  const Lanes all = options_.temper * (sum + product.log());
  std::copy_n(all.data(), kLanes, fit);
}

void SightingScore::operator()(std::span<const Pose2> poses, std::span<double> fit) const {
  std::size_t i = 0;
  if (shared_candidates_ && std::ranges::all_of(poses, [&](const Pose2& p) { return cloud_.contains(p); }))
    for (; i + kLanes <= poses.size(); i += kLanes) score_lanes(&poses[i], &fit[i]);
  for (; i < poses.size(); ++i) fit[i] = (*this)(poses[i]);
}

double SightingScore::operator()(const Pose2& robot) const {
  double cosine = std::cos(robot.yaw), sine = std::sin(robot.yaw);
  const Pose2& mount = robot_from_sensor_;
  const Eigen::Vector2d sensor(robot.x + cosine * mount.x - sine * mount.y,
                               robot.y + sine * mount.x + cosine * mount.y);
  if (mount.yaw != 0) cosine = std::cos(robot.yaw + mount.yaw), sine = std::sin(robot.yaw + mount.yaw);
  const bool in_cloud = cloud_.contains(robot);
  const bool expects = options_.expect_unseen && !paper_;
  const double detection = expects ? options_.detection : 1;
  double sum = 0, product = 1;  // of costs; of densities
  std::vector<std::uint32_t> matched;
  for (const Prepared& p : prepared_) {
    const Eigen::Vector2d along(cosine * p.cosine - sine * p.sine, sine * p.cosine + cosine * p.sine);
    const auto [value, landmark] =
        best(p, {sensor.x(), sensor.y(), along.x(), along.y()}, in_cloud, robot.yaw + mount.yaw);
    if (paper_) {
      if (value < kNone)
        sum += value * quality(landmark);
      else
        sum += options_.unmatched_cost < 0 ? p.gate : options_.unmatched_cost;
      continue;
    }
    if (expects && value > 0) matched.push_back(landmark);
    product *= p.clutter + detection * value;
    if (!(product > 1e-100 && product < 1e100)) sum += std::log(product), product = 1;
  }
  if (paper_) return sum;
  sum += std::log(product);
  if (expects) sum += unseen(sensor, cosine, sine, matched);
  return options_.temper * sum;
}

}  // namespace waymark::localization
