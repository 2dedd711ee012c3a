// SPDX-License-Identifier: Apache-2.0
// Few large boulders in near images, on scenes that nothing was fitted to: seeds below 1000 were in view when
// the rules were chosen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "pipeline/craters/crater_candidate.hpp"
#include "pipeline/craters/find_craters.hpp"
#include "pipeline/light_in_image.hpp"
#include "pipeline/rocks/find_rocks.hpp"
#include "pipeline/rocks/rock_sun_angle.hpp"
#include "tests/pipeline/rocks/boulder_scene.hpp"
#include "tests/support/angles.hpp"
#include "tests/support/seed_offset.hpp"
namespace waymark::test {
using namespace pipeline;
namespace {

int scene_count() {
  const char* more = std::getenv("WAYMARK_BOULDER_SCENES");
  return more != nullptr ? std::atoi(more) : 12;
}

double overlap(const PixelEllipse& found, double x, double y, double diameter) {
  return pipeline::overlap({0, 0, found.diameter(), 0}, {x - found.x, y - found.y, diameter, 0});
}

struct BoulderCount {
  int boulders = 0, found = 0, craters = 0;  // craters: boulders with a false crater on them
};

bool is_true_crater(const PixelEllipse& found, const std::vector<PixelEllipse>& craters) {
  return std::ranges::any_of(craters, [&](const PixelEllipse& crater) {
    return std::hypot(crater.x - found.x, crater.y - found.y) < 0.3 * crater.diameter() &&
           std::abs(std::log(crater.diameter() / found.diameter())) < 0.6;
  });
}

// Searches rocks and craters as the stages of a landing do.
void count(BoulderCount& sum, const BoulderScene& scene, Radians sun, std::optional<Radians> elevation) {
  const Pixels& pixels = scene.view.image.pixels;
  const auto rocks = find_rocks(pixels, {.sun_angle = sun, .sun_elevation = elevation});
  auto craters = find_craters(pixels, {.sun_angle = sun, .second_opinion = false});
  std::erase_if(craters, [&](const Detection& d) { return is_true_crater(d.outline, scene.craters); });
  for (const workflows::TrueRockInImage& rock : scene.view.image.rocks) {
    ++sum.boulders;
    sum.found += std::ranges::any_of(
        rocks, [&](const Detection& d) { return overlap(d.outline, rock.x, rock.y, rock.diameter) > 0.25; });
    sum.craters += std::ranges::any_of(craters, [&](const Detection& d) {
      return std::hypot(d.outline.x - rock.x, d.outline.y - rock.y) < 0.75 * rock.diameter &&
             std::abs(std::log(d.outline.diameter() / rock.diameter)) < 0.9;
    });
  }
}

TEST(Boulders, AreRocksUnderAKnownSun) {
  BoulderCount sum;
  for (int k = 0; k < scene_count(); ++k) {
    const BoulderScene scene = boulder_scene(8000 + k + static_cast<int>(seed_offset()));
    count(sum, scene, Radians{scene.view.sun_angle}, scene.view.elevation);
  }
  std::printf("%d boulders, %d found, %d with a false crater\n", sum.boulders, sum.found, sum.craters);
  EXPECT_GE(sum.found, 0.9 * sum.boulders);
  EXPECT_LE(sum.craters, 0.05 * sum.boulders);
}

// A boulder looks like a crater under the opposite sun, and few of them were outvoted.
TEST(Boulders, AreRocksUnderAnUnknownSun) {
  BoulderCount sum;
  int opposite = 0, unknown = 0;
  for (int k = 0; k < scene_count(); ++k) {
    const BoulderScene scene = boulder_scene(8000 + k + static_cast<int>(seed_offset()));
    const Pixels& pixels = scene.view.image.pixels;
    const auto light = sun_angle_of_ground(pixels);
    if (!light) {
      ++unknown;
      continue;
    }
    opposite += std::abs(std::remainder(light->value - scene.view.sun_angle, kFullTurn)) > kFullTurn / 4;
    count(sum, scene, *light, {});
  }
  std::printf("%d boulders, %d found, %d with a false crater; sun opposite in %d scenes, unknown in %d\n",
              sum.boulders, sum.found, sum.craters, opposite, unknown);
  EXPECT_LE(unknown, 0.2 * scene_count());
  EXPECT_EQ(opposite, 0);
  EXPECT_GE(sum.found, 0.85 * sum.boulders);
  EXPECT_LE(sum.craters, 0.05 * sum.boulders);
}

// `waymark detect craters` took fields of rocks for craters under the opposite sun.
TEST(Boulders, ChooseTheLightOfCraters) {
  int opposite = 0, by_craters_alone = 0, false_craters = 0;
  for (int k = 0; k < scene_count(); ++k) {
    const workflows::SyntheticView field = rock_field(8100 + k + static_cast<int>(seed_offset()));
    const Pixels& pixels = field.image.pixels;
    const auto is_opposite = [&](Radians angle) {
      return std::abs(std::remainder(angle.value - field.sun_angle, kFullTurn)) > kFullTurn / 4;
    };
    const auto alone = estimate_crater_sun_angle(pixels);
    if (!alone) continue;
    by_craters_alone += is_opposite(alone->angle);
    const auto light = sun_angle_for_craters(pixels);
    opposite += is_opposite(light->angle);
    false_craters += static_cast<int>(find_craters(pixels, {.sun_angle = light->angle}).size());
  }
  std::printf("%d fields: sun opposite in %d, by craters alone in %d; %d false craters\n", scene_count(),
              opposite, by_craters_alone, false_craters);
  EXPECT_LE(opposite, 0.1 * scene_count());
  EXPECT_GT(by_craters_alone, 2 * opposite);
}

}  // namespace
}  // namespace waymark::test
