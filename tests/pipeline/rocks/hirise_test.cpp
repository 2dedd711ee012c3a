// SPDX-License-Identifier: Apache-2.0
// A real scene, annotated by hand before the detector was run on it (docs/evaluation/annotations/README.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "core/text_file.hpp"
#include "importers/images/image.hpp"
#include "pipeline/rocks/find_rocks.hpp"
#include "pipeline/rocks/rock_sun_angle.hpp"
namespace waymark::test {
using namespace pipeline;
namespace {

struct Annotation {
  double x = 0, y = 0, diameter = 0;
  bool sure = false;
};

std::vector<Annotation> annotations() {
  const std::string path = "/docs/evaluation/annotations/hirise_nm2020_rocks.csv";
  std::istringstream file(read_text(WAYMARK_SOURCE_DIR + path, "the annotations"));
  std::vector<Annotation> all;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    Annotation one;
    char name[16] = {};
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%15s", &one.x, &one.y, &one.diameter, name) != 4) break;
    one.sure = std::string(name) == "rock";
    all.push_back(one);
  }
  return all;
}

bool annotated(double x, double y) {
  constexpr double kRegions[4][4] = {
      {350, 390, 510, 454}, {350, 454, 430, 518}, {20, 792, 220, 866}, {500, 600, 600, 680}};
  for (const auto& r : kRegions)
    if (x >= r[0] && y >= r[1] && x < r[2] && y < r[3]) return true;
  return false;
}

struct Count {
  int rocks = 0, hit = 0, wrong = 0;
};

Count count(const std::vector<Detection>& found, double min_diameter) {
  const auto all = annotations();
  std::vector<int> whose(found.size(), -1);
  Count result;
  for (const bool sure : {true, false})
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].sure != sure) continue;
      double best = std::max(2.0, 0.75 * all[i].diameter);
      std::size_t who = found.size();
      for (std::size_t j = 0; j < found.size(); ++j) {
        const double d = std::hypot(found[j].outline.x - all[i].x, found[j].outline.y - all[i].y);
        if (whose[j] < 0 && d <= best) best = d, who = j;
      }
      if (who < found.size()) whose[who] = static_cast<int>(i);
      result.rocks += sure;
      result.hit += sure && who < found.size();
    }
  for (std::size_t j = 0; j < found.size(); ++j)
    result.wrong += whose[j] < 0 && found[j].outline.diameter() >= min_diameter &&
                    annotated(found[j].outline.x, found[j].outline.y);
  return result;
}

TEST(HiriseScene, AnnotatedRocks) {
  const auto path =
      std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/rocks/hirise_nm2020/Example_1_half.png";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not on this machine";
  const ImageHandle image = importers::import_image(path.string(), {});
  const Pixels pixels = image->read({0, 0, image->info().columns, image->info().rows});
  const auto sun = estimate_rock_sun_angle(pixels);
  ASSERT_TRUE(sun);
  EXPECT_NEAR(to_degrees(sun->angle).value, 167, 10);  // shadows point to +x and a little up
  for (const RockMethod method : {RockMethod::shadow, RockMethod::classic}) {
    const auto found = find_rocks(pixels, {.method = method});
    for (const double least : {2.0, 2.5}) {
      const Count c = count(found, least);
      std::printf("%s, false alarms from %.1f px: recall %d / %d = %.2f, precision %.2f\n",
                  method == RockMethod::shadow ? "shadow" : "classic", least, c.hit, c.rocks,
                  static_cast<double>(c.hit) / c.rocks,
                  static_cast<double>(c.hit) / std::max(1, c.hit + c.wrong));
      if (method != RockMethod::shadow) continue;
      EXPECT_GE(c.hit, 0.9 * c.rocks);
      EXPECT_LE(c.wrong, 25);
    }
  }
}

// The curve passes through what is asked for: precision 0.90 at recall 0.80.
TEST(HiriseScene, SurestDetectionsAreRocks) {
  const auto path =
      std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/rocks/hirise_nm2020/Example_1_half.png";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not on this machine";
  const ImageHandle image = importers::import_image(path.string(), {});
  const Pixels pixels = image->read({0, 0, image->info().columns, image->info().rows});
  auto found = find_rocks(pixels, {});
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.confidence > b.confidence; });
  std::size_t few = 0, enough = found.size();  // the fewest that have the recall
  while (enough - few > 1) {
    const std::size_t middle = (few + enough) / 2;
    const Count c = count({found.begin(), found.begin() + static_cast<std::ptrdiff_t>(middle)}, 2);
    (c.hit >= 0.8 * c.rocks ? enough : few) = middle;
  }
  found.resize(enough);
  const Count c = count(found, 2);
  std::printf("from confidence %.3f: recall %d / %d, %d wrong\n", found.back().confidence, c.hit, c.rocks,
              c.wrong);
  EXPECT_GE(c.hit, 0.9 * (c.hit + c.wrong));
}

}  // namespace
}  // namespace waymark::test
