// SPDX-License-Identifier: Apache-2.0
#include "localization/track_score.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include "core/random.hpp"
#include "localization/filters/kalman.hpp"
#include "localization/replay_log.hpp"
#include "localization/robot_log.hpp"
#include "mrclam_robots.hpp"

namespace waymark::test {
using namespace localization;
namespace {

TEST(TrackScore, AlignmentTakesTurnShiftAndScaleAway) {
  Track track;
  std::vector<StampedPose> truth;
  const PlaneAlignment by{{5, -3, 0.7}, 2};
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector2d p(i * 0.1, std::sin(i * 0.2));
    const Eigen::Vector2d q = by(p);
    TrackRow row;
    row.t = i;
    row.at = {{p.x(), p.y(), 0}, Eigen::Matrix3d::Identity()};
    track.rows.push_back(row);
    truth.push_back({static_cast<double>(i), {q.x(), q.y(), 0.7}});
  }
  EXPECT_NEAR(score(track, truth, TrackAlignment::sim2, true).ate_rmse, 0, 1e-9);
  EXPECT_GT(score(track, truth, TrackAlignment::se2, true).ate_rmse, 0.5);
  EXPECT_NEAR(*score(track, truth, TrackAlignment::se2, true).heading_rmse_deg, 0, 1e-6);
}

/// Squared errors of a consistent filter, four per second, with Gauss-Markov errors of this correlation
/// time.
std::vector<double> squares_with(double memory, Random& random, std::vector<double>& t) {
  const double dt = 0.25, alike = memory > 0 ? std::exp(-dt / memory) : 0;
  Eigen::Vector3d e(random.normal(), random.normal(), random.normal());
  std::vector<double> squares;
  t.clear();
  for (int i = 0; i < 3600; ++i) {
    squares.push_back(e.squaredNorm());
    t.push_back(dt * i);
    const Eigen::Vector3d fresh(random.normal(), random.normal(), random.normal());
    e = alike * e + std::sqrt(1 - alike * alike) * fresh;
  }
  return squares;
}

TEST(Consistency, PosesWithoutMemoryCountEach) {
  Random random(1);
  std::vector<double> t;
  const std::vector<double> squares = squares_with(0, random, t);
  EXPECT_GT(consistency(t, squares, 3).independent, 2800);
}

TEST(Consistency, TheBandHoldsWhatAConsistentFilterDoes) {
  for (const double memory : {0.5, 5.0, 20.0}) {
    int inside = 0;
    double independent = 0;
    constexpr int kDrives = 400;
    for (int drive = 0; drive < kDrives; ++drive) {
      Random random(static_cast<std::uint64_t>(drive), "drive");
      std::vector<double> t;
      const std::vector<double> squares = squares_with(memory, random, t);
      const Consistency c = consistency(t, squares, 3);
      inside += c.low <= c.anees && c.anees <= c.high;
      independent += c.independent / kDrives;
    }
    // Squares of a Gauss-Markov error with correlation rho have rho^2: a memory half as long.
    const double alike = std::exp(-0.5 / memory);
    EXPECT_NEAR(independent / (3600 * (1 - alike) / (1 + alike)), 1, 0.25) << memory;
    EXPECT_GE(inside, 0.9 * kDrives) << memory;
    EXPECT_LE(inside, 0.985 * kDrives) << memory;
  }
}

TEST(Consistency, ErrorsTwiceAsLargeAreOutside) {
  Random random(3);
  std::vector<double> t, squares = squares_with(2, random, t);
  for (double& s : squares) s *= 2;
  const Consistency c = consistency(t, squares, 3);
  EXPECT_NEAR(c.anees, 2, 0.2);
  EXPECT_GT(c.anees, c.high);
}

TEST(Consistency, OnePoseAndEqualPosesAreOne) {
  EXPECT_EQ(consistency(std::vector{0.0}, std::vector{3.0}, 3).independent, 1);
  EXPECT_EQ(consistency(std::vector{0.0, 1.0}, std::vector{3.0, 3.0}, 3).independent, 1);
}

/// Plays a real drive again: the true poses, and landmarks seen when they were seen, but with errors of
/// odometry and sightings drawn from the very distributions the filter assumes: independent steps, and
/// for each landmark a Gauss-Markov error with the memory of the log.
class DrawnAgain {
 public:
  DrawnAgain(const RobotLog& log, const std::vector<MapLandmark>& map, std::uint64_t seed)
      : log_(log), map_(map), random_(seed, "drawn again") {}

  double anees(PoseEstimate start) {
    const Eigen::Vector3d sd = start.covariance.diagonal().cwiseSqrt();
    start.pose = pose_of(start.pose.vector() + sd.cwiseProduct(normal3()));
    ExtendedKalman filter(start, LandmarkMatcher(LandmarkWindow{LandmarkGrid(map_)}));
    RepeatedSightings repeated(log_.error_memory);
    std::optional<Pose2> before;
    double now = log_.events.front().t, sum = 0;
    std::size_t count = 0;
    TwistReading held;
    for (const LogEvent& event : log_.events) {
      const auto truth = pose_at(log_.truth, event.t, 0.5);
      if (!truth) continue;
      // The noise is that of what was commanded, the step that of the truth.
      BodyMotion motion = twist_motion(held.speed, held.sideways, held.turn, event.t - now, *log_.odometry);
      const Eigen::Vector3d noise = motion.covariance.diagonal().cwiseSqrt().cwiseProduct(normal3());
      if (before) motion.step = pose_of((inverse(*before) * *truth).vector() - noise);
      before = truth, now = event.t;
      filter.predict(motion);
      repeated.predict(motion);
      if (const auto* twist = std::get_if<TwistReading>(&event.what)) held = *twist;
      if (const auto* seen = std::get_if<SightingSet>(&event.what)) {
        SightingSet drawn = *seen;
        for (SeenLandmark& s : drawn.sightings) draw(s, *truth, event.t);
        repeated.widen(drawn, event.t);
        filter.update(drawn);
      }
      const PoseEstimate at = filter.estimate();
      const Eigen::Vector3d e(at.pose.x - truth->x, at.pose.y - truth->y,
                              wrap_angle(at.pose.yaw - truth->yaw));
      sum += e.dot(at.covariance.ldlt().solve(e)) / 3;
      ++count;
    }
    return sum / static_cast<double>(count);
  }

 private:
  struct Error {
    double t = 0, range = 0, bearing = 0;
  };

  Eigen::Vector3d normal3() { return {random_.normal(), random_.normal(), random_.normal()}; }

  double later(double error, double seconds, double memory) {
    const double alike = std::exp(-seconds / memory);
    return alike * error + std::sqrt(1 - alike * alike) * random_.normal();
  }

  void draw(SeenLandmark& s, const Pose2& truth, double t) {
    const auto landmark = std::ranges::find(map_, s.identity.value_or(0), &MapLandmark::key);
    if (landmark == map_.end()) return;
    const auto [at, fresh] = errors_.try_emplace(landmark->key, Error{t, random_.normal(), random_.normal()});
    Error& error = at->second;
    if (!fresh)
      error = {t, later(error.range, t - error.t, log_.error_memory.range),
               later(error.bearing, t - error.t, log_.error_memory.bearing)};
    const Eigen::Vector2d to = landmark->at - truth.at();
    s.range = std::max(0.05, to.norm() + s.range_sd * error.range);
    s.bearing = wrap_angle(std::atan2(to.y(), to.x()) - truth.yaw + s.bearing_sd * error.bearing);
  }

  const RobotLog& log_;
  const std::vector<MapLandmark>& map_;
  Random random_;
  std::map<LandmarkKey, Error> errors_;
};

/// Interpolated quantiles, 2.5 and 97.5 %.
std::pair<double, double> band(std::vector<double> values) {
  std::ranges::sort(values);
  const auto at = [&](double part) {
    const double place = part * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const double rest = place - std::floor(place);
    return values[below] * (1 - rest) + values[std::min(below + 1, values.size() - 1)] * rest;
  };
  return {at(0.025), at(0.975)};
}

// What a consistent filter would do on these very drives says what band ANEES has. Of five robots each within
// its 95 % band in 19 of 20 cases, at least four are with 97.7 %.
TEST(MrclamConsistency, ExtendedKalmanIsWithinTheBandOfItsOwnModel) {
  SKIP_WITHOUT_MRCLAM();
  const MrclamRobots robots = read_mrclam();
  constexpr std::size_t kRuns = 50;
  std::vector<double> pooled(kRuns, 0);
  double real = 0, rows = 0;
  int inside = 0;
  for (std::size_t robot = 0; robot < 5; ++robot) {
    const RobotLog& log = robots.logs[robot];
    const PoseEstimate& start = robots.start[robot];
    ExtendedKalman filter(
        start, LandmarkMatcher(LandmarkWindow{LandmarkGrid(robots.map)}, FeatureScales(robots.types)));
    const TrackScore s = score(replay(log, filter, {}), log.truth, TrackAlignment::none, true);
    const auto n = static_cast<double>(s.poses);
    std::vector<double> drawn;
    for (std::size_t run = 0; run < kRuns; ++run) {
      drawn.push_back(DrawnAgain(log, robots.map, 5 * run + robot).anees(start));
      pooled[run] += n * drawn.back();
    }
    const auto [low, high] = band(drawn);
    const Consistency& c = *s.consistency;
    inside += low <= c.anees && c.anees <= high;
    EXPECT_GE(c.anees, c.low) << "robot " << robot + 1;
    EXPECT_LE(c.anees, c.high) << "robot " << robot + 1;
    std::cout << "robot " << robot + 1 << ": ANEES " << c.anees << ", simulated " << low << " to " << high
              << ", by " << c.independent << " independent poses " << c.low << " to " << c.high << "\n";
    real += n * c.anees;
    rows += n;
  }
  real /= rows;
  for (double& p : pooled) p /= rows;
  const auto [low, high] = band(pooled);
  std::cout << "all: ANEES " << real << ", simulated " << low << " to " << high << "\n";
  EXPECT_GE(real, low);
  EXPECT_LE(real, high);
  EXPECT_GE(inside, 4);
}

}  // namespace
}  // namespace waymark::test
