// SPDX-License-Identifier: Apache-2.0
// A robot that drives off the mapped ground, among rocks the map does not have, and comes back.
#include "core/random.hpp"
#include "tests/apps/localize_fixture.hpp"
#include "tests/apps/made_pose.hpp"

namespace waymark::test {
namespace {

class LeaveTheMap : public Localize {
 protected:
  static constexpr double kEdge = 40;  // the map ends at x = 40

  struct Site {
    std::vector<Rock> rocks;
    std::string csv = "uid,x,y,radius,position_sd\n", log;
  };

  /// `edge`: where the map ends, m; `carried`: after 200 s the robot is set down elsewhere, unknown to it.
  static Site site(std::uint64_t seed, double edge = kEdge, bool carried = false) {
    Site made;
    Random random(seed, "off the map");
    for (int i = 0; i < 520; ++i) {
      const Rock rock{random.uniform(-30, 180), random.uniform(-30, 30), random.log_uniform(0.2, 1)};
      if (std::abs(rock.y) < 1.5) continue;
      made.rocks.push_back(rock);
      if (rock.x < edge)
        made.csv += "r" + std::to_string(i) + "," + std::to_string(rock.x) + "," + std::to_string(rock.y) +
                    "," + std::to_string(rock.radius) + ",0.05\n";
    }
    const double bias = 0.03 * random.normal(), turn_bias = 0.001 * random.normal();
    MadePose at{-20, 0, 0};
    std::string& log = made.log;
    log = R"({"kind":"header","version":1,"start":{"x":-20,"y":0,"yaw":0}})"
          "\n";
    for (int i = 0; i < (carried ? 290 : 620); ++i) {
      const double t = i;
      if (carried && i == 200) at = {at.x - 55, 8, 0.6};
      // There, a half turn of 6 m radius, and back.
      const double speed = 0.5, turn = i >= 290 && i < 328 ? speed / 6 : 0;
      log += nlohmann::json{{"kind", "truth"}, {"t", t}, {"x", at.x}, {"y", at.y}, {"yaw", at.yaw}}.dump() +
             "\n";
      log += nlohmann::json{{"kind", "odometry"},
                            {"t", t},
                            {"v", speed * (1 + bias + 0.05 * random.normal())},
                            {"omega", turn * (1 + bias) + turn_bias + 0.003 * random.normal()}}
                 .dump() +
             "\n";
      if (i % 2 == 0) {
        nlohmann::json items = nlohmann::json::array();
        for (const Rock& rock : made.rocks) {
          const double dx = rock.x - at.x, dy = rock.y - at.y, range = std::hypot(dx, dy);
          const double bearing = std::remainder(std::atan2(dy, dx) - at.yaw, 2 * M_PI);
          if (range > 12 || std::abs(bearing) > 2 || random.bernoulli(0.2)) continue;
          items.push_back({{"type", "rock"},
                           {"range", range + 0.08 * random.normal()},
                           {"bearing", bearing + 0.01 * random.normal()},
                           {"range_sd", 0.08},
                           {"bearing_sd", 0.01},
                           {"features", {{"radius", rock.radius * (1 + 0.1 * random.normal())}}}});
        }
        log += nlohmann::json{{"kind", "sightings"}, {"t", t + 0.01}, {"items", items}}.dump() + "\n";
      }
      at = at * MadePose{speed * std::cos(turn / 2), speed * std::sin(turn / 2), turn};
    }
    return made;
  }

  /// Error of the last pose, and whether the track says `lost` there.
  std::pair<double, bool> end(const Site& made) {
    std::map<std::string, double> v = last_row();
    MadePose truth;
    std::istringstream lines(made.log);
    for (std::string row; std::getline(lines, row);)
      if (const auto event = nlohmann::json::parse(row); event["kind"] == "truth")
        truth = {event["x"], event["y"], event["yaw"]};
    return {truth.away({v.at("x"), v.at("y"), 0}), v.at("lost") != 0};
  }

  /// Drives by a method and expects it to end where the robot is. Returns what the program said.
  std::string finds_back(const Site& made, const std::string& method) {
    const Outcome said = localize(made.log, {"--method", method, "--ids", "unknown"});
    EXPECT_EQ(said.code, 0) << said.err;
    if (said.code != 0) return said.err;
    const auto [off, lost] = end(made);
    std::cout << method << ": " << off << " m off at the end\n";
    EXPECT_LT(off, 0.5);
    EXPECT_FALSE(lost);
    return said.err;
  }
};

TEST_F(LeaveTheMap, EveryMethodFindsBack) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Site made = site(seed);
    import_rocks(made.csv, "local");
    for (const std::string method : {"ekf", "ukf", "pf"}) {
      SCOPED_TRACE(method + ", seed " + std::to_string(seed));
      EXPECT_THAT(finds_back(made, method), testing::HasSubstr("lost in")) << "it must say so";
    }
  }
}

// SLAM maps what it meets outside, so it is not lost there; its way back must still end in the map.
TEST_F(LeaveTheMap, SlamFindsBackToo) {
  const Site made = site(1);
  import_rocks(made.csv, "local");
  for (const std::string method : {"slam", "graph"}) {
    SCOPED_TRACE(method);
    finds_back(made, method);
  }
}

TEST_F(LeaveTheMap, WhoIsCarriedElsewhereSaysSoAndFindsItself) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Site made = site(seed, 1000, true);
    import_rocks(made.csv, "local");
    for (const std::string method : {"ekf", "slam", "graph"}) {
      SCOPED_TRACE(method + ", seed " + std::to_string(seed));
      EXPECT_THAT(finds_back(made, method), testing::HasSubstr("lost in")) << "it must say so";
    }
  }
}

}  // namespace
}  // namespace waymark::test
