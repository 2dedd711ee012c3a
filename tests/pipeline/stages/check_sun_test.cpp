// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "geo/image_source.hpp"
#include "pipeline/engine/runner.hpp"
#include "pipeline/engine/stage.hpp"

namespace waymark::pipeline {

void register_stage_check_sun(Registry& registry);

template <>
struct Codec<ImageSet> {
  static std::string encode(const ImageSet&) { return {}; }
  static ImageSet decode(std::string_view) { return {}; }
};

}  // namespace waymark::pipeline

namespace waymark::test {
using namespace pipeline;

namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Stones in rows: each a dark spot with a bright one beside it towards the sun.
class Stones final : public ImageSource {
 public:
  Stones(double sun_angle, std::optional<double> given) : angle_(sun_angle * kRadiansPerDegree) {
    info_.name = "stones.png";
    info_.columns = info_.rows = 400;
    if (given) info_.image_sun_angle = Degrees{*given};
  }
  const ImageInfo& info() const override { return info_; }
  Pixels read(const Window& window) const override {
    Pixels pixels(window.columns, window.rows);
    for (std::int64_t r = 0; r < window.rows; ++r)
      for (std::int64_t c = 0; c < window.columns; ++c)
        pixels(c, r) = static_cast<float>(
            value(static_cast<double>(c + window.column), static_cast<double>(r + window.row)));
    return pixels;
  }

 private:
  double value(double x, double y) const {
    const double u = x - 40 * std::round(x / 40), v = y - 40 * std::round(y / 40);
    const double dx = 2.5 * std::cos(angle_), dy = 2.5 * std::sin(angle_);
    const auto spot = [&](double sx, double sy) {
      return std::exp(-((u - sx) * (u - sx) + (v - sy) * (v - sy)) / 6);
    };
    const double grain = std::sin(12.9898 * x + 78.233 * y) * 43758.5453;
    return 100 - 60 * spot(-dx, -dy) + 40 * spot(dx, dy) + 2 * (grain - std::floor(grain));
  }

  ImageInfo info_;
  double angle_;
};

ImageHandle shown;  // NOLINT: the stage below has no other input

struct ListStones {
  struct Options {
    void describe(OptionVisitor&) {}
  };
  static constexpr Out<ImageSet> images{"image_set"};
  static constexpr Out<std::vector<ImageItem>> items{"images"};
  static StageSpec spec() {
    return {.name = "list_stones", .summary = "One image", .lists = Scope::image, .outputs = {images, items}};
  }
  static void run(const Options&, StageContext& unit) {
    unit.write(images, ImageSet{shown});
    unit.write(items, std::vector<ImageItem>{{0, "stones.png", "", ""}});
  }
};

std::vector<std::string> warnings(double sun, std::optional<double> given) {
  shown = std::make_shared<const Stones>(sun, given);
  Registry registry;
  registry.add<ListStones>();
  register_stage_check_sun(registry);
  Pipeline pipeline(registry);
  pipeline.add("list_stones");
  pipeline.add("check_sun");
  return run(pipeline, {}).report.stages.at(1).warnings;
}

TEST(CheckSun, IsSilentWhereShadowsAgree) {
  for (const double sun : {0.0, 70.0, 200.0, -45.0})
    EXPECT_THAT(warnings(sun, sun + 5), ElementsAre()) << sun;
}

TEST(CheckSun, WarnsWhereTheyDoNot) {
  EXPECT_THAT(warnings(30, 70), ElementsAre(HasSubstr("check azimuth")));
  EXPECT_THAT(warnings(30, -60), ElementsAre(HasSubstr("shadows point")));
}

TEST(CheckSun, SaysWhereNoSunIsKnown) {
  EXPECT_THAT(warnings(30, std::nullopt), ElementsAre(HasSubstr("the sun is not known")));
}

}  // namespace
}  // namespace waymark::test
