// SPDX-License-Identifier: Apache-2.0
#include "localization/global/skyline_profile.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace waymark::localization {
namespace {

constexpr double kFullTurn = 2 * std::numbers::pi, kSectorWidth = kFullTurn / kHorizonSectors;
constexpr std::size_t kMaxRays = 240;
constexpr double kMaxChange = 4;  // between rays of an arbitrary horizon, over the mean change
constexpr double kMinCover = kFullTurn / 3, kMinSpread = 0.003;  // rad
constexpr double kSectorError = 0.004;                           // rad: of cone tracing
constexpr double kUnlike = 0.2;       // probability that a ray of the horizon is not that of the DEM
constexpr double kRayError = 0.0005;  // rad: of rays through the DEM
constexpr double kKernel = 2.5;       // of Cauchy, standard deviations
constexpr double kGateSquares = 9;
constexpr int kFitRounds = 7, kFinalRounds = 3;
constexpr double kErrorFactors[] = {1, 0.5, 0.25, 0.125, 0.0625};  // of the stated error of the heights
constexpr double kMinMatched = 0.5;                                // fraction of the rays compared
constexpr double kGridError = 0.12;  // of position_sd, about a cell: error of a pose by bilinear heights

/// Predicted horizon of all rays at a pose, rad, and distances. Elevations are NaN where the DEM has no
/// terrain or a hole may hide the horizon.
struct Prediction {
  std::vector<double> elevation, distance;
  std::vector<bool> hidden;
};

/// Pose of the robot and what its eye is higher than the DEM says, m: an error that all rays share.
using EyeState = Eigen::Vector4d;

class ProfileFit {
 public:
  ProfileFit(const SkylineScene& scene, const SeenHorizon& seen) : scene_(scene), seen_(seen) {}

  std::optional<SkylineFix> find(const HorizonGuess& guess, double place) {
    EyeState pose(guess.at.x(), guess.at.y(), guess.yaw, 0);
    error_ = scene_.options.height_sd;
    const double reach = 4 * place + 4 * scene_.terrain.cell();
    if (!improve(pose, place, kSectorWidth, kFitRounds)) return {};
    if ((pose.head<2>() - guess.at).norm() > reach) return {};
    // How well the DEM is known shows in how well it fits.
    const auto here = predict(pose);
    if (!here) return {};
    error_ = scene_.options.height_sd * likeliest_factor(*here);
    if (!improve(pose, 0, 0, kFinalRounds) || (pose.head<2>() - guess.at).norm() > reach) return {};
    return evaluate_fix(pose);
  }

 private:
  struct System {
    Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    double cost = 0;
  };

  /// Moves the pose by steps of Levenberg and Marquardt; the tolerance shrinks from that of the guess.
  bool improve(EyeState& pose, double place, double turn, int rounds) const {
    double damping = 1e-3;
    for (int round = 0; round < rounds; ++round) {
      const auto system = normal_equations(pose, place, turn);
      if (!system) return false;
      Eigen::Matrix4d damped = system->information;
      damped.diagonal() *= 1 + damping;
      const Eigen::Vector4d change = damped.ldlt().solve(system->right);
      if (!change.allFinite()) return false;
      const EyeState next = pose + change;
      if (cost(next, place, turn) < system->cost) {
        pose = next;
        damping = std::max(1e-6, damping / 5);
      } else {
        damping *= 10;
      }
      place *= 0.5, turn *= 0.5;
    }
    return true;
  }

  /// Returns ln of the density of the horizon at a pose over that of an arbitrary one.
  double log_ratio(const Prediction& here) const {
    double sum = 0;
    for (std::size_t i = 0; i < seen_.rays().size(); ++i) {
      const double r = seen_.rays()[i].elevation - here.elevation[i], v = variance(here.distance[i], 0, 0);
      if (here.hidden[i]) continue;
      double ratio = kUnlike;
      if (std::isfinite(r))
        ratio += (1 - kUnlike) * std::exp(-r * r / (2 * v)) / std::sqrt(kFullTurn * v) / seen_.arbitrary(i);
      sum += independence(here.distance[i]) * std::log(ratio);
    }
    return sum;
  }

  double likeliest_factor(const Prediction& here) {
    double best = -std::numeric_limits<double>::infinity(), chosen = 1;
    for (const double factor : kErrorFactors) {
      error_ = scene_.options.height_sd * factor;
      if (const double ratio = log_ratio(here); ratio > best) best = ratio, chosen = factor;
    }
    return chosen;
  }

  std::optional<Prediction> predict(const EyeState& pose) const {
    const double ground = scene_.terrain.height(pose.x(), pose.y());
    if (!std::isfinite(ground)) return {};
    Prediction p;
    for (const SeenHorizon::Ray& ray : seen_.rays()) {
      const HorizonEdge edge =
          horizon_at(scene_.terrain, pose.head<2>(), ground + scene_.options.eye + pose[3],
                     pose.z() + ray.bearing, scene_.options);
      p.elevation.push_back(edge.is_known() ? std::atan(double(edge.rise)) : std::nan(""));
      p.hidden.push_back(edge.possible > edge.rise);
      p.distance.push_back(std::max(double(edge.far), scene_.terrain.cell()));
    }
    return p;
  }

  double variance(double distance, double place, double turn) const {
    const double up = (error_ + 0.3 * place) / distance;
    const double slope = std::min(0.3, 10 * seen_.spread());
    return seen_.elevation_sd() * seen_.elevation_sd() + kRayError * kRayError + up * up +
           slope * slope * turn * turn;
  }

  /// Returns the weight of a ray: rays that end within two cells of their neighbour share its error.
  double independence(double distance) const {
    return std::min(1.0, distance * seen_.spacing() / (2 * scene_.terrain.cell()));
  }

  double cost(const EyeState& pose, double place, double turn) const {
    const auto here = predict(pose);
    if (!here) return std::numeric_limits<double>::infinity();
    double sum = 0;
    for (std::size_t i = 0; i < seen_.rays().size(); ++i) sum += ray_cost(*here, i, place, turn);
    return sum + heading_cost(pose.z()) + pose[3] * pose[3] / (eye_sd() * eye_sd());
  }

  double ray_cost(const Prediction& here, std::size_t i, double place, double turn) const {
    const double r = seen_.rays()[i].elevation - here.elevation[i];
    if (here.hidden[i]) return independence(here.distance[i]);  // what a ray that fits costs on average
    if (!std::isfinite(r)) return kKernel * kKernel;
    const double squares = r * r / variance(here.distance[i], place, turn) / (kKernel * kKernel);
    return independence(here.distance[i]) * kKernel * kKernel * std::log1p(squares);
  }

  /// The DEM errs at the robot as it does at the horizon.
  double eye_sd() const { return error_; }

  double heading_cost(double yaw) const {
    if (!scene_.options.heading) return 0;
    const double r = wrap_angle(*scene_.options.heading - yaw) / scene_.options.heading_sd;
    return r * r;
  }

  std::optional<System> normal_equations(const EyeState& pose, double place, double turn) const {
    const double step = std::max(0.5 * scene_.terrain.cell(), 0.3 * place),
                 angle = std::max(0.25 * seen_.spacing(), 0.3 * turn);
    const auto here = predict(pose);
    if (!here) return {};
    const EyeState steps(step, step, angle, 0.3 * eye_sd());
    std::array<std::optional<Prediction>, 8> moved;
    for (int k = 0; k < 4; ++k)
      for (int side = 0; side < 2; ++side) {
        EyeState other = pose;
        other[k] += (side ? 1 : -1) * steps[k];
        moved[static_cast<std::size_t>(2 * k + side)] = predict(other);
        if (!moved[static_cast<std::size_t>(2 * k + side)]) return {};
      }
    System s;
    for (std::size_t i = 0; i < seen_.rays().size(); ++i) {
      const double v = variance(here->distance[i], place, turn);
      const double r = seen_.rays()[i].elevation - here->elevation[i];
      s.cost += ray_cost(*here, i, place, turn);
      if (!std::isfinite(r)) continue;
      const double own = independence(here->distance[i]), squares = r * r / v / (kKernel * kKernel);
      Eigen::Vector4d j;
      for (int k = 0; k < 4; ++k)
        j[k] = (moved[static_cast<std::size_t>(2 * k + 1)]->elevation[i] -
                moved[static_cast<std::size_t>(2 * k)]->elevation[i]) /
               (2 * steps[k]);
      if (!j.allFinite()) continue;
      const double weight = own / v / (1 + squares);
      s.information += weight * j * j.transpose();
      s.right += weight * r * j;
    }
    s.information(3, 3) += 1 / (eye_sd() * eye_sd());
    s.right[3] -= pose[3] / (eye_sd() * eye_sd());
    s.cost += pose[3] * pose[3] / (eye_sd() * eye_sd());
    if (scene_.options.heading) {
      const double v = scene_.options.heading_sd * scene_.options.heading_sd;
      const double r = wrap_angle(*scene_.options.heading - pose.z());
      s.information(2, 2) += 1 / v;
      s.right[2] += r / v;
      s.cost += heading_cost(pose.z());
    }
    return s;
  }

  std::optional<SkylineFix> evaluate_fix(const EyeState& pose) const {
    const auto system = normal_equations(pose, 0, 0);
    const auto here = predict(pose);
    if (!system || !here) return {};
    const Eigen::LDLT<Eigen::Matrix4d> solver(system->information);
    if (!solver.isPositive() || !(solver.rcond() > 1e-14)) return {};
    SkylineFix fix{
        .at = {pose_of(pose.head<3>()), solver.solve(Eigen::Matrix4d::Identity()).topLeftCorner<3, 3>()},
        .summits = {},
        .matched = 0,
        .compared = static_cast<int>(std::ranges::count(here->hidden, false)),
        .squares = 0,
        .log_false_alarms = 0};
    if (fix.compared * seen_.spacing() < kMinCover) return {};
    double weights = 0;
    for (std::size_t i = 0; i < seen_.rays().size(); ++i) {
      const double r = seen_.rays()[i].elevation - here->elevation[i], v = variance(here->distance[i], 0, 0);
      if (!(r * r < kGateSquares * v)) continue;
      const double own = independence(here->distance[i]);
      ++fix.matched;
      fix.squares += own * r * r / v;
      weights += own;
    }
    if (fix.matched < kMinMatched * fix.compared) return {};
    fix.at.covariance *= std::max(1.0, fix.squares / std::max(1.0, weights - 3));
    // Between the cells of the DEM the terrain is not known, which all rays share.
    const double grid = kGridError * scene_.options.position_sd;
    std::vector<double> distances = here->distance;
    std::ranges::nth_element(distances, distances.begin() + std::ssize(distances) / 2);
    const double turn = grid / distances[distances.size() / 2];
    fix.at.covariance.diagonal() += Eigen::Vector3d(grid * grid, grid * grid, turn * turn);
    const double one =
        std::pow(kFullTurn, 1.5) * std::sqrt(std::max(fix.at.covariance.determinant(), 1e-300));
    fix.log_false_alarms = -log_ratio(*here) + std::log(double(std::size(kErrorFactors))) +
                           std::log(std::max(1.0, scene_.terrain.area().volume() * kFullTurn / one));
    return fix;
  }

  const SkylineScene& scene_;
  const SeenHorizon& seen_;
  double error_ = 0;  // m, of the heights at the horizon
};

/// Tolerance of the elevation in each sector for positions within half a step.
std::array<float, kHorizonSectors> profile_tolerance(const HorizonViewpoint& viewpoint) {
  std::array<float, kHorizonSectors> inverse;
  const auto& ring = viewpoint.ring;
  const std::size_t n = ring.size();
  for (std::size_t k = 0; k < n; ++k) {
    const double far = std::max(1.0F, ring[k].far), rise = ring[k].rise;
    const double slope =
        std::clamp((double(ring[(k + 1) % n].rise) - double(ring[(k + n - 1) % n].rise)) / (2 * kSectorWidth),
                   -0.5, 0.5);
    const double parallax = viewpoint.step / far, up = viewpoint.relief / far,
                 along = 0.3 * parallax * std::min(std::abs(rise), 2.0),
                 across = 0.3 * slope * std::hypot(kSectorWidth, parallax);
    inverse[k] = static_cast<float>(
        1 / std::sqrt(kSectorError * kSectorError + up * up + along * along + across * across));
  }
  return inverse;
}

std::vector<HorizonGuess> profile_headings_at(const HorizonViewpoint& viewpoint, const SeenHorizon& seen,
                                              std::size_t max_count, const SkylineOptions& options) {
  constexpr std::size_t n = kHorizonSectors;
  const auto inverse = profile_tolerance(viewpoint);
  std::array<float, 2 * n> rise, scale, log_density;  // twice around, so that no index wraps
  for (std::size_t k = 0; k < 2 * n; ++k) {
    rise[k] = viewpoint.ring[k % n].rise, scale[k] = inverse[k % n];
    log_density[k] = static_cast<float>(std::log(0.1 * double(scale[k])));
  }
  const auto unlike = static_cast<float>(std::log(kUnlike));
  std::array<float, n> sum{};
  for (std::size_t j = 0; j < n; ++j) {
    const float elevation = seen.sectors()[j];
    if (!std::isfinite(elevation)) continue;
    for (std::size_t y = 0; y < n; ++y) {
      const float z = (elevation - rise[j + y]) * scale[j + y];
      sum[y] += std::max(unlike, log_density[j + y] - z * z / 2);
    }
  }
  std::vector<HorizonGuess> best;
  for (std::size_t y = 0; y < n; ++y) {
    const double yaw = wrap_angle(static_cast<double>(y) * kSectorWidth);
    if (options.heading &&
        std::abs(wrap_angle(yaw - *options.heading)) > options.sigmas * options.heading_sd + kSectorWidth)
      continue;
    if (sum[y] >= sum[(y + 1) % n] && sum[y] > sum[(y + n - 1) % n])
      best.push_back({.at = viewpoint.at, .yaw = yaw, .score = static_cast<double>(sum[y])});
  }
  std::ranges::stable_sort(best, std::greater<>{}, &HorizonGuess::score);
  if (best.size() > max_count) best.resize(max_count);
  return best;
}

}  // namespace

SeenHorizon::SeenHorizon(const HorizonProfile& profile)
    : elevation_sd_(std::max(profile.elevation_sd, 1e-5)) {
  sectors_.fill(std::numeric_limits<float>::quiet_NaN());
  const std::size_t n = profile.elevations.size();
  if (n < 3 || !(profile.angle_step > 0)) return;
  // Each ray is a direction that was measured; elevations are not averaged, which would lower tops.
  const std::size_t stride = std::max<std::size_t>(1, (n + kMaxRays - 1) / kMaxRays);
  spacing_ = profile.angle_step * static_cast<double>(stride);
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double e = static_cast<double>(profile.elevations[i]);
    if (!std::isfinite(e) || std::abs(e) > 1.5) continue;
    const double bearing = profile.first_angle + static_cast<double>(i) * profile.angle_step;
    const double turns = bearing / kFullTurn - std::floor(bearing / kFullTurn);
    const auto k =
        std::min<std::size_t>(static_cast<std::size_t>(turns * kHorizonSectors), kHorizonSectors - 1);
    const auto rise = static_cast<float>(std::tan(e));
    if (!(sectors_[k] >= rise)) sectors_[k] = rise;
    if (i % stride != 0) continue;
    rays_.push_back({wrap_angle(bearing), e});
    sum += e, squares += e * e;
  }
  if (rays_.size() < 3) return;
  const double count = static_cast<double>(rays_.size());
  mean_ = sum / count;
  spread_ = std::sqrt(std::max(squares / count - mean_ * mean_, 1e-8));
  // An arbitrary horizon goes on from its neighbour by Laplace's distribution: slopes and cliffs.
  double product = 0;
  for (std::size_t i = 0; i < rays_.size(); ++i)
    product += (rays_[i].elevation - mean_) * (rays_[(i + 1) % rays_.size()].elevation - mean_);
  const double correlation = std::clamp(product / count / (spread_ * spread_), 0.0, 1.0);
  std::vector<double> change;
  double mean_change = 0;
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const double before = rays_[(i + rays_.size() - 1) % rays_.size()].elevation;
    change.push_back(std::abs(rays_[i].elevation - mean_ - correlation * (before - mean_)));
    mean_change += change.back() / count;
  }
  mean_change = std::max(mean_change, elevation_sd_);
  for (const double c : change)
    arbitrary_.push_back(std::exp(-std::min(c / mean_change, kMaxChange)) / (2 * mean_change));
}

bool SeenHorizon::is_usable() const {
  return static_cast<double>(rays_.size()) * spacing_ >= kMinCover && spread_ >= kMinSpread;
}

std::vector<HorizonGuess> best_headings(std::span<const HorizonViewpoint> viewpoints, const SeenHorizon& seen,
                                        std::size_t max_count, const SkylineOptions& options) {
  std::vector<std::vector<HorizonGuess>> all(viewpoints.size());
  tbb::parallel_for(std::size_t{0}, viewpoints.size(), [&](std::size_t i) {
    all[i] = profile_headings_at(viewpoints[i], seen, max_count, options);
  });
  std::vector<HorizonGuess> guesses;
  for (const auto& some : all) guesses.insert(guesses.end(), some.begin(), some.end());
  return guesses;
}

std::optional<SkylineFix> fit_profile(const SkylineScene& scene, const SeenHorizon& seen,
                                      const HorizonGuess& guess, double place) {
  return ProfileFit(scene, seen).find(guess, place);
}

}  // namespace waymark::localization
