// SPDX-License-Identifier: Apache-2.0
// One landmark of two maps: against the merge of all observations at once.
#include "pipeline/fusion/valuation/landmark_fusion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.hpp"
#include "pipeline/fusion/association/merging.hpp"
#include "pipeline/fusion/valuation/common_errors.hpp"
#include "tests/pipeline/fusion/own_types.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

const TypeId kRockId = kTypes.id("rock");

Observation rock_in(int image, Random& random) {
  Observation o;
  o.type = kRockId;
  o.source = "image " + std::to_string(image);
  o.position.xyz << random.normal(10, 0.1), random.normal(20, 0.1), 0;
  o.covariance = Eigen::Vector3d(0.01, 0.01, 0.04).asDiagonal();
  o.confidence = 0.8;
  o.features.resize(kTypes[kRockId].features.size());
  o.features[0] = {random.normal(1, 0.05), 0, 1};
  return o;
}

/// Returns the rock that these observations show.
Landmark rock_of(std::vector<Observation> seen) {
  Landmark rock = merge_observations(std::move(seen), kTypes, Crs::local()).landmarks.at(0);
  for (std::size_t f = 0; f < rock.features.size(); ++f) {
    const FeatureSpec& spec = kTypes[kRockId].features[f];
    rock.quality.feature_confidences[f] = spread_confidence(rock.features[f], spec.scale, spec.reference);
  }
  rock.quality.visible = rock.quality.seen;
  rock.confidence = 0.8;
  return rock;
}

class LandmarkFusion : public ::testing::Test {
 protected:
  LandmarkFusion() {
    Random random(3, "landmark fusion");
    for (int i = 0; i < 7; ++i) all_.push_back(rock_in(i, random));
    a_ = rock_of({all_.begin(), all_.begin() + 3});
    b_ = rock_of({all_.begin() + 3, all_.end()});
  }
  Landmark fuse(const CommonEvidence& common = {}) const {
    return fuse_landmarks(a_, b_, common, kTypes, Crs::local());
  }

  std::vector<Observation> all_;
  Landmark a_, b_;
};

TEST_F(LandmarkFusion, IsTheMergeOfAllObservations) {
  const Landmark fused = fuse(), whole = rock_of(all_);
  EXPECT_NEAR(fused.features[0].value, whole.features[0].value, 1e-12);
  EXPECT_NEAR(fused.features[0].variance, whole.features[0].variance, 1e-12);
  EXPECT_EQ(fused.features[0].observations, 7);
  EXPECT_NEAR(fused.quality.feature_confidences[0].value(), whole.quality.feature_confidences[0].value(),
              1e-12);
  EXPECT_EQ(fused.quality.seen, 7);
  EXPECT_EQ(fused.observations, 7);
  EXPECT_LT((fused.position.xyz - whole.position.xyz).norm(), 0.03) << "a seventh more weight for map a";
  EXPECT_NEAR(fused.covariance(0, 0), whole.covariance(0, 0), 0.2 * whole.covariance(0, 0));
  EXPECT_EQ(fused.uid, b_.uid) << "that with more observations";
  EXPECT_GT(fused.confidence, 0.8);
}

TEST_F(LandmarkFusion, DoesNotDependOnTheOrderButForTies) {
  const Landmark ab = fuse(), ba = fuse_landmarks(b_, a_, {}, kTypes, Crs::local());
  EXPECT_LT((ab.position.xyz - ba.position.xyz).norm(), 1e-12);
  EXPECT_LT((ab.covariance - ba.covariance).norm(), 1e-12);
  EXPECT_NEAR(ab.features[0].variance, ba.features[0].variance, 1e-12);
  EXPECT_EQ(ab.uid, ba.uid);
  EXPECT_DOUBLE_EQ(ab.confidence, ba.confidence);
}

TEST_F(LandmarkFusion, CommonObservationsMakeNothingSurer) {
  const Landmark fused = fuse({.observations = 1, .sources = 1});
  const double sharper = std::min(a_.covariance.determinant(), b_.covariance.determinant());
  EXPECT_GE(fused.covariance.determinant(), sharper);
  EXPECT_EQ(fused.quality.seen, 6);
  EXPECT_EQ(fused.observations, 6);
  EXPECT_DOUBLE_EQ(fused.confidence, 0.8);
}

TEST_F(LandmarkFusion, MissesOfOneImageCountOnce) {
  a_.quality.visible += 2;
  b_.quality.visible += 3;
  EXPECT_EQ(fuse().quality.visible, 7 + 5);
  EXPECT_EQ(fuse({.missed = 2}).quality.visible, 7 + 3);
  EXPECT_EQ(fuse({.missed = 9}).quality.visible, 7 + 3) << "not more than both missed";
  EXPECT_EQ(fuse({.found_by_b = 2}).quality.visible, 7 + 3) << "map b found it in the images that a missed";
}

TEST_F(LandmarkFusion, ErrorsThatAllImagesShareStay) {
  const double gsd = 0.1;
  add_common_errors(a_, kTypes[kRockId], gsd);
  add_common_errors(b_, kTypes[kRockId], gsd);
  Landmark whole = rock_of(all_);
  add_common_errors(whole, kTypes[kRockId], gsd);
  EXPECT_NEAR(fuse({.finest_gsd = gsd}).features[0].variance, whole.features[0].variance, 1e-9);
}

TEST_F(LandmarkFusion, AnUnknownCovarianceHasNoSay) {
  const Eigen::Matrix3d unknown = Eigen::Matrix3d::Constant(std::nan(""));
  a_.covariance = unknown;
  EXPECT_EQ(fuse().position.xyz, b_.position.xyz);
  EXPECT_EQ(fuse().covariance, b_.covariance);
  b_.covariance = unknown;
  EXPECT_TRUE(std::isnan(fuse().covariance(0, 0)));
  EXPECT_TRUE(fuse().position.xyz.allFinite());
}

}  // namespace
}  // namespace waymark::test
