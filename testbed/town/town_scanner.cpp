// SPDX-License-Identifier: Apache-2.0
#include "testbed/town/town_scanner.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "core/units.hpp"

namespace waymark::testbed {
namespace {

constexpr double kPane = 3, kStorey = 2.8;  // m between windows
constexpr double kRecess = 0.15;            // m of a window behind its facade
constexpr double kGlassLost = 0.4;          // of the beams on glass
constexpr double kLeafPath = 1.2;           // m, mean path of a beam in a crown
constexpr double kGlossAngle = 3 * kRadiansPerDegree;

bool is_window(const TownHit& hit, double z) {
  const double across = std::fmod(hit.along_wall, kPane), up = std::fmod(z, kStorey);
  return hit.has_windows && across > 0.9 && across < 2.1 && up > 0.9 && up < 2.2;
}

/// One column of a turn.
class Column {
 public:
  Column(const Town& town, const Eigen::Vector2d& from, const Eigen::Vector2d& along, double t,
         const ScannerModel& scanner)
      : town_(town), from_(from), along_(along), height_(scanner.height + town.ground(from)) {
    town.visit_hits(from, along, t, [&](const TownHit& hit) {
      if (hit.range < scanner.max_range) hits_.push_back(hit);
    });
    std::ranges::sort(hits_, {}, &TownHit::range);
    for (const TownCrown& crown : town.crowns) {
      const Eigen::Vector2d off = crown.at.head<2>() - from;
      if (std::abs(along.x() * off.y() - along.y() * off.x()) < crown.radius && off.dot(along) > 0)
        crowns_.push_back(&crown);
    }
  }

  /// Returns the first return of a beam by its level range; no surface: none.
  TownHit beam(double elevation, Random& random) const {
    const double slope = std::tan(elevation);
    TownHit first = ground(slope);
    for (const TownHit& hit : hits_) {
      if (hit.range >= first.range) break;
      const double z = height_ + hit.range * slope;
      if (!(z >= hit.bottom && z <= hit.top)) continue;
      first = hit;
      if (is_window(hit, z)) {
        first.range += kRecess / std::max(0.1, hit.cosine);
        if (random.bernoulli(kGlassLost)) first.surface = nullptr;
      }
      break;
    }
    for (const TownCrown* const crown : crowns_) {
      const Eigen::Vector3d off(crown->at.x() - from_.x(), crown->at.y() - from_.y(),
                                crown->at.z() - height_);
      const Eigen::Vector3d ray(std::cos(elevation) * along_.x(), std::cos(elevation) * along_.y(),
                                std::sin(elevation));
      const double middle = off.dot(ray),
                   square = crown->radius * crown->radius - off.squaredNorm() + middle * middle;
      if (!(square > 0)) continue;
      const double depth = -kLeafPath * std::log(1 - random.uniform()), chord = 2 * std::sqrt(square);
      const double range = (middle - chord / 2 + depth) * std::cos(elevation);
      if (depth < chord && range > 0 && range < first.range)
        first = {.range = range, .cosine = 0.7, .surface = &leaves_};
    }
    return first;
  }

 private:
  TownHit ground(double slope) const {
    TownHit first{.range = 1e9};
    if (!(slope < 0)) return first;
    for (const double level : {0.0, town_.kerb_south, town_.kerb_north}) {
      const double range = (height_ - level) / -slope;
      if (range < first.range && town_.ground(from_ + range * along_) == level)
        first = {.range = range, .cosine = std::sin(std::atan(-slope)), .surface = &road_};
    }
    return first;
  }

  const Town& town_;
  Eigen::Vector2d from_, along_;
  double height_;
  std::vector<TownHit> hits_;
  std::vector<const TownCrown*> crowns_;
  TownSurface road_{.reflectivity = 0.2}, leaves_{.reflectivity = 0.35};
};

}  // namespace

float strength_of(const TownHit& hit, Random& random) {
  constexpr double kBack = 0.3;  // reflectivity of the back of a sign
  const TownSurface& s = *hit.surface;
  const double angle = std::acos(std::clamp(hit.cosine, 0.0, 1.0)) / kGlossAngle;
  const double dull = s.retro ? kBack : s.reflectivity;
  const double strength =
      s.retro && hit.is_front ? s.reflectivity : dull * hit.cosine + s.gloss * std::exp(-angle * angle);
  return static_cast<float>(std::clamp(strength + random.normal(0, 0.02), 0.001, 1.0));
}

localization::PointCloud turn_of_scanner(const Town& town, const localization::Pose2& robot, double t,
                                         const ScannerModel& scanner, Random& random) {
  localization::PointCloud cloud;
  const double step = to_radians(scanner.step).value;
  const auto columns = static_cast<int>(std::floor(2 * std::numbers::pi / step + 1e-9));
  const double low = to_radians(scanner.lowest).value, high = to_radians(scanner.highest).value;
  for (int c = 0; c < columns; ++c) {
    const double azimuth = c * step - std::numbers::pi, map = azimuth + robot.yaw;
    const Column column(town, robot.at(), {std::cos(map), std::sin(map)}, t, scanner);
    for (std::int64_t row = 0; row < scanner.rows; ++row) {
      const double elevation =
          low + (high - low) * static_cast<double>(row) / static_cast<double>(scanner.rows - 1);
      const TownHit hit = column.beam(elevation, random);
      const double noise = random.normal(0, scanner.range_sd);
      const bool lost = random.bernoulli(scanner.dropouts);
      const double range = hit.range / std::cos(elevation) + noise;
      if (!hit.surface || lost || !(range > 0.3 && range < scanner.max_range)) continue;
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      cloud.points.push_back((range * ray).cast<float>());
      cloud.intensities.push_back(strength_of(hit, random));
    }
  }
  if (!scanner.intensities) cloud.intensities.clear();
  return cloud;
}

std::string kitti_bytes(const localization::PointCloud& cloud) {
  static_assert(std::endian::native == std::endian::little);
  std::string bytes;
  bytes.reserve(16 * cloud.points.size());
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const float intensity = cloud.intensities.empty() ? 0 : cloud.intensities[i];
    const float values[4] = {cloud.points[i].x(), cloud.points[i].y(), cloud.points[i].z(), intensity};
    bytes.append(reinterpret_cast<const char*>(values), sizeof values);
  }
  return bytes;
}

}  // namespace waymark::testbed
