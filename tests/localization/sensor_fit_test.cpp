// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor_fit.hpp"

#include <gtest/gtest.h>

#include "core/error.hpp"
#include "made_world.hpp"

namespace waymark::test {
using namespace localization;
namespace {

// A sensor of 15 m and 120 degrees, of known noise, that finds a landmark by known odds of range and
// diameter.
TEST(SensorFit, FindsTheSensorThatMadeTheSightings) {
  const DetectionOdds odds{2, -0.2, 1.5};
  Random random(5, "sensor");
  std::vector<MapLandmark> map = scatter_landmarks(400, 120, 3, 0.05);
  for (MapLandmark& l : map) l.diameter = random.uniform(0.2, 2);
  const LandmarkGrid grid(map);
  std::vector<SightingsAtTruth> sets;
  for (int i = 0; i < 600; ++i) {
    SightingsAtTruth set{.robot = {random.uniform(-40, 40), random.uniform(-40, 40), random.uniform(-3, 3)},
                         .seen = {}};
    for (const MapLandmark& l : grid.landmarks()) {
      const Eigen::Vector2d to = l.at - set.robot.at();
      const double range = to.norm(), bearing = wrap_angle(std::atan2(to.y(), to.x()) - set.robot.yaw);
      if (range > 15 || range < 1 || std::abs(bearing) > 60 * 3.14159265 / 180) continue;
      const double p = 1 / (1 + std::exp(-(odds.intercept + odds.per_metre * range +
                                           odds.per_log_diameter * std::log(l.diameter))));
      if (random.uniform() > p) continue;
      SeenLandmark s = seen_at(range + 0.12 * random.normal(), bearing + 0.01 * random.normal());
      s.type = TypeId{0};
      set.seen.sightings.push_back(s);
    }
    sets.push_back(set);
  }
  const SensorFit fit = fit_sensor(sets, grid);
  const SensorCoverage& c = fit.coverage;
  EXPECT_GT(fit.matched, 1500u);
  EXPECT_NEAR(c.range, 15, 0.7);  // 99 % of the matched ones are nearer
  EXPECT_NEAR(c.view, 120, 4);
  // The stated error of the map is absent here, so it is subtracted from the noise: sqrt(.12^2 - .05^2).
  EXPECT_NEAR(c.range_sd, 0.109, 0.005);
  EXPECT_LT(c.bearing_sd, 0.01 * 180 / 3.14159);
  ASSERT_TRUE(c.detection_odds.has_value());
  EXPECT_NEAR(c.detection_odds->intercept, odds.intercept, 0.3);
  EXPECT_NEAR(c.detection_odds->per_metre, odds.per_metre, 0.03);
  EXPECT_NEAR(c.detection_odds->per_log_diameter, odds.per_log_diameter, 0.15);
}

TEST(SensorFit, RefusesAMapOfAnotherPlace) {
  SightingsAtTruth set{.robot = {1000, 0, 0}, .seen = {{}, {seen_at(5, 0)}}};
  EXPECT_THROW(fit_sensor({&set, 1}, LandmarkGrid(scatter_landmarks(20, 50, 1))), Error);
}

}  // namespace
}  // namespace waymark::test
