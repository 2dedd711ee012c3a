// SPDX-License-Identifier: Apache-2.0
// Recall and precision of rover detectors against the truth of the testbed.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include "localization/detectors/depth_rocks.hpp"
#include "localization/detectors/horizon_summits.hpp"
#include "localization/detectors/laser_rocks.hpp"
#include "testbed/drive/laser_scanner.hpp"
#include "testbed/drive/panorama.hpp"
#include "testbed/drive/stereo_camera.hpp"
#include "testbed/scene.hpp"

namespace waymark::test {
using namespace testbed;
namespace {

Scene rocky(std::uint64_t seed) {
  SiteModel ground;
  ground.width = ground.height = 100;
  ground.cell = 0.4;
  ground.relief = {.rms = 0.4, .longest = 60, .roughness = 0.5};
  ground.craters.density = 0;
  ground.craters.clusters = 0;
  ground.rocks = {.k = 0.14, .min_diameter = 0.5, .max_diameter = 3};
  ground.dunes.cover = 0;
  return make_scene(ground, seed);
}

struct Tally {
  int found = 0, right = 0;        // of what was found
  int in_view = 0, recovered = 0;  // of what could be seen
  double precision() const { return double(right) / std::max(1, found); }
  double recall() const { return double(recovered) / std::max(1, in_view); }
};

/// `count[i]`: how many rays of the sensor meet rock i first; from `least` on it can be seen.
void tally(const Scene& scene, const std::vector<Eigen::Vector2d>& found,
           const std::map<std::uint32_t, int>& count, int least, double slack, Tally& sum) {
  const auto from = [&](const TrueRock& r, const Eigen::Vector2d& at) {
    return (r.position.head<2>() - at).norm() - 0.3 * r.width;
  };
  for (const Eigen::Vector2d& at : found) {
    double nearest = 1e9;
    for (const TrueRock& r : scene.rocks) nearest = std::min(nearest, from(r, at));
    ++sum.found;
    sum.right += nearest < slack;
  }
  for (const auto& [rock, rays] : count) {
    if (rays < least) continue;
    ++sum.in_view;
    for (const Eigen::Vector2d& at : found)
      if (from(scene.rocks[rock], at) < slack) {
        ++sum.recovered;
        break;
      }
  }
}

template <class Seen>
std::vector<Eigen::Vector2d> places(const std::vector<Seen>& seen, const Eigen::Vector3d& eye) {
  std::vector<Eigen::Vector2d> all;
  for (const Seen& rock : seen)
    all.emplace_back(eye.head<2>() +
                     rock.range * Eigen::Vector2d(std::cos(rock.bearing), std::sin(rock.bearing)));
  return all;
}

/// Of all rays of a scan held level, those that meet rocks within `reach` metres.
std::map<std::uint32_t, int> rocks_in_scan(const RayFan& fan, const localization::LaserScan& scan,
                                           double reach) {
  std::map<std::uint32_t, int> count;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const double a = scan.first_angle + double(i) * scan.angle_step;
    const auto hit = fan.cast({std::cos(a), std::sin(a), 0});
    if (hit && hit->kind == TargetKind::rock && hit->range < reach) ++count[hit->index];
  }
  return count;
}

std::map<std::uint32_t, int> rocks_in_image(const RayFan& fan, const localization::DepthImage& image,
                                            const Scene& scene, double reach) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(image.tilt, Eigen::Vector3d::UnitY()).toRotationMatrix();
  std::map<std::uint32_t, int> count;
  for (std::int64_t r = 0; r < image.rows; ++r)
    for (std::int64_t c = 0; c < image.columns; ++c) {
      const auto hit = fan.cast(turn * image.ray(c, r).normalized());
      if (hit && hit->kind == TargetKind::rock && hit->range < reach && scene.rocks[hit->index].height > 0.3)
        ++count[hit->index];
    }
  return count;
}

TEST(LaserRocks, MostOfWhatIsFoundIsThereAndFewAreMissed) {
  Tally sum;
  for (const std::uint64_t seed : {8, 108, 208}) {
    const Scene scene = rocky(seed);
    const LaserTargets targets(scene.terrain, scene.solids);
    Random random(3);
    for (int k = 0; k < 25; ++k) {
      const double x = random.uniform(-25, 25), y = random.uniform(-25, 25);
      const Eigen::Vector3d eye(x, y, *scene.terrain.height(x, y) + 0.35);
      const RayFan fan(targets, eye, 25);
      const localization::LaserScan scan =
          sweep(fan, Eigen::Matrix3d::Identity(), {.field = Degrees{359}}, random);
      tally(scene, places(localization::find_rocks(scan, {}), eye), rocks_in_scan(fan, scan, 24), 5, 0.4,
            sum);
    }
  }
  std::printf("laser: %d of %d found are there, %d of %d met by 5 beams and more are found\n", sum.right,
              sum.found, sum.recovered, sum.in_view);
  EXPECT_GT(sum.found, 300);
  EXPECT_GE(sum.precision(), 0.95);
  EXPECT_GE(sum.recall(), 0.7);
}

TEST(DepthRocks, MostOfWhatIsFoundIsThereAndFewAreMissed) {
  Tally sum;
  for (const std::uint64_t seed : {8, 108, 208}) {
    const Scene scene = rocky(seed);
    const LaserTargets targets(scene.terrain, scene.solids);
    Random random(4);
    for (int k = 0; k < 12; ++k) {
      const double x = random.uniform(-25, 25), y = random.uniform(-25, 25);
      const Eigen::Vector3d eye(x, y, *scene.terrain.height(x, y) + 1.5);
      const RayFan fan(targets, eye, 18);
      const localization::DepthImage image = depth_image(fan, Eigen::Matrix3d::Identity(), {}, random);
      tally(scene, places(localization::find_rocks(image, {}), eye), rocks_in_image(fan, image, scene, 14),
            12, 0.5, sum);
    }
  }
  std::printf("depth: %d of %d found are there, %d of %d of 12 pixels and more are found\n", sum.right,
              sum.found, sum.recovered, sum.in_view);
  EXPECT_GT(sum.found, 60);
  EXPECT_GE(sum.precision(), 0.95);
  EXPECT_GE(sum.recall(), 0.75);
}

// A plain with cones: which of them stand out of the horizon is known from the cones alone.
TEST(HorizonSummits, OfConesMostOfWhatIsFoundIsThereAndFewAreMissed) {
  int found = 0, right = 0, in_view = 0, recovered = 0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Random random(seed, "cones");
    std::vector<Eigen::Vector3d> cones;  // place and height
    for (int i = 0; i < 12; ++i)
      cones.emplace_back(random.uniform(-900, 900), random.uniform(-900, 900), random.uniform(25, 90));
    const auto height = [&](double x, double y) {
      double most = 0;
      for (const Eigen::Vector3d& c : cones)
        most = std::max(most, c.z() - 0.5 * (c.head<2>() - Eigen::Vector2d(x, y)).norm());
      return most;
    };
    Grid<float> heights(201, 201);
    for (std::int64_t r = 0; r < 201; ++r)
      for (std::int64_t c = 0; c < 201; ++c)
        heights(c, r) = static_cast<float>(height(-1000 + 10 * double(c), 1000 - 10 * double(r)));
    const Terrain terrain(std::move(heights), -1000, 1000, 10, 10);
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector2d at(random.uniform(-500, 500), random.uniform(-500, 500));
      const Eigen::Vector3d eye(at.x(), at.y(), *terrain.height(at.x(), at.y()) + 1.5);
      const PanoramaModel model;
      const std::vector<double> seen = horizon(terrain, eye, 0, model, random);
      localization::HorizonProfile profile{.first_angle = -std::numbers::pi,
                                           .angle_step = to_radians(model.step).value,
                                           .elevations = {seen.begin(), seen.end()}};
      profile.elevation_sd = to_radians(model.elevation_sd).value;
      const auto summits = localization::find_summits(profile, {});
      found += int(summits.size());
      for (const Eigen::Vector3d& c : cones) {
        const Eigen::Vector2d to = c.head<2>() - at;
        if (to.norm() < 100 || c.z() < eye.z() + 0.03 * to.norm())
          continue;  // not above the plain by 1.7 degrees
        // Seen and not merged: its top is higher than all that stands within 6 degrees of it.
        const double elevation = std::atan2(c.z() - eye.z(), to.norm());
        bool free = true;
        for (const Eigen::Vector3d& o : cones) {
          const Eigen::Vector2d other = o.head<2>() - at;
          const double aside = std::abs(
              localization::wrap_angle(std::atan2(other.y(), other.x()) - std::atan2(to.y(), to.x())));
          const double wide = std::atan2(o.z() / 0.5, other.norm());
          free = free && (&o == &c || aside > wide + 0.1 ||
                          std::atan2(o.z() - eye.z(), other.norm()) < elevation - 0.1);
        }
        const bool hit = std::ranges::any_of(summits, [&](const localization::DetectedSummit& s) {
          return std::abs(localization::wrap_angle(s.bearing - std::atan2(to.y(), to.x()))) < 0.03;
        });
        in_view += free;
        recovered += free && hit;
      }
      for (const localization::DetectedSummit& s : summits)
        right += std::ranges::any_of(cones, [&](const Eigen::Vector3d& c) {
          const Eigen::Vector2d to = c.head<2>() - at;
          return std::abs(localization::wrap_angle(s.bearing - std::atan2(to.y(), to.x()))) < 0.03;
        });
    }
  }
  std::printf("summits: %d of %d found are there, %d of %d that stand free are found\n", right, found,
              recovered, in_view);
  EXPECT_GT(found, 20);
  EXPECT_GE(right, 0.9 * found);
  EXPECT_GE(recovered, 0.8 * in_view);
  EXPECT_GT(in_view, 15);
}

TEST(HorizonSummits, StandOutOfBothSides) {
  localization::HorizonProfile horizon{.first_angle = -std::numbers::pi,
                                       .angle_step = 2 * std::numbers::pi / 360,
                                       .elevations = std::vector<float>(360, 0.01F)};
  for (int k = -20; k <= 20; ++k)
    horizon.elevations[static_cast<std::size_t>(200 + k)] += 0.002F * float(20 - std::abs(k));
  horizon.elevations[300] += 0.004F;  // too low to count
  for (int k = -3; k <= 3; ++k)       // across the seam
    horizon.elevations[static_cast<std::size_t>((360 + k) % 360)] += 0.01F * float(4 - std::abs(k));
  const auto summits = localization::find_summits(horizon, {});
  ASSERT_EQ(summits.size(), 2u);
  EXPECT_NEAR(summits[0].bearing, 200 * horizon.angle_step - std::numbers::pi, 1e-3);
  EXPECT_NEAR(std::abs(summits[1].bearing), std::numbers::pi, 1e-3);
  EXPECT_NEAR(summits[1].prominence, 0.04, 1e-6);
}

}  // namespace
}  // namespace waymark::test
