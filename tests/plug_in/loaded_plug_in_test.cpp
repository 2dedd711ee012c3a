// SPDX-License-Identifier: Apache-2.0
// Plug-ins that the program loads at run time; no file of the program knows them.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <waymark/waymark.hpp>

#include "localization/detectors/scan_landmarks.hpp"
#include "tests/apps/program.hpp"
#include "tests/support/message_of.hpp"
namespace waymark::test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string plug_in(const std::string& name) {
  return std::string(WAYMARK_PLUG_INS) + "/" + name + ".so";
}

/// Image of 20 x 10 pixels with two bright ones, at (4, 3) and (15, 6), and a brighter one at (9, 8).
std::string write_image(const std::string& file) {
  std::string pixels(200, static_cast<char>(50));
  pixels[3 * 20 + 4] = static_cast<char>(210);
  pixels[6 * 20 + 15] = static_cast<char>(220);
  pixels[8 * 20 + 9] = static_cast<char>(250);
  std::ofstream(file) << "P5 20 10 255\n" << pixels;
  return file;
}

/// A robot on a plain with two cones, which turns towards each: one return in each scan.
std::string write_log(const std::string& file) {
  std::ofstream log(file);
  log << R"({"kind":"header","version":1,"frame":"crs"})" << '\n';
  for (int i = 0; i < 6; ++i) {
    const double t = i, x = 0.5 * i, yaw = 0;
    log << R"({"kind":"truth","t":)" << t << R"(,"x":)" << x << R"(,"y":0,"yaw":)" << yaw << "}\n";
    if (i > 0) log << R"({"kind":"step","t":)" << t << R"(,"dx":0.5,"dy":0,"dyaw":0})" << '\n';
    const double range = std::hypot(6 - x, 2) - 0.2;
    const auto beam = std::lround((std::atan2(2, 6 - x) + 1.5) / 0.01);
    log << R"({"kind":"laser","t":)" << t
        << R"(,"first_angle":-1.5,"angle_step":0.01,"most_range":30,"ranges":[)";
    for (int b = 0; b < 300; ++b) log << (b ? "," : "") << (b == beam ? range : 30.0);
    log << "]}\n";
  }
  return file;
}

TEST(LoadedPlugIn, AddsToEveryRegistryOnce) {
  workflows::load_plug_in(plug_in("cones"));
  workflows::load_plug_in(plug_in("cones"));
  EXPECT_THAT(workflows::all_types().names(), Contains("traffic_cone").Times(1));
  EXPECT_THAT(workflows::all_stages().names(), Contains("count_landmarks"));
  EXPECT_THAT(localization::laser_detectors().names(), Contains("cones").Times(1));
  EXPECT_THAT(localization::point_detectors().names(), Not(Contains("cones")));
  EXPECT_THAT(workflows::image_detectors().names(),
              testing::ElementsAre("craters", "rocks", "trees", "cones"));
}

TEST(LoadedPlugIn, StageRunsBetweenTheStagesOfTheProgram) {
  workflows::load_plug_in(plug_in("cones"));
  pipeline::Pipeline mapping(workflows::all_stages());
  mapping.add("load_dem", R"({"files": [")" WAYMARK_SOURCE_DIR R"(/sample_data/jacksboro/dem.tif"]})")
      .add("find_mountain_tops", R"({"min_prominence": 100})")
      .add("join_mountain_tops")
      .add("measure_isolation")
      .add("map_mountain_tops")
      .add("count_landmarks");
  const pipeline::RunResult result = pipeline::run(mapping);
  const pipeline::Counts& counts = result.report.stages.back().counts;
  EXPECT_GT(counts.out, 0);
  EXPECT_EQ(std::ssize(result.artifact<std::vector<Landmark>>("counted")), counts.out);
}

TEST(LoadedPlugIn, ImageDetectorFindsWhatItsSettingsAsk) {
  const TempFolder folder;
  const std::string image = write_image(folder / "site.pgm"), csv = folder / "cones.csv";
  const auto detect = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"detect", "cones", image, "-o", csv, "--plugin", plug_in("cones")});
    return waymark(words);
  };
  const Outcome usual = detect({});
  EXPECT_EQ(usual.code, 0) << usual.err;
  EXPECT_THAT(usual.err, HasSubstr("3 cones"));
  EXPECT_THAT(text_of(csv), AllOf(StartsWith("x,y,diameter,major,minor,angle,confidence\n"),
                                  HasSubstr("\n4.0000,3.0000,3.0000,"), HasSubstr("\n15.0000,6.0000,"),
                                  HasSubstr("\n9.0000,8.0000,")));
  EXPECT_THAT(detect({"--cone-brightness", "215"}).err, HasSubstr("2 cones"));
  EXPECT_THAT(detect({"--method", "dim"}).err, HasSubstr("197 cones"));
  EXPECT_THAT(detect({"--gsd", "0.1", "--cone-brightness", "240"}).err, HasSubstr("1 cones"));
  EXPECT_THAT(text_of(csv), StartsWith("x,y,diameter,major,minor,angle,confidence,traffic_cone_diameter"));
}

TEST(LoadedPlugIn, ImageDetectorChecksItsSettings) {
  const TempFolder folder;
  const std::string image = write_image(folder / "site.pgm");
  const auto refused = [&](const std::string& kind, std::vector<std::string> words) {
    words.insert(words.begin(),
                 {"--plugin=" + plug_in("cones"), "detect", kind, image, "-o", folder / "out.csv"});
    const Outcome outcome = waymark(words);
    EXPECT_EQ(outcome.code, 2);
    return outcome.err;
  };
  EXPECT_THAT(refused("cones", {"--cone-brightness", "-3"}), HasSubstr("cone_brightness"));
  EXPECT_THAT(refused("rocks", {"--cone-brightness", "3"}),
              HasSubstr("--cone-brightness is for cones that the method bright finds"));
  EXPECT_THAT(refused("cones", {"--method", "dim", "--cone-brightness", "3"}),
              HasSubstr("--cone-brightness is for cones that the method bright finds"));
  EXPECT_THAT(refused("cones", {"--method", "brigt"}), HasSubstr("did you mean 'bright'?"));
  EXPECT_THAT(refused("connes", {}), HasSubstr("did you mean 'cones'?"));
  EXPECT_THAT(refused("zebras", {}), HasSubstr("`detect trees IMAGE` or `detect cones IMAGE`"));
}

TEST(LoadedPlugIn, IsInHelpCompletionAndLists) {
  const std::string file = plug_in("cones");
  EXPECT_THAT(waymark({"--plugin", file, "detect", "--help"}).out,
              AllOf(HasSubstr("craters|rocks|trees|cones"), HasSubstr("--cone-brightness VALUE")));
  const std::string help =
      waymark({"--plugin", file, "help", "--format", "json"}).out;  // no lines are broken
  for (const char* text : {"Find craters, rocks, trees or cones in one image", "; bright or dim for cones",
                           ", 2 for cones", ", 20 for cones", "cones by bright: pixels at least as bright"})
    EXPECT_THAT(help, HasSubstr(text));
  EXPECT_THAT(waymark({"--plugin", file, "completion", "bash"}).out, HasSubstr("--cone-brightness"));
  EXPECT_THAT(waymark({"detectors", "--plugin", file}).out,
              AllOf(HasSubstr("\ncones "), HasSubstr("\nimage_cones ")));
  EXPECT_THAT(
      waymark({"detectors", "image_cones", "--plugin", file}).out,
      AllOf(HasSubstr("waymark detect cones"), HasSubstr("traffic_cone"), HasSubstr("cone_brightness")));
  EXPECT_THAT(waymark({"types", "traffic_cone", "--plugin", file}).out, HasSubstr("Cone of a building site"));
  EXPECT_THAT(waymark({"stages", "count_landmarks", "--plugin", file}).out, HasSubstr("Counts landmarks"));
  EXPECT_THAT(waymark({"map", "--help", "--plugin", file}).out, HasSubstr(", cones"));
  EXPECT_THAT(waymark({"detect", "--help"}).out, Not(HasSubstr("cone")));
}

// The cone stands at (6, 2), 0.2 m behind its return.
TEST(LoadedPlugIn, ScanDetectorMapsAndLocalizes) {
  const TempFolder folder;
  const std::string log = write_log(folder / "drive.jsonl"), map = folder / "site.gpkg",
                    track = folder / "t.csv";
  const Outcome mapped = waymark({"map", log, "--scans", "cones", "-o", map, "--plugin", plug_in("cones")});
  ASSERT_EQ(mapped.code, 0) << mapped.err;
  const auto cones = geodb::MapStore::open(map).query({.types = {"traffic_cone"}});
  ASSERT_EQ(cones.size(), 1u) << mapped.err;
  EXPECT_NEAR(cones[0].position.xyz.x(), 6, 0.05);
  EXPECT_NEAR(cones[0].position.xyz.y(), 2, 0.05);
  const std::vector<std::string> words = {"localize", map,         log,     "-o",         track,
                                          "--start",  "0.2,0.1,0", "--set", "scans=cones"};
  const Outcome without = waymark(words);
  EXPECT_EQ(without.code, 2);
  EXPECT_THAT(without.err, HasSubstr("there is no detector 'cones'"));
  for (const char* scans : {"scans=cones", "scans=auto"}) {
    std::vector<std::string> with = words;
    with.back() = scans;
    with.insert(with.end(), {"--plugin", plug_in("cones")});
    const Outcome localized = waymark(with);
    ASSERT_EQ(localized.code, 0) << localized.err;
    const Outcome judged = waymark({"evaluate", "track", track, "--truth", log, "--format", "json"});
    ASSERT_EQ(judged.code, 0) << judged.err;
    EXPECT_LT(nlohmann::json::parse(judged.out)["ate_rmse"].get<double>(), 0.15) << judged.out;
  }
}

TEST(LoadedPlugIn, FaultsAreNamedAndAddNothing) {
  const auto fault = [](const std::string& file) {
    return message_of([&] { workflows::load_plug_in(file); });
  };
  EXPECT_THAT(fault("nothing.so"), HasSubstr("there is no such plug-in"));
  EXPECT_THAT(fault(WAYMARK_SOURCE_DIR "/README.md"), HasSubstr("the plug-in cannot be loaded"));
  EXPECT_THAT(fault(plug_in("other_build")),
              AllOf(HasSubstr("was built for another Waymark: waymark 0.0.1; this is waymark"),
                    HasSubstr("build it again")));
  EXPECT_THAT(fault(plug_in("taken_name")), AllOf(HasSubstr("cannot be registered"), HasSubstr("rock")));
  EXPECT_THAT(fault(plug_in("undeclared_type")), HasSubstr("detector ghosts makes the type 'ghost'"));
  EXPECT_THAT(workflows::all_types().names(), Not(Contains("new_type")));
  EXPECT_THAT(workflows::image_detectors().names(), Not(Contains("ghosts")));
  const Outcome program = waymark({"types", "--plugin", "nothing.so"});
  EXPECT_EQ(program.code, 1);
  EXPECT_THAT(program.err, HasSubstr("there is no such plug-in"));
}

}  // namespace
}  // namespace waymark::test
