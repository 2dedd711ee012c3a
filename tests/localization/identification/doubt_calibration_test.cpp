// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/doubt_calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::test {
using namespace localization;
namespace {

constexpr double kDoubtful = 0.2, kViewRange = 15, kHalfView = 1.5;

/// A map of doubtful landmarks of type 0 where every `period`-th exists, seen from poses in its middle.
class DoubtfulWorld {
 public:
  DoubtfulWorld(int period, double confidence = kDoubtful) : period_(period) {
    std::vector<MapLandmark> map = scatter_landmarks(900, 60, 3);
    for (MapLandmark& l : map) l.quality = confidence;
    map_ = LandmarkGrid(std::move(map));
  }
  LandmarkGrid& map() { return map_; }

  /// Returns the factor after 200 sets of a sensor that sees `detection` of what exists, and one other object
  /// in two sets.
  double factor(double detection = 0.5, double position_sd = 0.05) {
    const PoseEstimate about{{}, Eigen::Vector3d(position_sd, position_sd, 0.01).cwiseAbs2().asDiagonal()};
    DoubtCalibration doubt;
    for (int set = 0; set < 200; ++set) {
      PoseEstimate robot = about;
      robot.pose = {random_.uniform(-20, 20), random_.uniform(-20, 20), random_.uniform(-3, 3)};
      std::vector<LandmarkKey> shown;
      const SightingSet seen = look(robot.pose, detection, shown);
      doubt.add(seen, shown, robot, map_, view(detection));
    }
    return doubt.factors().empty() ? 1 : doubt.factors()[0];
  }

 private:
  static DoubtCalibration::View view(double detection) {
    return {.range = kViewRange,
            .bearing = kHalfView,
            .detection = detection,
            .clutter = 0.5 / (2 * kHalfView * kViewRange)};
  }
  SightingSet look(const Pose2& robot, double detection, std::vector<LandmarkKey>& shown) {
    SightingSet seen;
    for (const MapLandmark& l : map_.landmarks()) {
      const Eigen::Vector2d to = l.at - robot.at();
      const double bearing = wrap_angle(std::atan2(to.y(), to.x()) - robot.yaw);
      if (l.key % static_cast<LandmarkKey>(period_) != 0 || to.norm() > kViewRange ||
          std::abs(bearing) > kHalfView)
        continue;
      if (!random_.bernoulli(detection)) continue;
      seen.sightings.push_back(
          seen_at(to.norm() + 0.05 * random_.normal(), bearing + 0.01 * random_.normal()));
      shown.push_back(random_.bernoulli(0.5) ? l.key : 0);
    }
    if (random_.bernoulli(0.5)) return seen;
    seen.sightings.push_back(seen_at(random_.uniform(1, kViewRange), random_.uniform(-kHalfView, kHalfView)));
    shown.push_back(0);
    return seen;
  }

  int period_;
  LandmarkGrid map_;
  Random random_{5, "doubtful world"};
};

TEST(DoubtCalibration, ComparesHowManyExistWithTheirConfidences) {
  EXPECT_GT(DoubtfulWorld(5).factor(), 0.9);
  EXPECT_NEAR(DoubtfulWorld(10).factor(), 0.5, 0.1);
  EXPECT_NEAR(DoubtfulWorld(20).factor(), 0.25, 0.1);
  EXPECT_LT(DoubtfulWorld(1'000'000).factor(), 0.1);
}

TEST(DoubtCalibration, DoesNotDependOnTheRateOfDetection) {
  for (const double detection : {0.2, 0.5, 1.0})
    EXPECT_NEAR(DoubtfulWorld(10).factor(detection), 0.5, 0.15) << detection;
}

TEST(DoubtCalibration, NeverRaisesAConfidence) {
  EXPECT_EQ(DoubtfulWorld(1).factor(), 1);
}

TEST(DoubtCalibration, LearnsNothingFromUncertainPoses) {
  EXPECT_EQ(DoubtfulWorld(1'000'000).factor(0.5, 5), 1);
}

TEST(DoubtCalibration, LearnsNothingOfLikelyLandmarks) {
  EXPECT_EQ(DoubtfulWorld(1'000'000, 0.6).factor(), 1);
}

}  // namespace
}  // namespace waymark::test
