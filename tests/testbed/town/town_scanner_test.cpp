// SPDX-License-Identifier: Apache-2.0
#include "testbed/town/town_scanner.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "localization/detectors/cloud_curbs.hpp"
#include "localization/detectors/cloud_facades.hpp"
#include "localization/detectors/cloud_signs.hpp"

namespace waymark::test {
using namespace testbed;
namespace {

TEST(TownScanner, PointsLieOnWhatStandsThere) {
  const Town town = plan_street({}, 3, 3);
  Random random(1);
  const ScannerModel scanner{.range_sd = 0, .dropouts = 0};
  const localization::Pose2 robot{0, -1.2, 0.3};
  const localization::PointCloud cloud = turn_of_scanner(town, robot, 0, scanner, random);
  ASSERT_EQ(cloud.intensities.size(), cloud.points.size());
  std::size_t ground = 0;
  for (const Eigen::Vector3f& p : cloud.points) {
    const Eigen::Vector2d at =
        (robot * localization::Pose2{static_cast<double>(p.x()), static_cast<double>(p.y()), 0}).at();
    const double z = static_cast<double>(p.z()) + scanner.height;
    const Eigen::Vector2d nearer(at.x(), at.y() - std::copysign(1e-3, at.y()));  // the foot of a kerb's face
    ground += std::abs(z - town.ground(at)) < 1e-3;
    ASSERT_GT(z, town.ground(nearer) - 1e-3) << at.transpose();
    ASSERT_LT(z, 9);
  }
  EXPECT_GT(ground, cloud.points.size() / 5);
  Random same(1);
  EXPECT_EQ(kitti_bytes(cloud), kitti_bytes(turn_of_scanner(town, robot, 0, scanner, same)));
  EXPECT_EQ(kitti_bytes(cloud).size(), 16 * cloud.points.size());
}

struct DetectionCounts {
  int truth = 0, seen = 0;   // listed near the robot, and those of them that are found
  int found = 0, wrong = 0;  // detections at any range
  double squares = 0;
};

// Seeds 101 to 106 were not looked at when the detectors were made.
TEST(TownScanner, FacadesSignsAndKerbsOfMadeStreetsAreFound) {
  DetectionCounts facades, signs, curbs;
  for (std::uint64_t seed = 101; seed <= 106; ++seed) {
    const Town town = plan_street({}, seed, seed);
    for (const double x : {-40.0, 0.0, 40.0}) {
      Random random(seed);
      const localization::Pose2 robot{x, -1.2, 0};
      const localization::PointCloud cloud = turn_of_scanner(town, robot, 0, {}, random);
      const auto in_map = [&](const Eigen::Vector2d& at) { return Eigen::Vector2d(at + robot.at()); };
      const auto planes = localization::find_facades(cloud, {.max_count = 100});
      for (const auto& f : planes) {
        const Eigen::Vector2d at = in_map(f.centre);
        double off = 1e9;
        for (const TownWall& wall : town.walls) {
          const Eigen::Vector2d run = (wall.to - wall.from).normalized(), normal(-run.y(), run.x());
          const double s = run.dot(at - wall.from);
          if (wall.top > 5 && std::abs(run.dot(f.normal)) < 0.05 && s > 0 && s < (wall.to - wall.from).norm())
            off = std::min(off, std::abs(normal.dot(at - wall.from)));
        }
        if (off < 0.2) {
          ++facades.found;
          facades.squares += off * off;
        } else {
          ++facades.wrong;
        }
      }
      for (const TownLandmark& l : town.landmarks) {
        if (l.type != "wall" || std::abs(l.at.x() - x) > 12) continue;
        ++facades.truth;
        facades.seen += std::ranges::any_of(planes, [&](auto& f) {
          const Eigen::Vector2d off = in_map(f.centre) - l.at;
          return std::abs(off.y()) < 0.2 && std::abs(off.x()) < *l.length / 2;
        });
      }
      const auto found = localization::find_signs(cloud);
      for (const auto& s : found) {
        const auto near = std::ranges::find_if(town.landmarks, [&](const TownLandmark& l) {
          return l.type == "traffic_sign" && (l.at - in_map(s.at)).norm() < 0.3;
        });
        if (near == town.landmarks.end()) {
          ++signs.wrong;
        } else {
          ++signs.found;
          signs.squares += (near->at - in_map(s.at)).squaredNorm();
          EXPECT_NEAR(s.height, *near->height, 3 * s.height_sd);
        }
      }
      // Of those that face the robot within 15 m.
      for (const TownLandmark& l : town.landmarks) {
        if (l.type != "traffic_sign") continue;
        const Eigen::Vector2d to = robot.at() - l.at, face(std::sin(*l.facing), std::cos(*l.facing));
        if (!(to.norm() < 15 && face.dot(to) > 0.3 * to.norm())) continue;
        ++signs.truth;
        signs.seen += std::ranges::any_of(found, [&](auto& s) { return (in_map(s.at) - l.at).norm() < 0.3; });
      }
      bool north = false, south = false;
      for (const auto& c : localization::find_curbs(cloud)) {
        const double off = std::abs(std::abs(in_map(c.centre).y()) - town.kerb);
        if (off < 0.2 && std::abs(c.normal.x()) < 0.1) {
          ++curbs.found, (c.normal.y() < 0 ? north : south) = true;
          curbs.squares += off * off;
        } else {
          ++curbs.wrong;
        }
      }
      curbs.truth += 2, curbs.seen += north + south;
    }
  }
  const auto rms = [](const DetectionCounts& c) { return std::sqrt(c.squares / std::max(1, c.found)); };
  for (const auto& [name, c] :
       {std::pair("facades", facades), std::pair("signs", signs), std::pair("curbs", curbs)})
    std::printf("%s: %d of %d seen, %d right, %d wrong, %.3f m\n", name, c.seen, c.truth, c.found, c.wrong,
                rms(c));
  EXPECT_GE(facades.seen, 0.9 * facades.truth);
  EXPECT_LE(facades.wrong, 0.1 * facades.found);
  EXPECT_LT(rms(facades), 0.08);
  EXPECT_GE(signs.seen, 0.8 * signs.truth);
  EXPECT_LE(signs.wrong, 0.05 * signs.found);
  EXPECT_LT(rms(signs), 0.15);
  EXPECT_GE(curbs.seen, 0.7 * curbs.truth);  // parked cars hide the rest
  EXPECT_LE(curbs.wrong, 0.1 * curbs.found);
  EXPECT_LT(rms(curbs), 0.08);
}

}  // namespace
}  // namespace waymark::test
