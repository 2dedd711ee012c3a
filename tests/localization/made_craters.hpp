// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <numbers>

#include "core/random.hpp"
#include "localization/craters/crater_index.hpp"
namespace waymark::test {

/// Craters of a whole body: cumulative counts fall with the square of the diameter, as of a production
/// function, and a seventh are in clusters about larger ones, as secondaries are.
inline std::vector<localization::BodyCrater> made_craters(std::size_t count, double min_radius,
                                                          const Body& body, std::uint64_t seed) {
  Random random(seed, "craters of a body");
  const localization::BodySurface surface(body);
  std::vector<localization::BodyCrater> craters;
  const auto direction = [&] {
    return Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized();
  };
  while (craters.size() < count) {
    localization::BodyCrater c;
    c.radius = min_radius / std::sqrt(random.uniform(1e-6, 1));
    if (c.radius > 150e3) continue;
    c.at = surface.nearest(direction());
    if (!craters.empty() && random.bernoulli(1.0 / 7)) {
      const localization::BodyCrater& large = craters[random.uniform_index(craters.size())];
      if (large.radius < 2 * c.radius) continue;
      c.at = surface.nearest(large.at + large.radius * random.uniform(1.5, 5) * direction());
    }
    craters.push_back(c);
  }
  return craters;
}

/// How craters are detected. Errors are drawn from the standard deviations.
struct CraterSensor {
  double focal = 1500, side = 1024;  ///< px; focal 0: an orthophoto
  double min_radius = 5;             ///< px
  double detected = 0.7, false_fraction = 0.25;
  double position_sd = 1, position_error = 0.05, radius_error = 0.1;
  double outliers = 0.05;  ///< of the detections, with four times these errors
  double tilt_sd = 1;      ///< degrees
};

struct MadeCraterImage {
  std::vector<localization::ImageCrater> craters;
  std::vector<int> truth;  ///< index into the craters of the body, -1: false
  localization::ImagePose pose;
};

/// Simulates the detections in an image of a body.
inline MadeCraterImage look_down(const std::vector<localization::BodyCrater>& craters, const Body& body,
                                 const localization::ImagePose& pose, const CraterSensor& how,
                                 Random& random) {
  const localization::BodySurface surface(body);
  const localization::GroundCamera camera(how.focal);
  MadeCraterImage image{.craters = {}, .truth = {}, .pose = pose};
  const double reach = 1.5 * how.side * std::exp(pose.log_scale);
  for (std::size_t i = 0; i < craters.size(); ++i) {
    if ((craters[i].at - pose.ground).squaredNorm() > reach * reach) continue;
    const auto at = camera.project(pose, craters[i].at, surface.up(craters[i].at));
    if (!at || (at->at.cwiseAbs().array() > how.side / 2).any()) continue;
    const double radius = craters[i].radius * at->pixels_per_metre;
    if (radius < how.min_radius || radius > how.side / 3 || !random.bernoulli(how.detected)) continue;
    const double worse = random.bernoulli(how.outliers) ? 4 : 1;
    const double sd = worse * std::hypot(how.position_sd, how.position_error * radius);
    image.craters.push_back({at->at + sd * Eigen::Vector2d(random.normal(), random.normal()),
                             radius * std::exp(worse * how.radius_error * random.normal())});
    image.truth.push_back(static_cast<int>(i));
  }
  const double per_true = how.false_fraction / (1 - how.false_fraction);
  const std::size_t real = image.truth.size();
  for (std::uint64_t k = random.poisson(per_true * static_cast<double>(real)); k > 0 && real > 0; --k) {
    image.craters.push_back({how.side * Eigen::Vector2d(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)),
                             image.craters[random.uniform_index(real)].radius});
    image.truth.push_back(-1);
  }
  return image;
}

/// Draws a pose anywhere on the body, at an orientation and tilt.
inline localization::ImagePose anywhere(const Body& body, double metres_per_pixel, const CraterSensor& how,
                                        Random& random) {
  const localization::BodySurface surface(body);
  auto pose =
      localization::image_pose(surface, Eigen::Vector3d(random.normal(), random.normal(), random.normal()),
                               metres_per_pixel, random.uniform(-std::numbers::pi, std::numbers::pi));
  if (how.focal > 0)
    pose.tilt = how.tilt_sd * std::numbers::pi / 180 * Eigen::Vector2d(random.normal(), random.normal());
  return pose;
}

/// Errors of a map: it lacks some craters, and errs in positions and radii.
inline std::vector<localization::BodyCrater> surveyed(const std::vector<localization::BodyCrater>& craters,
                                                      const Body& body, Random& random) {
  const localization::BodySurface surface(body);
  std::vector<localization::BodyCrater> map;
  for (localization::BodyCrater c : craters) {
    if (random.bernoulli(0.15)) continue;
    c.sd = 0.03 * c.radius;
    c.at = surface.nearest(c.at + c.sd * Eigen::Vector3d(random.normal(), random.normal(), random.normal()));
    c.radius *= std::exp(0.05 * random.normal());
    map.push_back(c);
  }
  return map;
}

}  // namespace waymark::test
