// SPDX-License-Identifier: Apache-2.0
#include "workflows/detection/image_detector.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <stdexcept>

#include "tests/support/message_of.hpp"
#include "workflows/registries.hpp"
namespace waymark::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using workflows::DetectResult;
using workflows::ImageDetector;
using workflows::ImageDetectorSpec;
using workflows::ImageDetectorTable;

ImageDetectorSpec cones() {
  return {.name = "cones", .summary = "Cones", .type = "cone", .methods = {{"bright"}}, .make = [] {
            return ImageDetector{.find = [](const workflows::DetectionPlan&) { return DetectResult{}; }};
          }};
}

TEST(ImageDetectorTable, KeepsTheOrderOfRegistration) {
  ImageDetectorTable table;
  ImageDetectorSpec second = cones();
  second.name = "a_cone";
  table.add(cones());
  table.add(second);
  EXPECT_THAT(table.names(), ElementsAre("cones", "a_cone"));
  EXPECT_EQ(table.find("cones")->type, "cone");
  EXPECT_EQ(table.find("rocks"), nullptr);
}

TEST(ImageDetectorTable, RefusesIncompleteDeclarations) {
  const auto fault = [](auto change) {
    ImageDetectorSpec spec = cones();
    change(spec);
    ImageDetectorTable table;
    table.add(cones());
    return message_of<std::logic_error>([&] { table.add(spec); });
  };
  EXPECT_THAT(fault([](auto&) {}), HasSubstr("a name of its own, is 'cones'"));
  for (const char* name : {"", "Cones", "2cones", "traffic cones"})
    EXPECT_THAT(fault([&](auto& spec) { spec.name = name; }), HasSubstr("a name of its own"));
  const auto lacks = [&](auto change) {
    return fault([&](ImageDetectorSpec& spec) {
      spec.name = "more_cones";
      change(spec);
    });
  };
  const char* const incomplete = "more_cones declares no type, method, record or function";
  EXPECT_THAT(lacks([](auto& spec) { spec.type.clear(); }), HasSubstr(incomplete));
  EXPECT_THAT(lacks([](auto& spec) { spec.methods.clear(); }), HasSubstr(incomplete));
  EXPECT_THAT(lacks([](auto& spec) { spec.make = nullptr; }), HasSubstr(incomplete));
  EXPECT_THAT(lacks([](auto& spec) { spec.methods[0].record = "sounds"; }), HasSubstr(incomplete));
}

TEST(ImageDetectors, EachMakesATypeThatIsDeclared) {
  ASSERT_GE(workflows::image_detectors().size(), 3u);
  for (const ImageDetectorSpec& one : workflows::image_detectors()) {
    EXPECT_NE(workflows::all_types().find(one.type), nullptr) << one.name;
    EXPECT_TRUE(bool(one.make().find)) << one.name;
    for (const workflows::SettingUse& use : one.setting_use) {
      const auto settings = workflows::settings_of(one);
      EXPECT_TRUE(std::ranges::any_of(settings, [&](const auto& row) { return row.name == use.name; }))
          << one.name << ' ' << use.name;
      for (const std::string& method : use.methods)
        EXPECT_TRUE(std::ranges::any_of(one.methods, [&](const auto& known) { return known.name == method; }))
            << one.name << ' ' << method;
    }
  }
}

TEST(ImageDetectors, SettingsWithoutAUseTakeAnyText) {
  const ImageDetectorSpec spec = cones();
  EXPECT_TRUE(workflows::settings_of(spec).empty());
  EXPECT_EQ(workflows::use_of_setting(spec, "size").value, "VALUE");
  EXPECT_FALSE(workflows::use_of_setting(spec, "size").is_file);
}

}  // namespace
}  // namespace waymark::test
