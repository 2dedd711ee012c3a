// SPDX-License-Identifier: Apache-2.0
// Recall of craters that overlap and of filled ones, beside that of isolated bowls.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

#include "pipeline/craters/find_craters.hpp"
#include "tests/pipeline/craters/placed_craters.hpp"
#include "tests/pipeline/craters/score_circles.hpp"
#include "tests/support/seed_offset.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

struct Recall {
  int found = 0, all = 0;
  double fraction() const { return all > 0 ? double(found) / all : 0; }
};

struct Outcome {
  std::map<Place, Recall> recall;
  double precision = 0;
};

/// Finds the craters of 16 px and more in scenes that no constant was chosen on.
Outcome search(PlacedScene (*scene_of)(std::uint64_t), std::uint64_t first, std::uint64_t count) {
  Outcome outcome;
  int hits = 0, false_alarms = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const PlacedScene scene = scene_of(seed + seed_offset());
    std::vector<CraterCandidate> found, truth;
    for (const Detection& d :
         find_craters(scene.image, {.sun_angle = scene.sun_angle, .min_confidence = 0.5}))
      found.push_back({d.outline.x, d.outline.y, d.outline.diameter(), d.confidence});
    for (const PlacedCrater& c : scene.craters) {
      truth.push_back({c.x, c.y, c.diameter, 1});
      Recall& recall = outcome.recall[c.place];
      ++recall.all;
      recall.found += std::ranges::any_of(
          found, [&](const CraterCandidate& f) { return overlap(f, truth.back()) >= 0.5; });
    }
    const CircleScore score = score_circles(found, truth, 16);
    hits += score.hits, false_alarms += score.false_alarms;
  }
  outcome.precision = double(hits) / (hits + false_alarms);
  for (const auto& [place, recall] : outcome.recall)
    fmt::print("{}: {:.3f} of {}\n", kPlaces[static_cast<std::size_t>(place)], recall.fraction(), recall.all);
  fmt::print("precision {:.3f}\n", outcome.precision);
  return outcome;
}

TEST(PlacedCraters, OverlappingAndFilledOnesAreFound) {
  Outcome seen = search(placed_scene, 100, 12);
  EXPECT_GE(seen.recall[Place::isolated].fraction(), 0.95);
  EXPECT_GE(seen.recall[Place::overlapping].fraction(), 0.85);
  EXPECT_GE(seen.recall[Place::doublet].fraction(), 0.84);
  EXPECT_GE(seen.recall[Place::on_rim].fraction(), 0.92);
  EXPECT_GE(seen.recall[Place::nested].fraction(), 0.68);
  EXPECT_GE(seen.recall[Place::flooded].fraction(), 0.85);
  EXPECT_GE(seen.recall[Place::sand_filled].fraction(), 0.2);
  EXPECT_GE(seen.precision, 0.92);
}

TEST(PlacedCraters, OfAPopulation) {
  Outcome seen = search(field_scene, 100, 8);
  EXPECT_GE(seen.recall[Place::isolated].fraction(), 0.7);
  EXPECT_GE(seen.recall[Place::overlapping].fraction(), 0.5);
  EXPECT_GE(seen.precision, 0.85);
}

}  // namespace
}  // namespace waymark::test
