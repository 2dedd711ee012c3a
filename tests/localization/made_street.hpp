// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "localization/laser_scan.hpp"
namespace waymark::test {

/// An upright rectangle; heights above the road, m.
struct MadePlate {
  Eigen::Vector2d from, to;
  double bottom, top;
  float intensity = 0.3F;
};

/// Ground with a kerb along y = `kerb`, and rectangles.
struct MadeStreet {
  std::vector<MadePlate> plates;
  double kerb = 1e9, step = 0;
  double hedge_depth = 0;  ///< m behind each plate by which beams may end: leaves
};

/// Scans a street by 64 rows from -24.8 to `highest` degrees, 0.2 degrees between columns, 2 cm of noise, 1.8
/// m above the road.
inline localization::PointCloud scan_street(const MadeStreet& street, unsigned seed, double highest = 2) {
  constexpr double kHeight = 1.8, kDegree = std::numbers::pi / 180;
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 0.02);
  std::uniform_real_distribution<double> any(0, 1);
  std::vector<MadePlate> plates = street.plates;
  if (street.kerb < 1e9) plates.push_back({{-100, street.kerb}, {100, street.kerb}, 0, street.step});
  localization::PointCloud cloud;
  for (int row = 0; row < 64; ++row)
    for (int column = 0; column < 1800; ++column) {
      const double up = (-24.8 + row * (highest + 24.8) / 63) * kDegree, around = column * 0.2 * kDegree;
      const Eigen::Vector2d along(std::cos(around), std::sin(around));
      double range = std::numeric_limits<double>::infinity();
      float intensity = 0.2F;
      for (const double level : {0.0, street.step}) {
        const double hit = up < 0 ? (kHeight - level) / -std::tan(up) : -1;
        if (hit > 0 && hit < range && (hit * along.y() > street.kerb) == (level > 0)) range = hit;
      }
      for (const MadePlate& plate : plates) {
        const Eigen::Vector2d run = plate.to - plate.from;
        const double area = along.x() * run.y() - along.y() * run.x();
        if (std::abs(area) < 1e-9) continue;
        const double hit = (plate.from.x() * run.y() - plate.from.y() * run.x()) / area,
                     part = (plate.from.x() * along.y() - plate.from.y() * along.x()) / area;
        const double z = kHeight + hit * std::tan(up);
        if (hit > 0 && hit < range && part >= 0 && part <= 1 && z >= plate.bottom && z <= plate.top)
          range = hit + street.hedge_depth * any(random), intensity = plate.intensity;
      }
      if (!(range < 80)) continue;
      const double measured = range / std::cos(up) + noise(random);
      cloud.points.push_back(
          (measured * Eigen::Vector3d(std::cos(up) * along.x(), std::cos(up) * along.y(), std::sin(up)))
              .cast<float>());
      cloud.intensities.push_back(intensity);
    }
  return cloud;
}

/// Returns a cloud in another order of its points.
inline localization::PointCloud shuffled(localization::PointCloud cloud, unsigned seed) {
  std::mt19937 random(seed);
  for (std::size_t i = cloud.points.size(); i > 1; --i) {
    const std::size_t j = random() % i;
    std::swap(cloud.points[i - 1], cloud.points[j]);
    if (!cloud.intensities.empty()) std::swap(cloud.intensities[i - 1], cloud.intensities[j]);
  }
  return cloud;
}

/// Returns a cloud turned about the vertical, after mirroring left and right if `mirrored`.
inline localization::PointCloud turned(localization::PointCloud cloud, double angle, bool mirrored = false) {
  const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
  for (Eigen::Vector3f& p : cloud.points) {
    const float y = mirrored ? -p.y() : p.y();
    p = {c * p.x() - s * y, s * p.x() + c * y, p.z()};
  }
  return cloud;
}
inline Eigen::Vector2d turned(const Eigen::Vector2d& p, double angle, bool mirrored = false) {
  const double y = mirrored ? -p.y() : p.y();
  return {std::cos(angle) * p.x() - std::sin(angle) * y, std::sin(angle) * p.x() + std::cos(angle) * y};
}

/// Clouds in which there is nothing to detect.
inline std::vector<localization::PointCloud> bad_clouds() {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  std::vector<localization::PointCloud> clouds(4);
  clouds[1].points = {{nan, 0, 0}, {inf, inf, inf}, {5, 5, nan}, {1e30F, -1e30F, 0}};
  clouds[1].intensities = {1, 1, nan, inf};
  clouds[2] = scan_street({}, 1);  // ground
  for (int i = 0; i < 1000; ++i)
    clouds[3].points.emplace_back(5, 0.01F * static_cast<float>(i), 0);  // one line
  return clouds;
}

}  // namespace waymark::test
