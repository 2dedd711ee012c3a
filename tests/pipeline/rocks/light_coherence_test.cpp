// SPDX-License-Identifier: Apache-2.0
#include "pipeline/rocks/light_coherence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>

#include "importers/images/image.hpp"
#include "pipeline/rocks/find_rocks.hpp"
#include "workflows/training/rock_views.hpp"
namespace waymark::test {
using namespace pipeline;
using namespace workflows;
namespace {

std::size_t sure(const std::vector<Detection>& found) {
  return static_cast<std::size_t>(
      std::count_if(found.begin(), found.end(), [](const Detection& d) { return d.confidence > 0.95; }));
}

TEST(LightCoherence, LowersOnlyWhatIsClear) {
  EXPECT_EQ(LightCoherence{}.fraction(), 0.5);
  EXPECT_EQ((LightCoherence{.rocks = 20, .along = 10}).real_fraction(), 1);       // too few
  EXPECT_EQ((LightCoherence{.rocks = 1000, .along = 700}).real_fraction(), 1);    // rocks
  EXPECT_LT((LightCoherence{.rocks = 1000, .along = 520}).real_fraction(), 0.1);  // by chance
  LightCoherence sum{.rocks = 100, .along = 50};
  sum += {.rocks = 300, .along = 250};
  EXPECT_EQ(sum.rocks, 400);
  EXPECT_EQ(sum.fraction(), 0.75);
}

// Views of rocks under suns of 15 to 60 degrees are not affected.
TEST(LightCoherence, RocksStayRocks) {
  for (int k = 1040; k < 1056; ++k) {
    const SyntheticView view = synthetic_view(k);
    const RocksFound found = search_rocks(
        view.image.pixels, {.sun_angle = Radians{view.sun_angle}, .sun_elevation = view.elevation});
    std::printf("view %d, elevation %.0f: %.2f of %d\n", k, to_degrees(view.elevation).value,
                found.coherence.fraction(), int(found.coherence.rocks));
    EXPECT_EQ(found.coherence.real_fraction(), 1) << "view " << k;
  }
}

// Real ground without rocks that could be seen: ripples from a parachute, a river bank with plants, a town.
TEST(LightCoherence, RealGroundWithoutRocks) {
  const std::filesystem::path data = std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data";
  const char* const files[] = {
      "descent/mars2020_lvs/LVS_15_52_15.jpg", "descent/mars2020_lvs/LVS_15_52_21.jpg",
      "descent/mars2020_lvs/LVS_15_52_39.jpg", "cameras/orthority/odm/images/100_0005_0140.tif",
      "cameras/orthority/ngi/3324c_2015_1004_06_0251_RGB.tif"};
  int seen = 0;
  for (const char* file : files) {
    if (!std::filesystem::exists(data / file)) continue;
    ++seen;
    const ImageHandle image = importers::import_image((data / file).string(), {.georeference = false});
    const std::int64_t columns = std::min<std::int64_t>(800, image->info().columns),
                       rows = std::min<std::int64_t>(800, image->info().rows);
    const Pixels pixels = image->read({0, 0, columns, rows});
    for (const double angle : {1.0, 2.6}) {  // whatever light is claimed
      const RocksFound found = search_rocks(pixels, {.sun_angle = Radians{angle}});
      std::printf("%s: %.2f of %d, %zu left, %zu sure\n", file, found.coherence.fraction(),
                  int(found.coherence.rocks), found.rocks.size(), sure(found.rocks));
      // With fewer the fraction is too uncertain for a statement, and confidences stay as they are.
      if (found.coherence.rocks < 1000) continue;
      EXPECT_LT(found.coherence.real_fraction(), 0.5) << file << ", light from " << angle;
      EXPECT_LT(static_cast<double>(sure(found.rocks)), 0.06 * static_cast<double>(found.coherence.rocks))
          << file << ", light from " << angle;
    }
  }
  if (seen == 0) GTEST_SKIP() << data << " is not on this machine";
}

}  // namespace
}  // namespace waymark::test
