// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <numbers>
#include <sstream>

#include "core/random.hpp"
#include "core/text_file.hpp"
#include "importers/rasters/dem.hpp"
#include "localization/global/skyline_index.hpp"
namespace waymark::test {
using namespace localization;
namespace {

/// A DEM laid on a plane, metres east and north of its south-west corner.
struct Ground {
  Grid<double> heights;
  double dx = 1, dy = 1;

  std::optional<double> operator()(const Eigen::Vector2d& p) const {
    const double c = p.x() / dx, r = static_cast<double>(heights.rows() - 1) - p.y() / dy;
    const auto c0 = static_cast<std::int64_t>(std::floor(c)), r0 = static_cast<std::int64_t>(std::floor(r));
    if (c0 < 0 || r0 < 0 || c0 + 1 >= heights.columns() || r0 + 1 >= heights.rows()) return {};
    const double u = c - static_cast<double>(c0), v = r - static_cast<double>(r0);
    const double h = (1 - v) * ((1 - u) * heights(c0, r0) + u * heights(c0 + 1, r0)) +
                     v * ((1 - u) * heights(c0, r0 + 1) + u * heights(c0 + 1, r0 + 1));
    if (!std::isfinite(h)) return {};
    return h;
  }
  double width() const { return dx * static_cast<double>(heights.columns() - 1); }
  double depth() const { return dy * static_cast<double>(heights.rows() - 1); }
};

/// Tops of the horizon by marching rays, without knowing any summit: local maxima of the skyline that stand
/// at least `stand_out` radians above the skyline on both sides.
std::vector<HorizonTop> horizon(const Ground& ground, const Pose2& robot, const SkylineOptions& o,
                                Random& random, double stand_out = 0.003) {
  constexpr int kRays = 3600;
  const double eye = *ground(robot.at()) + o.eye;
  std::vector<double> sky(kRays, -2);
  for (int i = 0; i < kRays; ++i) {
    const double a = 2 * std::numbers::pi * i / kRays;
    const Eigen::Vector2d along(std::cos(a), std::sin(a));
    for (double t = 100; t < o.reach; t += 40 + 0.001 * t)
      if (const auto h = ground(robot.at() + t * along))
        sky[static_cast<std::size_t>(i)] =
            std::max(sky[static_cast<std::size_t>(i)],
                     (*h - curvature_drop(t, o.body_radius, o.refraction) - eye) / t);
  }
  std::vector<HorizonTop> tops;
  const auto at = [&](int i) { return sky[static_cast<std::size_t>(((i % kRays) + kRays) % kRays)]; };
  for (int i = 0; i < kRays; ++i) {
    if (at(i) < -1 || !(at(i) > at(i - 1) && at(i) >= at(i + 1))) continue;
    bool stands = true;
    for (const int way : {-1, 1}) {
      int k = 1;
      while (k < kRays / 6 && at(i + way * k) <= at(i) && at(i + way * k) > at(i) - stand_out) ++k;
      stands = stands && at(i + way * k) <= at(i) - stand_out;
    }
    if (!stands) continue;
    HorizonTop top{.bearing = 0, .bearing_sd = 0.002, .elevation = {}, .elevation_sd = 0.001};
    top.bearing = wrap_angle(2 * std::numbers::pi * i / kRays - robot.yaw + top.bearing_sd * random.normal());
    top.elevation = std::atan(at(i)) + top.elevation_sd * random.normal();
    tops.push_back(top);
  }
  return tops;
}

std::filesystem::path dems() {
  return std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/dem";
}

struct Country {
  Ground ground;
  std::vector<SkylineSummit> summits;
};

Country country(const std::string& dem_file, const std::string& summit_file, double min_prominence,
                double west, double south) {
  const auto dem =
      importers::import_dem({.files = {(dems() / dem_file).string()}, .nodata = NodataPolicy::unknown});
  const GridGeometry& g = dem->geometry();
  Country c{{Grid<double>(g.columns, g.rows), 0, 0}, {}};
  const auto all = dem->read({0, 0, g.columns, g.rows});
  for (std::int64_t r = 0; r < g.rows; ++r)
    for (std::int64_t k = 0; k < g.columns; ++k) c.ground.heights(k, r) = all(k, r);
  const double metre = std::numbers::pi / 180 * 6371000;
  c.ground.dy = metre * std::abs(g.where.dy);
  c.ground.dx = metre * g.where.dx * std::cos((south + 0.5) * std::numbers::pi / 180);
  std::istringstream file(read_text(dems() / summit_file, "the summits"));
  for (std::string line; std::getline(file, line);) {
    std::ranges::replace(line, ',', ' ');
    std::istringstream words(line);
    double lat = 0, lon = 0, height = 0, a = 0, b = 0, prominence = 0;
    if (!(words >> lat >> lon >> height >> a >> b >> prominence) || prominence < min_prominence) continue;
    const Eigen::Vector2d at((lon - west) / g.where.dx * c.ground.dx,
                             (lat - south) / std::abs(g.where.dy) * c.ground.dy);
    c.summits.push_back({at, height, prominence, 0});
  }
  return c;
}

/// Counts the robots at random positions that are found within 200 m; their horizons are computed by rays.
void survey(const char* name, const Country& c, const SkylineIndex& index, const SkylineOptions& o, int tries,
            bool compass, double expected) {
  Random random(5, name);
  int right = 0, wrong = 0, unknown = 0;
  double seconds = 0, tops = 0, matched = 0;
  std::vector<double> errors;
  for (int i = 0; i < tries;) {
    const Pose2 robot{random.uniform(0.2, 0.8) * c.ground.width(),
                      random.uniform(0.2, 0.8) * c.ground.depth(), random.uniform(-3.1, 3.1)};
    if (!c.ground(robot.at()) || *c.ground(robot.at()) < 1) continue;
    const auto seen = horizon(c.ground, robot, o, random);
    ++i;
    tops += static_cast<double>(seen.size());
    std::optional<double> heading;
    if (compass) heading = wrap_angle(robot.yaw + o.heading_sd * random.normal());
    const auto begun = std::chrono::steady_clock::now();
    const auto answer = index.find(seen, heading);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    if (!answer.fix) {
      ++unknown;
      continue;
    }
    const double off = (answer.fix->at.pose.at() - robot.at()).norm();
    errors.push_back(off);
    matched += answer.fix->matched;
    ++(off < 300 ? right : wrong);
  }
  std::ranges::sort(errors);
  std::cout << name << (compass ? " with compass" : "") << ": " << c.summits.size() << " summits, "
            << tops / tries << " tops on a horizon; of " << tries << " places " << right << " right, "
            << wrong << " wrong, " << unknown << " unknown; median error "
            << (errors.empty() ? 0 : errors[errors.size() / 2]) << " m, matched "
            << matched / std::max(1, right + wrong) << "; " << seconds / tries << " s each\n";
  EXPECT_EQ(wrong, 0);
  EXPECT_GE(right, expected * tries);
}

TEST(Skyline, PlacesInThePyrenees) {
  if (!std::filesystem::exists(dems())) GTEST_SKIP() << dems() << " is not on this machine";
  const Country c = country("earth/N42E001.tif", "expected/prominence20_N42E001.txt", 40, 1, 42);
  SkylineOptions o{.body_radius = 6371000, .refraction = 0.13, .eye = 2};
  o.step = 1000;
  const SkylineIndex index(c.summits, std::ref(c.ground), o);
  std::cout << index.viewpoints() << " places of the grid\n";
  survey("Pyrenees", c, index, o, 8, false, 0.75);
  survey("Pyrenees", c, index, o, 4, true, 0.5);
}

/// The whole horizon by marching rays, 0.25 degrees apart.
HorizonProfile profile_of(const TerrainHeight& ground, const Pose2& robot, const SkylineOptions& o,
                          Random& random) {
  constexpr int kRays = 1440;
  HorizonProfile profile{.first_angle = -std::numbers::pi,
                         .angle_step = 2 * std::numbers::pi / kRays,
                         .elevation_sd = 0.001,
                         .elevations = {}};
  const double eye = *ground(robot.at()) + o.eye;
  for (int i = 0; i < kRays; ++i) {
    const double a = robot.yaw + profile.first_angle + i * profile.angle_step;
    double highest = -2;
    for (double t = 60; t < o.reach; t += 50 + 0.002 * t)
      if (const auto h = ground(robot.at() + t * Eigen::Vector2d(std::cos(a), std::sin(a))))
        highest = std::max(highest, (*h - curvature_drop(t, o.body_radius, o.refraction) - eye) / t);
    const double seen = std::atan(highest) + profile.elevation_sd * random.normal();
    profile.elevations.push_back(random.bernoulli(0.02) ? std::nanf("") : static_cast<float>(seen));
  }
  return profile;
}

struct ProfileSurvey {
  int right = 0, wrong = 0, unknown = 0;
  double squares = 0;  // normalized squared errors over the dimension, summed
  std::vector<double> errors;
};

/// Locates robots at random positions by their whole horizons, which `truth` makes and the index searches.
ProfileSurvey survey_profiles(const Ground& truth, const TerrainHeight& map, const SkylineIndex& index,
                              const SkylineOptions& o, int tries, Random random) {
  ProfileSurvey survey;
  for (int i = 0; i < tries;) {
    const Pose2 robot{random.uniform(0.2, 0.8) * truth.width(), random.uniform(0.2, 0.8) * truth.depth(),
                      random.uniform(-3.1, 3.1)};
    if (!truth(robot.at()) || !map(robot.at())) continue;
    ++i;
    const SkylineAnswer answer = index.find(profile_of(std::cref(truth), robot, o, random));
    if (!answer.fix) {
      ++survey.unknown;
      continue;
    }
    const PoseEstimate& at = answer.fix->at;
    Eigen::Vector3d off = at.pose.vector() - robot.vector();
    off.z() = wrap_angle(off.z());
    survey.errors.push_back(off.head<2>().norm());
    ++(survey.errors.back() < 100 ? survey.right : survey.wrong);
    survey.squares += off.dot(at.covariance.inverse() * off) / 3;
  }
  return survey;
}

TEST(Skyline, TheWholeHorizonLocatesInTheAndes) {
  if (!std::filesystem::exists(dems())) GTEST_SKIP() << dems() << " is not on this machine";
  const Country c = country("earth/S33W071.tif", "expected/prominence20_S33W071.txt", 40, -71, -33);
  const SkylineOptions o{.body_radius = 6371000, .refraction = 0.13, .eye = 2};
  const SkylineIndex index(c.summits, std::ref(c.ground), o);
  const ProfileSurvey found =
      survey_profiles(c.ground, std::cref(c.ground), index, o, 3, Random(15, "the whole horizon"));
  EXPECT_GE(found.right, 2);
  EXPECT_EQ(found.wrong, 0);
  EXPECT_LT(found.squares / found.right, 3);  // 9 degrees of freedom: 1 +- 0.47, and errors of the covariance

  Random random(16, "what no position shows");
  HorizonProfile mirrored =
      profile_of(std::cref(c.ground), {0.4 * c.ground.width(), 0.6 * c.ground.depth(), 1}, o, random);
  std::ranges::reverse(mirrored.elevations);
  EXPECT_FALSE(index.find(mirrored).fix);
}

/// Removes round patches of 2 to 12 cells from steep ground, as radar leaves them, until `fraction` is gone.
Ground with_holes(Ground ground, double fraction, Random random) {
  Grid<double>& h = ground.heights;
  const Grid<double> whole = h;
  const auto count = static_cast<std::int64_t>(fraction * static_cast<double>(h.columns() * h.rows()));
  for (std::int64_t gone = 0; gone < count;) {
    const auto c = static_cast<std::int64_t>(random.uniform(1, static_cast<double>(h.columns() - 1))),
               r = static_cast<std::int64_t>(random.uniform(1, static_cast<double>(h.rows() - 1)));
    const double slope = std::hypot((whole(c + 1, r) - whole(c - 1, r)) / (2 * ground.dx),
                                    (whole(c, r + 1) - whole(c, r - 1)) / (2 * ground.dy));
    if (!(slope > 0.7)) continue;
    const auto radius = static_cast<std::int64_t>(random.uniform(2, 12));
    for (std::int64_t y = r - radius; y <= r + radius; ++y)
      for (std::int64_t x = c - radius; x <= c + radius; ++x)
        if (h.contains(x, y) && (x - c) * (x - c) + (y - r) * (y - r) <= radius * radius &&
            std::isfinite(h(x, y)))
          h(x, y) = std::nan(""), ++gone;
  }
  return ground;
}

TEST(Skyline, HolesOfTheDemDoNotMoveThePose) {
  if (!std::filesystem::exists(dems())) GTEST_SKIP() << dems() << " is not on this machine";
  const Country c = country("earth/S33W071.tif", "expected/prominence20_S33W071.txt", 40, -71, -33);
  const Ground map = with_holes(c.ground, 0.07, Random(1, "holes"));
  const SkylineOptions o{.body_radius = 6371000, .refraction = 0.13, .eye = 2};
  const SkylineIndex index(c.summits, std::cref(map), o);
  const ProfileSurvey found =
      survey_profiles(c.ground, std::cref(map), index, o, 3, Random(17, "the whole horizon"));
  std::cout << found.right << " right, " << found.wrong << " wrong, " << found.unknown << " unknown, ANEES "
            << found.squares / std::max(1, found.right + found.wrong) << ", errors:";
  for (const double e : found.errors) std::cout << ' ' << e;
  std::cout << " m\n";
  EXPECT_GE(found.right, 2);
  EXPECT_EQ(found.wrong, 0);
  EXPECT_LT(found.squares / found.right, 3);
}

/// Cones on a plain: everything is known.
struct Cones {
  std::vector<SkylineSummit> summits;
  std::optional<double> operator()(const Eigen::Vector2d& p) const {
    double height = 0;
    for (const SkylineSummit& s : summits) height = std::max(height, s.height - 0.4 * (p - s.at).norm());
    return height;
  }
};

Cones cones() {
  Random random(3);
  Cones c;
  for (int i = 0; i < 40; ++i) {
    const double height = random.uniform(200, 900);
    c.summits.push_back({{random.uniform(0, 30000), random.uniform(0, 30000)}, height, height, 5000});
  }
  return c;
}

std::vector<HorizonTop> tops_of(const Cones& c, const Pose2& robot, const SkylineOptions& o, bool elevations,
                                std::size_t most) {
  std::vector<HorizonTop> tops;
  const TerrainHeight ground = c;
  const Eigen::Vector3d eye(robot.x, robot.y, *c(robot.at()) + o.eye);
  for (const SkylineSummit& s : c.summits) {
    const Eigen::Vector2d d = s.at - robot.at();
    const double drop = curvature_drop(d.norm(), o.body_radius, o.refraction);
    if (tops.size() == most || d.norm() > o.reach ||
        !clears_terrain(eye, {s.at.x(), s.at.y(), s.height}, ground, o, 50, 50))
      continue;
    tops.push_back({.bearing = wrap_angle(std::atan2(d.y(), d.x()) - robot.yaw), .elevation = {}});
    if (elevations) tops.back().elevation = std::atan2(s.height - drop - eye.z(), d.norm());
  }
  return tops;
}

TEST(Skyline, ThreeBearingsAreAResection) {
  const Cones c = cones();
  const Pose2 robot{14000, 16000, 0.7};
  SkylineOptions o{.body_radius = 1737400};
  o.position_sd = o.height_sd = 1;
  const auto tops = tops_of(c, robot, o, false, 3);
  ASSERT_EQ(tops.size(), 3u);
  std::vector<std::optional<std::uint32_t>> matches;
  for (const HorizonTop& t : tops)
    for (std::uint32_t j = 0; j < c.summits.size(); ++j) {
      const Eigen::Vector2d d = c.summits[j].at - robot.at();
      if (std::abs(wrap_angle(t.bearing + robot.yaw - std::atan2(d.y(), d.x()))) < 1e-9)
        matches.emplace_back(j);
    }
  ASSERT_EQ(matches.size(), 3u);
  const PoseEstimate near{{robot.x + 700, robot.y - 500, robot.yaw + 0.1}, Eigen::Matrix3d::Identity()};
  const auto found = resection(tops, c.summits, matches, near, c, o);
  ASSERT_TRUE(found);
  EXPECT_LT((found->pose.at() - robot.at()).norm(), 1);
  // Two bearings need a compass.
  matches[2].reset();
  EXPECT_FALSE(resection(tops, c.summits, matches, near, c, o));
  o.heading = robot.yaw;
  const auto with_compass = resection(tops, c.summits, matches, near, c, o);
  ASSERT_TRUE(with_compass);
  EXPECT_LT((with_compass->pose.at() - robot.at()).norm(), 1);
}

TEST(Skyline, FindsThePlaceByBearingsAndElevations) {
  const Cones c = cones();
  SkylineOptions o{.body_radius = 1737400};
  o.position_sd = o.height_sd = 5;
  const SkylineIndex index(c.summits, c, o);
  Random random(9);
  for (int i = 0; i < 4; ++i) {
    const Pose2 robot{random.uniform(8000, 22000), random.uniform(8000, 22000), random.uniform(-3, 3)};
    const auto tops = tops_of(c, robot, o, true, 12);
    const auto answer = i == 0 ? find_by_skyline(tops, c.summits, c, o) : index.find(tops);
    ASSERT_TRUE(answer.fix) << answer.reason << " with " << tops.size() << " tops";
    EXPECT_LT((answer.fix->at.pose.at() - robot.at()).norm(), 30);
  }
}

TEST(Skyline, AFlatOrNarrowHorizonIsUnknown) {
  const Cones c = cones();
  const SkylineOptions o{.body_radius = 1737400};
  const SkylineIndex index(c.summits, c, o);
  HorizonProfile flat{.first_angle = 0, .angle_step = 0.01, .elevation_sd = 0.001, .elevations = {}};
  EXPECT_EQ(index.find(flat).reason, "too little of the horizon is known");
  flat.elevations.assign(628, 0.001F);
  EXPECT_EQ(index.find(flat).reason, "too little of the horizon is known");
  Random random(8);
  for (float& e : flat.elevations) e = static_cast<float>(random.uniform(0, 0.1));
  EXPECT_FALSE(index.find(flat).fix);
  flat.elevations.resize(150);
  EXPECT_EQ(index.find(flat).reason, "too little of the horizon is known");
}

TEST(Skyline, ForeignHorizonsAreUnknown) {
  const Cones c = cones();
  SkylineOptions o{.body_radius = 1737400};
  const SkylineIndex index(c.summits, c, o);
  Random random(4);
  for (int i = 0; i < 3; ++i) {
    std::vector<HorizonTop> tops;
    for (int k = 0; k < 8; ++k)
      tops.push_back({.bearing = random.uniform(-3.1, 3.1), .elevation = random.uniform(0.005, 0.08)});
    EXPECT_FALSE(index.find(tops).fix);
  }
  EXPECT_EQ(index.find(std::span<const HorizonTop>{}).reason, "too few tops on the horizon");
  EXPECT_EQ(find_by_skyline(std::vector<HorizonTop>(4), {}, c, o).reason, "too few summits in the map");
}

TEST(Ground, StandsAsTheSurfaceLies) {
  const TerrainHeight plane = [](const Eigen::Vector2d& p) { return 5 + 0.1 * p.x() + 0.2 * p.y(); };
  const auto east = pose_on_terrain(plane, {3, 4, 0});
  ASSERT_TRUE(east);
  EXPECT_NEAR(east->z, 6.1, 1e-12);
  EXPECT_NEAR(east->pitch, -std::atan(0.1), 1e-12);                        // uphill: nose up
  EXPECT_NEAR(east->roll, std::atan(0.2 * std::cos(east->pitch)), 1e-12);  // the left side is higher
  const auto north = pose_on_terrain(plane, {3, 4, std::numbers::pi / 2});
  EXPECT_NEAR(north->pitch, -std::atan(0.2), 1e-12);
  EXPECT_NEAR(north->roll, -std::atan(0.1 * std::cos(north->pitch)), 1e-12);
  // Its axes touch the plane at any heading, on any slope; metres.
  for (const double slope : {0.1, 0.6})
    for (double yaw = 0; yaw < 6; yaw += 0.7) {
      const TerrainHeight steep = [slope](const Eigen::Vector2d& p) { return slope * (p.x() - 2 * p.y()); };
      const auto at = pose_on_terrain(steep, {3, 4, yaw}, {.base = 1.6, .track = 1.4});
      const Eigen::Vector3d up = at->grid_from_robot().transform.linear().col(2);
      EXPECT_NEAR((up - Eigen::Vector3d(-slope, 2 * slope, 1).normalized()).norm(), 0, 1e-12) << yaw;
    }
  EXPECT_NEAR(project_to_map({2, 0, 0.3}, *north).x, 2 / std::hypot(1, 0.2), 1e-12);
  const TerrainHeight hole = [](const Eigen::Vector2d& p) {
    return p.x() > 0 ? std::optional<double>(1) : std::nullopt;
  };
  EXPECT_FALSE(pose_on_terrain(hole, {0, 0, 0}));
  EXPECT_NEAR(curvature_drop(10000, 6371000, 0), 7.85, 0.01);
  EXPECT_EQ(curvature_drop(10000, 0, 0), 0);
}

}  // namespace
}  // namespace waymark::test
