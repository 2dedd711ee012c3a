// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/merging_by_cells.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "core/random.hpp"
#include "tests/pipeline/fusion/made_objects.hpp"

namespace waymark::test {
namespace {

TypeRegistry all_types() {
  TypeRegistry types;
  register_landmark_types(types);
  return types;
}

std::size_t below(Random& random, std::size_t end) {
  return std::min(static_cast<std::size_t>(random.uniform(0, static_cast<double>(end))), end - 1);
}

struct Scene {
  std::uint64_t seed = 0;
  std::uint32_t things = 200, images = 4;
  double spacing = 3;
  bool degrees = false;
};

// Rocks, poles without a body's size, doubles within one image, identical copies, rejected observations, and
// a few positions so uncertain that they reach across the scene. In degrees the scene lies on the
// antimeridian.
std::vector<Observation> made_observations(const Scene& scene) {
  const TypeRegistry types = all_types();
  Random random(scene.seed, "cells");
  std::vector<Observation> all;
  for (const ObservedObject& s :
       made_objects(
           {.seed = scene.seed, .things = scene.things, .images = scene.images, .spacing = scene.spacing})
           .seen) {
    Observation o;
    o.type = types.id(random.bernoulli(0.8) ? "rock" : "mountain_top");
    o.source = "image_" + std::to_string(s.source);
    o.position.xyz << s.at, random.uniform(0, 2);
    if (scene.degrees)
      o.position.xyz.head<2>() << std::remainder(180 + (s.at.x() - 20) * 1e-5, 360.0), 60 + s.at.y() * 1e-5;
    o.covariance.topLeftCorner<2, 2>() = s.covariance;
    o.covariance(2, 2) = 0.01;
    if (random.bernoulli(0.01)) o.covariance.topLeftCorner<2, 2>() *= 100;
    if (random.bernoulli(0.05)) o.rejected = "too dark";
    o.confidence = random.uniform(0.2, 1);
    const double radius = std::exp(s.log_size);
    o.features.resize(types[o.type].features.size());
    o.features[0] = {radius, radius * radius * s.log_size_variance, 1};
    all.push_back(o);
    if (random.bernoulli(0.1)) o.position.xyz.x() += scene.degrees ? 1e-7 : 0.01, all.push_back(o);
    if (random.bernoulli(0.05)) all.push_back(all.back());
  }
  return all;
}

ObservationStream stream_of(const std::vector<Observation>& all, std::size_t batch) {
  const auto batches = [&all, batch](const auto& take) {
    for (std::size_t begin = 0; begin < all.size(); begin += batch)
      take(std::vector<Observation>(
          all.begin() + static_cast<std::ptrdiff_t>(begin),
          all.begin() + static_cast<std::ptrdiff_t>(std::min(begin + batch, all.size()))));
  };
  return {batches, batches};
}

// Bytes of a result in one order: landmarks by uid, evidence by content.
struct Bytes {
  std::string landmarks, evidence;
  friend bool operator==(const Bytes&, const Bytes&) = default;
};

Bytes bytes_of(std::vector<Landmark> landmarks, std::vector<Observation> evidence) {
  std::ranges::sort(landmarks, {}, &Landmark::uid);
  std::ranges::sort(evidence, comes_before);
  return {Codec<std::vector<Landmark>>::encode(landmarks), Codec<std::vector<Observation>>::encode(evidence)};
}

Bytes merged_at_once(const std::vector<Observation>& all, const Crs& crs, const MergeRules& rules) {
  MergedObservations merged = merge_observations(all, all_types(), crs, rules);
  return bytes_of(std::move(merged.landmarks), std::move(merged.evidence));
}

Bytes merged_by_cells(const ObservationStream& stream, const Crs& crs, const MergeRules& rules,
                      std::size_t max_in_cell) {
  const MergedParts merged = merge_by_cells(stream, all_types(), crs, rules, {.max_in_cell = max_in_cell});
  std::vector<Landmark> landmarks;
  std::vector<Observation> evidence;
  for (std::size_t part = 0; part < merged.landmarks.count(); ++part) {
    std::set<std::string> own;
    for (Landmark& landmark : merged.landmarks.read(part)) {
      own.insert(landmark.uid);
      landmarks.push_back(std::move(landmark));
    }
    for (Observation& o : merged.evidence.read(part)) {
      EXPECT_TRUE(!o.rejected.empty() || own.contains(o.landmark_uid)) << "evidence of another part";
      evidence.push_back(std::move(o));
    }
  }
  return bytes_of(std::move(landmarks), std::move(evidence));
}

TEST(MergeByCells, GivesTheBytesOfMergingAtOnce) {
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const Scene scene{.seed = seed,
                      .things = seed % 3 == 0 ? 30u : 200u,
                      .images = 2 + static_cast<std::uint32_t>(seed % 4),
                      .spacing = seed % 2 == 0 ? 3.0 : 1.2,  // crowded: groups of tens of objects
                      .degrees = seed % 5 == 4};
    const Crs crs = scene.degrees ? Crs::from_text("EPSG:4326") : Crs::local();
    std::vector<Observation> all = made_observations(scene);
    MergeRules rules;
    if (seed % 4 == 1) rules.association.overlap = 0.1;
    const Bytes expected = merged_at_once(all, crs, rules);
    Random random(seed, "order");
    for (const std::size_t max_in_cell :
         {std::size_t{1}, std::size_t{7}, std::size_t{60}, std::size_t{100000}}) {
      for (std::size_t i = all.size(); i > 1; --i) std::swap(all[i - 1], all[below(random, i)]);
      const std::size_t batch = 1 + below(random, all.size());
      EXPECT_EQ(merged_by_cells(stream_of(all, batch), crs, rules, max_in_cell), expected)
          << "seed " << seed << ", cells of " << max_in_cell << ", batches of " << batch;
    }
  }
}

TEST(MergeByCells, DoesNotDependOnThreads) {
  const std::vector<Observation> all = made_observations({.seed = 99, .things = 2000});
  const auto merged = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return merged_by_cells(stream_of(all, 100), Crs::local(), {}, 200);
  };
  EXPECT_EQ(merged(1), merged(4));
}

TEST(MergeByCells, CountsWhatItRejects) {
  const std::vector<Observation> all = made_observations({.seed = 5, .spacing = 1.2});
  const MergedObservations expected = merge_observations(all, all_types(), Crs::local());
  const MergedParts merged =
      merge_by_cells(stream_of(all, 50), all_types(), Crs::local(), {}, {.max_in_cell = 20});
  const auto accepted = [](const std::vector<Observation>& some) {
    return std::ranges::count(some, std::string(), &Observation::rejected);
  };
  EXPECT_EQ(merged.in, accepted(all));
  EXPECT_EQ(merged.out, accepted(expected.evidence));
  EXPECT_EQ(merged.rejected.at("seen twice in one image"), merged.in - merged.out);
  EXPECT_GT(merged.in, merged.out);
}

// Two summits a millimetre apart share the uid, whichever cells they are in.
TEST(MergeByCells, NumbersEqualUidsOfDifferentCells) {
  const TypeRegistry types = all_types();
  std::vector<Observation> all;
  for (int i = 0; i < 6; ++i) {
    Observation o;
    o.type = types.id("mountain_top");
    o.source = "survey";
    o.position.xyz << 7 + 0.001 * (i / 2), 3 + 100.0 * (i % 2), 0;
    o.covariance = Eigen::Matrix3d::Identity() * 1e-6;
    all.push_back(o);
  }
  const Bytes expected = merged_at_once(all, Crs::local(), {});
  EXPECT_NE(expected.landmarks.find("-3"), std::string::npos);
  EXPECT_EQ(merged_by_cells(stream_of(all, 2), Crs::local(), {}, 1), expected);
}

TEST(MergeByCells, NothingGivesOneEmptyPart) {
  const MergedParts merged = merge_by_cells(stream_of({}, 1), all_types(), Crs::local());
  ASSERT_EQ(merged.landmarks.count(), 1u);
  EXPECT_TRUE(merged.landmarks.read(0).empty());
  EXPECT_EQ(merged.in, 0);
}

}  // namespace
}  // namespace waymark::test
