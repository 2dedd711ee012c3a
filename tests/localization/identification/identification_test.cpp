// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/identification.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "localization/chi_square.hpp"
#include "localization/filters/resampling.hpp"
#include "localization/filters/sighting_score.hpp"
#include "localization/identification/assignment.hpp"
#include "localization/identification/joint_search.hpp"
#include "localization/identification/landmark_window.hpp"
#include "tests/localization/made_types.hpp"
#include "tests/localization/made_world.hpp"

namespace waymark::test {
using namespace localization;
namespace {

TEST(ChiSquare, TablesAgree) {
  EXPECT_NEAR(chi_square_quantile(0.99, 2), 9.21034, 1e-5);
  EXPECT_NEAR(chi_square_quantile(0.95, 1), 3.84146, 1e-5);
  EXPECT_NEAR(chi_square_quantile(0.975, 100), 129.5612, 1e-4);
}

// Slow twin: maps of one landmark, where nothing but its gate excludes it, and a remote one that makes the
// search as wide.
TEST(Candidates, AreThoseOfEachLandmarkAlone) {
  std::size_t found = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed, "candidates");
    auto all = scatter_landmarks(200, 40, seed, 0.1);
    for (MapLandmark& l : all) {
      l.type = static_cast<TypeId>(random.uniform_index(2));
      l.features.value[0] = random.uniform(0.5, 1);
      l.paper_quality = random.uniform(0.05, 1);
      const double sd = random.log_uniform(0.01, 1), other = random.log_uniform(0.01, 1);
      const double along = random.uniform(-1, 1) * sd * other;
      l.covariance << sd * sd, along, along, other * other;
    }
    const LandmarkGrid map(all);
    const FeatureScales scales;
    IdentificationOptions options{.use_identities = false, .quality = seed % 3 ? "existence" : "paper"};
    options.distance = seed % 7 ? "mahalanobis" : "paper";
    options.bearing_reach = 30;
    SeenLandmark s = seen_at(random.log_uniform(0.01, 20), random.uniform(-3, 3));
    s.bearing_sd = random.log_uniform(0.001, 1);
    if (random.bernoulli(0.3)) s.range.reset();
    if (random.bernoulli(0.7)) s.type = TypeId{0}, s.features.value[0] = 0.7, s.features.variance[0] = 0.01;
    const Pose2 mount{random.normal(), 0.3, random.uniform(-3, 3)};
    PoseEstimate robot{{random.uniform(-15, 15), random.uniform(-15, 15), random.uniform(-3, 3)}, {}};
    const Eigen::Vector3d sd(random.log_uniform(0.01, 3), random.log_uniform(0.01, 3),
                             random.log_uniform(0.001, 0.5));
    robot.covariance = sd.cwiseAbs2().asDiagonal();
    robot.covariance(0, 2) = robot.covariance(2, 0) = random.uniform(-1, 1) * sd[0] * sd[2];

    MapLandmark remote = landmark_at(1e6, 0, 1000);
    remote.covariance = map.largest_sd() * map.largest_sd() * Eigen::Matrix2d::Identity();
    remote.paper_quality = map.min_quality();
    std::vector<double> together, alone;
    for (const CandidatePair& p : candidates(s, mount, robot, map, scales, options).pairings)
      together.push_back(p.score);
    for (const MapLandmark& l : all)
      for (const CandidatePair& p :
           candidates(s, mount, robot, LandmarkGrid({l, remote}), scales, options).pairings)
        alone.push_back(p.score);
    std::ranges::sort(alone);
    ASSERT_EQ(together, alone) << "seed " << seed;
    found += alone.size();
  }
  EXPECT_GT(found, 1000u);
}

TEST(LandmarkGrid, FindsWhatAnExhaustiveSearchFinds) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(seed, "queries");
    const auto all = scatter_landmarks(seed % 5 ? 300 : 1, seed % 3 ? 40 : 0.001, seed);
    const LandmarkGrid grid(all, seed % 7 ? 0 : 3);
    for (int q = 0; q < 40; ++q) {
      const Eigen::Vector2d at(random.uniform(-30, 30), random.uniform(-30, 30));
      const double radius = random.uniform(0, 25);
      std::set<LandmarkKey> found, expected;
      grid.near(at, radius, [&](std::uint32_t i) { EXPECT_TRUE(found.insert(grid[i].key).second); });
      for (const MapLandmark& l : all)
        if ((l.at - at).squaredNorm() <= radius * radius) expected.insert(l.key);
      ASSERT_EQ(found, expected) << "seed " << seed;
    }
  }
}

TEST(LandmarkWindow, AnswersAsTheWholeMapDoes) {
  const auto all = scatter_landmarks(2000, 400, 1);
  const LandmarkGrid whole(all);
  int reads = 0;
  LandmarkWindow window(
      [&](const Eigen::AlignedBox2d& box) {
        ++reads;
        return landmarks_in(box, all);
      },
      30);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector2d at(-150 + 1.5 * i, 20);
    std::set<LandmarkKey> a, b;
    const LandmarkGrid& near = window.landmarks_near(at, 20);
    near.near(at, 20, [&](std::uint32_t k) { a.insert(near[k].key); });
    whole.near(at, 20, [&](std::uint32_t k) { b.insert(whole[k].key); });
    ASSERT_EQ(a, b);
  }
  EXPECT_LT(reads, 12);
}

/// The cheapest of all assignments, by trying them all.
double cheapest(const std::vector<std::vector<Choice>>& rows, double none, std::size_t row,
                std::set<int>& taken) {
  if (row == rows.size()) return 0;
  double best = none + cheapest(rows, none, row + 1, taken);
  for (const Choice& c : rows[row])
    if (taken.insert(c.column).second) {
      best = std::min(best, c.cost + cheapest(rows, none, row + 1, taken));
      taken.erase(c.column);
    }
  return best;
}

TEST(AssignCheapest, IsTheBestOfAll) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    Random random(seed);
    std::vector<std::vector<Choice>> rows(1 + random.uniform_index(5));
    for (auto& row : rows)
      for (int c = 0; c < 5; ++c)
        if (random.bernoulli(0.5)) row.push_back({c, random.uniform(-3, 9)});
    const auto chosen = assign_cheapest(rows, 6);
    double total = 0;
    std::set<int> taken;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      total += chosen[r] ? rows[r][*chosen[r]].cost : 6;
      if (chosen[r]) {
        EXPECT_TRUE(taken.insert(rows[r][*chosen[r]].column).second);
      }
    }
    taken.clear();
    ASSERT_NEAR(total, cheapest(rows, 6, 0, taken), 1e-9) << "seed " << seed;
  }
}

// Two landmarks abreast, the robot's heading uncertain: each sighting for itself is nearest to the left one,
// but together they fit only one way.
TEST(Identify, JointAssociationsUseTheSharedHeading) {
  const LandmarkGrid map({landmark_at(10, 0, 1), landmark_at(10, 1, 2), landmark_at(10, -8, 3)});
  PoseEstimate robot;
  robot.covariance = Eigen::Vector3d(1e-4, 1e-4, 0.01).asDiagonal();
  const double turn = 0.07;  // the real heading is 0.07 rad to the right
  SightingSet seen{{}, {}};
  for (const auto& at : {Eigen::Vector2d(10, 0), Eigen::Vector2d(10, 1), Eigen::Vector2d(10, -8)})
    seen.sightings.push_back(seen_at(at.norm(), std::atan2(at.y(), at.x()) + turn));
  for (const char* association : {"jcbb", "joint"}) {
    IdentificationOptions options;
    options.association = association;
    const auto matches = identify(seen, robot, map, {}, options).matches;
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_EQ(matches[i].verdict, Verdict::matched) << association << i;
      EXPECT_EQ(map[matches[i].pairing.landmark].key, i + 1) << association;
    }
  }
}

// The slow twin: every way to pair the set, none left out before its probability is known.
TEST(Identify, JointHypothesesAreThoseOfASearchOfAll) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed, "joint");
    const auto all = scatter_landmarks(30, 8, seed, 0.1);
    const LandmarkGrid map(all);
    const PoseEstimate robot{{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-3, 3)},
                             Eigen::Vector3d(0.2, 0.2, 0.03).asDiagonal()};
    SightingSet seen;
    std::vector<Candidates> sets;
    const IdentificationOptions options;
    for (int i = 0; i < 4; ++i) {
      seen.sightings.push_back(seen_at(random.uniform(1, 5), random.uniform(-1, 1)));
      sets.push_back(candidates(seen.sightings.back(), {}, robot, map, FeatureScales{}, options));
      if (sets.back().pairings.size() > 5) sets.back().pairings.resize(5);
    }
    std::vector<std::pair<double, JointChoice>> expected;
    JointChoice choice(4, -1);
    const auto go = [&](const auto& self, std::size_t depth, const JointEvidence& e, double weight) -> void {
      if (depth == 4) {
        const JointDistance d = joint_distance(e, robot.covariance);
        const double density =
            e.rows ? -(d.squares + d.log_det + e.rows * std::log(2 * std::numbers::pi)) / 2 : 0;
        expected.emplace_back(weight + density, choice);
        return;
      }
      for (std::size_t i = 0; i < sets[depth].pairings.size(); ++i) {
        const CandidatePair& p = sets[depth].pairings[i];
        bool taken = false;
        for (std::size_t k = 0; k < depth; ++k)
          taken =
              taken || (choice[k] >= 0 && sets[k].pairings[std::size_t(choice[k])].landmark == p.landmark);
        if (taken) continue;
        choice[depth] = int(i);
        self(self, depth + 1, e + p.evidence, weight + std::log(map[p.landmark].quality) - p.features / 2);
      }
      choice[depth] = -1;
      self(self, depth + 1, e,
           weight + std::log(options.clutter) -
               (sets[depth].pairings.empty() ? 0 : 0.5 * sets[depth].pairings[0].feature_count));
    };
    go(go, 0, {}, 0);
    double best = -1e300;
    for (const auto& [weight, how] : expected) best = std::max(best, weight);
    std::erase_if(expected, [&](const auto& h) { return h.first < best - 14; });
    const auto found = joint_hypotheses(sets, seen, map, robot.covariance, options);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->size(), expected.size()) << seed;
    for (const JointHypothesis& h : *found) {
      const auto twin = std::ranges::find(expected, h.choice, [](const auto& e) { return e.second; });
      ASSERT_NE(twin, expected.end()) << seed;
      EXPECT_NEAR(h.log_weight, twin->first, 1e-9);
    }
  }
}

// Seen by the one image that covers it, a landmark would have quality 1 by eq. 7 and outrank all others.
TEST(MapLandmark, AnUnassessedQualityOutranksNoWellObservedOne) {
  TypeRegistry types;
  register_landmark_types(types);
  const LandmarkType& rock = types[types.id("rock")];
  const auto quality = [&](int seen, int visible, std::optional<double> confidence) {
    Landmark l;
    l.type = types.id("rock");
    l.quality = {.seen = seen, .visible = visible, .feature_confidences = {confidence}};
    return map_landmark(l, rock, LocalFrame(Crs::local(), {})).paper_quality;
  };
  EXPECT_DOUBLE_EQ(quality(8, 10, 0.8), 0.64);  // eq. 8
  EXPECT_LT(quality(1, 1, {}), quality(8, 10, 0.8));
  EXPECT_DOUBLE_EQ(quality(1, 1, {}), kUnassessedQuality);
  EXPECT_DOUBLE_EQ(quality(0, 0, {}), 1) << "a map without counts is surveyed";
}

TEST(Identify, QualityFloorOfOneSwitchesQualityOff) {
  IdentificationOptions options;
  options.quality_floor = 1;
  const auto log_weights = [&](double quality) {
    MapLandmark near = landmark_at(10, 0.1, 1), far = landmark_at(10, -0.2, 2);
    near.quality = quality;
    const LandmarkGrid map({near, far});
    const SightingSet seen{{}, {seen_at(10, 0)}};
    const std::vector<Candidates> sets{candidates(seen.sightings[0], {}, {}, map, {}, options)};
    const auto hypotheses = joint_hypotheses(sets, seen, map, Eigen::Matrix3d::Zero(), options);
    std::vector<double> all;
    for (const JointHypothesis& h : hypotheses.value()) all.push_back(h.log_weight);
    return all;
  };
  EXPECT_EQ(log_weights(0.05), log_weights(1));
  options.quality_floor = 0.1;
  EXPECT_NE(log_weights(0.05), log_weights(1));
}

TEST(Identify, MutualExclusion) {
  const LandmarkGrid map({landmark_at(10, 0, 1)});
  const SightingSet twice{{}, {seen_at(10, 0), seen_at(10.1, 0.01)}};
  IdentificationOptions options;
  const auto count = [&](const char* association) {
    options.association = association;
    return std::ranges::count(identify(twice, {}, map, {}, options).matches, Verdict::matched,
                              &Match::verdict);
  };
  EXPECT_EQ(count("nearest"), 2) << "eq. 10 lets both have it";
  EXPECT_EQ(count("greedy"), 1);
  EXPECT_EQ(count("hungarian"), 1);
  EXPECT_EQ(count("jcbb"), 1);
  EXPECT_LE(count("joint"), 1);
}

TEST(Identify, SaysWhyNot) {
  MapLandmark rock = landmark_at(10, 0, 1);
  rock.features.value[0] = 1;
  const LandmarkGrid map({rock});
  const auto verdict = [&](SeenLandmark s) {
    IdentificationOptions options;
    return identify({{}, {s}}, {}, map, {}, options).matches[0].verdict;
  };
  SeenLandmark s = seen_at(10, 0);
  s.type = TypeId{0};
  EXPECT_EQ(verdict(s), Verdict::matched);
  s.features.value[0] = 3;  // three times as wide
  EXPECT_EQ(verdict(s), Verdict::features_differ);
  s.type = TypeId{1};
  EXPECT_EQ(verdict(s), Verdict::nothing_near);
  s.type = kNoSuchType;
  EXPECT_EQ(verdict(s), Verdict::unknown_type);
  EXPECT_EQ(verdict(seen_at(30, 0)), Verdict::nothing_near);
  EXPECT_EQ(verdict(seen_at(10.35, 0)), Verdict::too_far);
  s = seen_at(10, 0);
  s.identity = 99;
  EXPECT_EQ(verdict(s), Verdict::unknown_type);
}

TEST(Identify, TwinsAreAmbiguousUntilFeaturesDiffer) {
  MapLandmark small = landmark_at(10, 0.1, 1), large = landmark_at(10, -0.1, 2);
  small.features.value[0] = 0.3;
  large.features.value[0] = 0.6;
  const LandmarkGrid map({small, large});
  PoseEstimate robot;
  robot.covariance = Eigen::Vector3d(0.04, 0.04, 1e-4).asDiagonal();
  SeenLandmark s = seen_at(10, 0);
  s.type = TypeId{0};
  EXPECT_EQ(identify({{}, {s}}, robot, map, {}, {}).matches[0].verdict, Verdict::ambiguous);
  s.features.value[0] = 0.6;
  const auto matches = identify({{}, {s}}, robot, map, {}, {}).matches;
  ASSERT_EQ(matches[0].verdict, Verdict::matched);
  EXPECT_EQ(map[matches[0].pairing.landmark].key, 2u);
}

// A landmark with fewer known features must not win by that.
TEST(Identify, MissingFeaturesNeitherHelpNorHurt) {
  MapLandmark known = landmark_at(10, 0.05, 1), bare = landmark_at(10, -0.05, 2);
  known.features.value[0] = 0.5;
  const LandmarkGrid map({known, bare});
  SeenLandmark s = seen_at(10, 0);
  s.type = TypeId{0};
  s.features.value[0] = 0.5;  // fits exactly
  IdentificationOptions options;
  options.association = "nearest";
  const auto matches = identify({{}, {s}}, {}, map, {}, options).matches;
  EXPECT_EQ(map[matches[0].pairing.landmark].key, 1u);
}

TEST(Identify, WedgeOfABearingFindsWhatASearchOfAllFinds) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed, "wedge");
    const auto all = scatter_landmarks(200, 150, seed);
    const LandmarkGrid map(all);
    PoseEstimate robot{{random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-3, 3)}, {}};
    robot.covariance =
        Eigen::Vector3d(random.uniform(0, 4), random.uniform(0, 4), random.uniform(0, 0.02)).asDiagonal();
    SeenLandmark s;
    s.bearing = random.uniform(-3, 3);
    s.bearing_sd = random.uniform(0.001, 0.1);
    IdentificationOptions options;
    options.bearing_reach = 60;
    std::set<LandmarkKey> found, expected;
    for (const CandidatePair& p : candidates(s, {}, robot, map, {}, options).pairings)
      found.insert(map[p.landmark].key);
    for (const MapLandmark& l : all) {
      const double range = (l.at - robot.pose.at()).norm();
      if (range > 59 || range < 8) continue;  // near the apex and the rim the gate is not linear
      const auto e = evidence_of(s, expect(robot.pose, {}, l.at), l.covariance);
      if (joint_distance(e, robot.covariance).squares <= chi_square_quantile(0.99, 1)) expected.insert(l.key);
    }
    EXPECT_TRUE(std::ranges::includes(found, expected)) << "seed " << seed;
  }
}

// The gate divides the noise by quality, so that a doubtful landmark may lie farther away; the search must
// look as far.
TEST(Identify, SearchReachesWhatTheGateOfADoubtfulLandmarkAdmits) {
  MapLandmark doubtful = landmark_at(10, 0, 1);
  doubtful.paper_quality = 0.1;
  const LandmarkGrid map({doubtful});
  IdentificationOptions options;
  options.quality = "paper";
  options.gate = 0.9999;  // 4.29 standard deviations, of 0.1 m / sqrt(0.1): 1.36 m
  SeenLandmark s = seen_at(11.2, 0);
  s.bearing_sd = 0.001;
  const auto found = candidates(s, {}, {}, map, {}, options);
  ASSERT_EQ(found.pairings.size(), 1u);
  const double variance = (0.1 * 0.1 + map[0].covariance(0, 0)) / 0.1;
  EXPECT_NEAR(found.pairings[0].squares, 1.2 * 1.2 / variance, 1e-9);
}

// A map states an axis clockwise from north, a sensor from its own x axis to the left.
TEST(Identify, AxesAreSeenInTheFrameOfTheSensor) {
  const FeatureScales scales(ellipses());
  MapLandmark ellipse = landmark_at(0, 10, 1);
  ellipse.features.value[0] = 0.3;  // 0.3 rad east of north
  ellipse.features.variance[0] = 0.01;
  const LandmarkGrid map({ellipse});
  for (const double yaw : {0.0, 1.0, -2.5}) {
    const Pose2 robot{0, 0, yaw}, mount{0, 0, 0.4};
    SeenLandmark s = seen_at(10, std::numbers::pi / 2 - yaw - mount.yaw);
    s.type = TypeId{0};
    s.features.value[0] = std::numbers::pi / 2 - 0.3 - yaw - mount.yaw;
    s.features.variance[0] = 0.01;
    const auto features_at = [&](double seen) {
      s.features.value[0] = seen;
      return candidates(s, mount, {robot, Eigen::Matrix3d::Zero()}, map, scales, {});
    };
    const double right = s.features.value[0];
    ASSERT_EQ(features_at(right).pairings.size(), 1u) << yaw;
    EXPECT_NEAR(features_at(right).pairings[0].features, 0, 1e-9);
    EXPECT_EQ(features_at(right + 1.2).verdict, Verdict::features_differ) << yaw;
    SightingScore score({mount, {s}}, map, scales, {}, {.use_identities = false});  // 1.2 rad off
    const double wrong = score(robot);
    s.features.value[0] = right + std::numbers::pi;  // an axis has no head
    SightingScore same({mount, {s}}, map, scales, {}, {.use_identities = false});
    EXPECT_GT(same(robot), wrong + 3) << yaw;
    const double alone = same(robot);
    same.prefetch(std::vector<Pose2>{robot, robot});
    EXPECT_EQ(same(robot), alone);
  }
}

// Existence is the prior of a pairing and leaves the gate as it is; eq. 8 divides the noise.
TEST(Identify, ExistenceWeighsAndOnlyThePapersQualityWidensTheGate) {
  MapLandmark doubtful = landmark_at(10, 0, 1);
  doubtful.quality = doubtful.paper_quality = 0.2;
  const LandmarkGrid map({doubtful});
  IdentificationOptions options;
  EXPECT_EQ(noise_divisor(doubtful, options), 1);
  EXPECT_EQ(existence_prior(doubtful, options), 0.2);
  EXPECT_EQ(identify({{}, {seen_at(10.4, 0)}}, {}, map, {}, options).matches[0].verdict, Verdict::too_far);
  options.quality = "paper";
  EXPECT_EQ(noise_divisor(doubtful, options), 0.2);
  EXPECT_EQ(existence_prior(doubtful, options), 1);
  EXPECT_EQ(identify({{}, {seen_at(10.4, 0)}}, {}, map, {}, options).matches[0].verdict, Verdict::matched);
  // Of two landmarks as near, the one that exists is chosen, by every association.
  MapLandmark left = landmark_at(10, 0.1, 1), right = landmark_at(10, -0.1, 2);
  left.quality = 0.2, right.quality = 0.9;
  options = {};
  for (const char* association : {"nearest", "greedy", "hungarian", "joint"}) {
    options.association = association;
    const LandmarkGrid pair({left, right});
    const auto matches = identify({{}, {seen_at(10, 0)}}, {}, pair, {}, options).matches;
    ASSERT_EQ(matches[0].verdict, Verdict::matched) << association;
    EXPECT_EQ(pair[matches[0].pairing.landmark].key, 2u) << association;
  }
}

}  // namespace
}  // namespace waymark::test
