// SPDX-License-Identifier: Apache-2.0
#include "localization/craters/crater_index.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <chrono>
#include <complex>
#include <iostream>
#include <set>

#include "tests/localization/made_craters.hpp"

namespace waymark::test {
using namespace localization;
namespace {

struct Found {
  int right = 0, wrong = 0, unknown = 0, invented = 0;
  double seconds = 0, matched = 0, detections = 0, predicted = 0;
  int weak = 0, weak_wrong = 0;  // best candidates, whether accepted or not
  std::vector<double> errors, nees;
};

ImagePose::Step pose_error(const ImagePose& found, const ImagePose& truth) {
  ImagePose::Step e;
  const Eigen::Vector3d d = found.ground - truth.ground;
  e << found.axes.col(0).dot(d), found.axes.col(1).dot(d), found.log_scale - truth.log_scale, 0,
      found.tilt - truth.tilt;
  // A clockwise turn moves the x axis towards the old y axis, which is down.
  e[3] = std::atan2(found.axes.col(0).dot(truth.axes.col(1)), found.axes.col(0).dot(truth.axes.col(0)));
  return e;
}

bool is_right(const CraterFix& fix, const ImagePose& truth) {
  return (fix.pose.ground - truth.ground).norm() < 100 * std::exp(truth.log_scale) &&
         std::abs(fix.pose.log_scale - truth.log_scale) < 0.1;
}

struct Trials {
  const CraterIndex& index;
  const std::vector<BodyCrater>& craters;
  Body body;
  CraterSensor sensor;
  double min_scale, max_scale;  // metres per pixel
  std::size_t min_detections = 12, max_detections = 1000;
};

Found locate(const Trials& t, int tries, std::uint64_t seed, const CraterSearchOptions& options) {
  Found found;
  Random random(seed, "places of images");
  for (int i = 0; i < tries;) {
    const double scale = random.log_uniform(t.min_scale, t.max_scale);
    const ImagePose pose = anywhere(t.body, scale, t.sensor, random);
    MadeCraterImage made = look_down(t.craters, t.body, pose, t.sensor, random);
    if (made.craters.size() < t.min_detections) continue;
    while (made.craters.size() > t.max_detections) {
      const auto k = static_cast<std::ptrdiff_t>(random.uniform_index(made.craters.size()));
      made.craters.erase(made.craters.begin() + k);
    }
    ++i;
    found.detections += static_cast<double>(made.craters.size());
    const Eigen::Vector2d size = Eigen::Vector2d::Constant(t.sensor.side);
    const auto begun = std::chrono::steady_clock::now();
    const CraterAnswer answer = t.index.find(
        {.craters = made.craters, .size = size, .camera = GroundCamera(t.sensor.focal)}, options);
    found.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    if (!answer.candidates.empty()) {
      found.predicted += answer.wrong;
      ++found.weak, found.weak_wrong += !is_right(answer.candidates[0], pose);
    }
    if (!answer.fix) {
      ++found.unknown;
    } else if (!is_right(*answer.fix, pose)) {
      ++found.wrong;
    } else {
      ++found.right;
      found.matched += answer.fix->matched;
      const int n = t.sensor.focal > 0 ? 6 : 4;
      const ImagePose::Step e = pose_error(answer.fix->pose, pose);
      found.errors.push_back(e.head<2>().norm() / scale);
      found.nees.push_back(e.head(n).dot(answer.fix->covariance.topLeftCorner(n, n).inverse() * e.head(n)) /
                           n);
    }
    if (i % 4 != 0) continue;
    // The same craters elsewhere in the image are in no map.
    for (ImageCrater& c : made.craters)
      c.at = t.sensor.side * Eigen::Vector2d(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
    found.invented +=
        t.index.find({.craters = made.craters, .size = size, .camera = GroundCamera(t.sensor.focal)}, options)
            .fix.has_value();
  }
  return found;
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  return values[values.size() / 2];
}

void report(const char* name, const CraterIndex& index, const Found& f) {
  const int tries = f.right + f.wrong + f.unknown;
  double nees = 0;
  for (const double n : f.nees) nees += n / static_cast<double>(f.nees.size());
  std::cout << name << ": " << index.size() << " craters, " << index.triangles() << " triangles, "
            << index.bytes() / std::max<std::size_t>(1, index.size()) << " bytes each; of " << tries
            << " images " << f.right << " right, " << f.wrong << " wrong, " << f.unknown << " unknown, "
            << f.invented << " scrambled accepted; " << f.detections / tries << " detections, "
            << f.matched / std::max(1, f.right) << " matched; median error " << median(f.errors)
            << " px, ANEES " << nees << "; best candidates wrong " << f.weak_wrong << " of " << f.weak
            << ", predicted " << f.predicted << "; " << f.seconds / tries << " s each\n";
}

TEST(ImagePoses, PixelsAndGroundAgree) {
  for (const Body& body : {moon(), mars()}) {
    const BodySurface surface(body);
    Random random(3, body.name);
    for (int i = 0; i < 20; ++i) {
      const CraterSensor how{.focal = i % 2 ? 1500.0 : 0.0, .tilt_sd = 3};
      const ImagePose pose = anywhere(body, 80, how, random);
      const GroundCamera camera(how.focal);
      const Eigen::Vector2d pixel(random.uniform(-500, 500), random.uniform(-500, 500));
      const auto ground = camera.ground(pose, pixel, surface);
      ASSERT_TRUE(ground);
      EXPECT_NEAR((surface.nearest(*ground) - *ground).norm(), 0, 1e-3);  // m
      const auto back = camera.project(pose, *ground, surface.up(*ground));
      ASSERT_TRUE(back);
      EXPECT_NEAR((back->at - pixel).norm(), 0, 1e-5);
      const LonLat at = surface.geodetic(*ground).at;
      EXPECT_NEAR((surface.point(at) - *ground).norm(), 0, 1e-3);
      EXPECT_NEAR((pose.axes.transpose() * pose.axes - Eigen::Matrix3d::Identity()).norm(), 0, 1e-9);
    }
  }
}

TEST(ImagePoses, StepsAreMetresScaleTurnAndTilt) {
  const BodySurface surface(moon());
  const ImagePose north_up = image_pose(surface, surface.point({30, 20}), 100, 0);
  EXPECT_NEAR(north_up.azimuth(), 0, 1e-12);
  ImagePose::Step step;
  step << 1000, 0, 0.1, 0.2, 0.01, -0.02;
  const ImagePose moved = north_up.moved(step, surface);
  const LonLat at = surface.geodetic(moved.ground).at;
  EXPECT_NEAR(at.lon, 30 + 1000 / (1737400 * std::cos(20 * std::numbers::pi / 180)) * 180 / std::numbers::pi,
              1e-5);
  EXPECT_NEAR(at.lat, 20, 1e-4);
  EXPECT_NEAR(moved.azimuth(), 0.2, 1e-3);  // meridians converge
  EXPECT_NEAR(moved.log_scale, std::log(100) + 0.1, 1e-12);
  EXPECT_NEAR((moved.tilt - Eigen::Vector2d(0.01, -0.02)).norm(), 0, 1e-12);
  // A camera 150 km above the ground whose pixels are 100 m.
  const auto camera = GroundCamera(1500).position(north_up);
  ASSERT_TRUE(camera);
  EXPECT_NEAR(camera->norm(), 1737400 + 150000, 1e-3);
  EXPECT_FALSE(GroundCamera().position(north_up));
}

// Every triangle of a crater with two of its nearest neighbours of at least 0.8 of its radius.
TEST(CraterIndex, HasTheTrianglesOfNeighbours) {
  const auto craters = made_craters(300, 4000, moon(), 5);
  const CraterIndex index(craters, moon());
  std::set<std::array<std::size_t, 3>> expected;
  for (std::size_t i = 0; i < craters.size(); ++i) {
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t j = 0; j < craters.size(); ++j)
      if (j != i && craters[j].radius >= 0.8 * craters[i].radius)
        near.emplace_back((craters[j].at - craters[i].at).norm(), j);
    std::ranges::sort(near);
    while (!near.empty() && (near.size() > 6 || near.back().first > 0.5 * 1737400)) near.pop_back();
    for (std::size_t a = 0; a < near.size(); ++a)
      for (std::size_t b = a + 1; b < near.size(); ++b) {
        std::array<std::size_t, 3> t{i, near[a].second, near[b].second};
        const Eigen::Vector3d ab = craters[t[1]].at - craters[i].at, ac = craters[t[2]].at - craters[i].at;
        const double longest = std::max({ab.norm(), ac.norm(), (ab - ac).norm()});
        if (longest > 0.5 * 1737400 || !(ab.cross(ac).norm() > 0.05 * longest * longest)) continue;
        std::ranges::sort(t);
        expected.insert(t);
      }
  }
  EXPECT_EQ(index.triangles(), expected.size());
}

/// Slow twin: every pair of detections is every pair of craters, and the craters that fit are counted.
struct Place {
  std::complex<double> factor;
  Eigen::Vector3d ground;
  int matched = 0;
};
Place place_by_all_pairs(const std::vector<ImageCrater>& seen, const std::vector<BodyCrater>& map,
                         const Body& body) {
  const BodySurface surface(body);
  Place best;
  const auto image = [&](std::size_t i) { return std::complex(seen[i].at.x(), -seen[i].at.y()); };
  for (std::size_t a = 0; a < map.size(); ++a) {
    const Eigen::Vector3d up = surface.up(map[a].at), east = Eigen::Vector3d::UnitZ().cross(up).normalized(),
                          north = up.cross(east);
    std::vector<std::size_t> near;
    std::vector<std::complex<double>> flat;
    for (std::size_t b = 0; b < map.size(); ++b) {
      const Eigen::Vector3d d = map[b].at - map[a].at;
      if (d.norm() < 0.3 * surface.radius()) near.push_back(b), flat.emplace_back(east.dot(d), north.dot(d));
    }
    for (std::size_t k = 0; k < near.size(); ++k)
      for (std::size_t i = 0; i < std::min<std::size_t>(10, seen.size()); ++i)
        for (std::size_t j = 0; j < std::min<std::size_t>(10, seen.size()); ++j) {
          if (i == j || near[k] == a) continue;
          const std::complex<double> factor = flat[k] / (image(j) - image(i));
          const double scale = std::abs(factor);
          if (std::abs(std::log(map[a].radius / scale / seen[i].radius)) > 0.35 ||
              std::abs(std::log(map[near[k]].radius / scale / seen[j].radius)) > 0.35)
            continue;
          int matched = 0;
          for (std::size_t m = 0; m < seen.size(); ++m) {
            const std::complex<double> at = factor * (image(m) - image(i));
            for (std::size_t n = 0; n < near.size(); ++n)
              if (std::abs(flat[n] - at) < 12 * scale &&
                  std::abs(std::log(map[near[n]].radius / scale / seen[m].radius)) < 0.35) {
                ++matched;
                break;
              }
          }
          if (matched <= best.matched) continue;
          const std::complex<double> middle = -factor * image(i);
          best = {factor, surface.nearest(map[a].at + middle.real() * east + middle.imag() * north), matched};
        }
  }
  return best;
}

TEST(CraterIndex, AgreesWithTryingAllPairs) {
  const auto craters = made_craters(400, 15000, moon(), 8);
  const CraterIndex index(craters, moon());
  const CraterSensor how{.focal = 0, .detected = 0.9, .false_fraction = 0.15, .outliers = 0};
  Random random(17);
  int compared = 0;
  for (int i = 0; compared < 3 && i < 50; ++i) {
    const ImagePose pose = anywhere(moon(), 1000, how, random);
    const MadeCraterImage made = look_down(craters, moon(), pose, how, random);
    if (made.craters.size() < 9) continue;
    ++compared;
    const CraterAnswer answer = index.find(
        {.craters = made.craters, .size = Eigen::Vector2d::Constant(how.side), .camera = GroundCamera()});
    const Place slow = place_by_all_pairs(made.craters, craters, moon());
    ASSERT_TRUE(answer.fix) << answer.reason << " with " << made.craters.size() << " craters";
    EXPECT_LT((answer.fix->pose.ground - slow.ground).norm(),
              40e3);  // of pixels of 1 km, two craters against all
    EXPECT_NEAR(answer.fix->pose.log_scale, std::log(std::abs(slow.factor)), 0.08);
    EXPECT_GE(answer.fix->matched, slow.matched - 2);
  }
  EXPECT_EQ(compared, 3);
}

class WholeMoon : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    craters_ = new std::vector<BodyCrater>(made_craters(100000, 2000, moon(), 1));
    Random random(2, "survey");
    index_ = new CraterIndex(surveyed(*craters_, moon(), random), moon());
  }
  static void TearDownTestSuite() {
    delete index_;
    delete craters_;
  }
  static inline std::vector<BodyCrater>* craters_ = nullptr;
  static inline CraterIndex* index_ = nullptr;
};

TEST_F(WholeMoon, FindsImagesOfUnknownScaleAnywhere) {
  const Found f = locate({*index_, *craters_, moon(), {}, 150, 900}, 40, 101, {});
  report("unknown scale", *index_, f);
  EXPECT_GE(f.right, 37);
  EXPECT_EQ(f.wrong, 0);
  EXPECT_EQ(f.invented, 0);
}

TEST_F(WholeMoon, FindsOrthophotos) {
  const Found f = locate({*index_, *craters_, moon(), {.focal = 0}, 150, 500}, 24, 102, {});
  report("orthophotos", *index_, f);
  EXPECT_GE(f.right, 22);
  EXPECT_EQ(f.wrong, 0);
  EXPECT_EQ(f.invented, 0);
}

// Images of a few craters: most of the best candidates are unsure.
TEST_F(WholeMoon, TheProbabilityOfBeingWrongIsHonest) {
  const Found f = locate({*index_, *craters_, moon(), {}, 150, 400, 7, 12}, 80, 103, {});
  report("few craters", *index_, f);
  EXPECT_EQ(f.wrong, 0);
  EXPECT_EQ(f.invented, 0);
  EXPECT_GE(f.predicted, 0.8 * f.weak_wrong - 3);
}

TEST(CraterIndex, SaysWhyNot) {
  const CraterIndex none(std::vector<BodyCrater>{}, moon());
  EXPECT_EQ(none.find({}).reason, "the map has too few craters");
  const auto craters = made_craters(200, 20000, moon(), 3);
  const CraterIndex index(craters, moon());
  EXPECT_EQ(index.find({}).reason, "too few craters in the image");
  std::vector<ImageCrater> bad(9, ImageCrater{{NAN, 0}, 3});
  EXPECT_EQ(index.find({.craters = bad}).reason, "too few craters in the image");
  for (std::size_t i = 0; i < bad.size(); ++i) bad[i] = {{10.0 * double(i), 5}, 3};  // on a line
  EXPECT_EQ(index.find({.craters = bad}).reason, "no position has such craters");
  EXPECT_THROW(CraterIndex({{Eigen::Vector3d::UnitX(), -1, 0}}, moon()), std::invalid_argument);
}

}  // namespace
}  // namespace waymark::test
