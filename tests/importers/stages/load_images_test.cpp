// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "importers/cameras/control_points.hpp"
#include "importers/hash.hpp"
#include "importers/images/image_set.hpp"
#include "importers/images/list_images.hpp"
#include "importers/stages.hpp"
#include "pipeline/engine/image_item.hpp"
#include "pipeline/engine/runner.hpp"
#include "tests/importers/raster_maker.hpp"

namespace waymark::test {
using namespace importers;
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// A folder with images of 4 x 4 pixels.
fs::path folder_of(const std::string& name, const std::vector<std::string>& images) {
  const fs::path folder = fs::path(write_text(name + ".txt", "")).parent_path() / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  for (const std::string& image : images) {
    fs::create_directories((folder / image).parent_path());
    std::ofstream(folder / image) << "P5 4 4 255\nabcdefghijklmnop";
  }
  return folder;
}

std::string cameras_in(const fs::path& folder, const std::vector<std::string>& images,
                       const std::string& extra = "") {
  std::string list;
  for (const std::string& image : images)
    list +=
        (list.empty() ? "" : ",") + std::string(R"({"name": ")") + image +
        R"(", "camera": {"columns": 4, "rows": 4, "fx": 5, "fy": 5, "cx": 1.5, "cy": 1.5}, "centre": [0, 0, 10],)" +
        R"("rotation": [[1, 0, 0], [0, -1, 0], [0, 0, -1]]})";
  const std::string path = (folder / "cameras.json").string();
  std::ofstream(path) << R"({"waymark_cameras": 1, "frame": {"axes": "grid", "crs": "local"},)" << extra
                      << R"("images": [)" << list << "]}";
  return path;
}

TEST(ListImages, FindsTheImagesOfACameraFileBesideIt) {
  const fs::path folder = folder_of("beside", {"images/b.pgm", "images/a.pgm", "images/notes.txt"});
  const ListedImages listed = list_images({.cameras = cameras_in(folder, {"b.pgm", "a.pgm"})});
  ASSERT_EQ(listed.images.size(), 2u);
  EXPECT_EQ(listed.images[0].name, "a.pgm");
  EXPECT_TRUE(listed.images[0].view);
  EXPECT_THAT(listed.warnings, ElementsAre());
}

TEST(ListImages, MissingAndDamagedImagesAreListedAndTheRestGoesOn) {
  const fs::path folder = folder_of("half", {"a.pgm", "c.pgm"});
  std::ofstream(folder / "d.pgm") << "no image";
  const ListedImages listed = list_images(
      {.files = {folder.string()}, .cameras = cameras_in(folder, {"a.pgm", "b.pgm", "c.pgm", "d.pgm"})});
  ASSERT_EQ(listed.images.size(), 4u);
  EXPECT_EQ(listed.images[1].columns, 0);
  EXPECT_EQ(listed.images[2].columns, 4);
  EXPECT_THAT(listed.warnings, ElementsAre(AllOf(HasSubstr("2 of 4 images cannot be read"),
                                                 HasSubstr("b.pgm: there is no such file"))));
  const ImageSet set = image_set(listed.images);
  EXPECT_THAT(message_of([&] { set[1]->read({0, 0, 4, 4}); }), HasSubstr("no such file"));
  EXPECT_EQ(set[2]->read({0, 0, 1, 1})(0, 0), 'a');
}

TEST(ListImages, ASingleImageOfACameraFileIsNoGap) {
  const fs::path folder = folder_of("single", {"a.pgm", "b.pgm"});
  const ListedImages listed = list_images(
      {.files = {(folder / "a.pgm").string()}, .cameras = cameras_in(folder, {"a.pgm", "b.pgm"})});
  EXPECT_EQ(listed.images.size(), 1u);
}

TEST(ListImages, APatternSelectsWhatItMatchesAndNothingElse) {
  const fs::path folder = folder_of("some", {"a1.pgm", "a2.pgm", "b1.pgm"});
  const std::string cameras = cameras_in(folder, {"a1.pgm", "a2.pgm", "b1.pgm"});
  const ListedImages some = list_images({.files = {(folder / "a[12].pgm").string()}, .cameras = cameras});
  ASSERT_EQ(some.images.size(), 2u);
  EXPECT_TRUE(some.images[0].view && some.images[1].view);
  for (const char* none : {"typo_*.pgm", "[1-4].pgm"})
    EXPECT_THAT(message_of([&] {
                  list_images({.files = {(folder / "b1.pgm").string(), (folder / none).string()},
                               .cameras = cameras});
                }),
                AllOf(HasSubstr("no image matches the pattern"), HasSubstr(none)));
}

TEST(ListImages, ReportsImagesWithoutGeoreference) {
  const fs::path folder = folder_of("placeless", {"a.pgm", "z.pgm"});
  const ListedImages listed =
      list_images({.files = {(folder / "*.pgm").string()}, .cameras = cameras_in(folder, {"a.pgm"})});
  EXPECT_FALSE(listed.images[1].view);
  EXPECT_THAT(listed.warnings,
              ElementsAre(HasSubstr("1 of 2 images have neither a pose nor a usable georeference: z.pgm")));
}

TEST(ListImages, FoldersDistinguishImagesOfOneName) {
  const fs::path folder = folder_of("twins", {"left/1.pgm", "right/1.pgm"});
  const ListedImages listed =
      list_images({.files = {(folder / "left").string(), (folder / "right").string()}});
  ASSERT_EQ(listed.images.size(), 2u);
  EXPECT_EQ(listed.images[0].name, "left/1.pgm");
  EXPECT_EQ(listed.images[1].name, "right/1.pgm");
}

// Written by hand from Bundler's manual: R, t take the world into the camera, which looks along -z with y up.
// Camera a stands at (10, 20, 30) and looks straight down, its up is the world's y; b looks along the world's
// x, its up the world's z; c was not oriented. The frame is arbitrary: twice as large on the map.
TEST(ListImages, BundlerLooksAlongMinusZAndNeedsASimilarity) {
  const fs::path folder = folder_of("bundler", {"a.pgm", "b.pgm", "c.pgm"});
  std::ofstream(folder / "list.txt") << "a.pgm\nb.pgm 0 5\nc.pgm\n";
  std::ofstream(folder / "bundle.out") << "# Bundle file v0.3\n3 1\n"
                                          "5 0.1 0.02\n1 0 0\n0 1 0\n0 0 1\n-10 -20 -30\n"
                                          "5 0 0\n0 -1 0\n0 0 1\n-1 0 0\n0 0 0\n"
                                          "0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n"
                                          "10 20 0\n255 255 255\n1 0 0 0 0\n";
  ImageListing listing{.files = {folder.string()}, .cameras = (folder / "bundle.out").string()};
  listing.import.crs = "local";
  EXPECT_THAT(message_of([&] { list_images(listing); }), HasSubstr("control points"));
  listing.import.map_from_frame = similarity_from_text("2,1,0,0,0,0,0,0");
  const ListedImages listed = list_images(listing);
  ASSERT_EQ(listed.images.size(), 3u);
  const PosedCamera& a = listed.images[0].view.value();
  EXPECT_LT((a.centre().xyz - Eigen::Vector3d(20, 40, 60)).norm(), 1e-9);
  EXPECT_EQ(a.camera.fx, 5);
  EXPECT_EQ(a.camera.cx, 1.5);  // the middle of 4 pixels, the first pixel's centre being 0
  EXPECT_EQ(a.camera.distortion[0], 0.1);
  EXPECT_EQ(a.camera.distortion[1], 0.02);
  const auto down = ray(a, {1.5, 1.5}), right = ray(a, {2.5, 1.5}), up = ray(a, {1.5, 0.5});
  EXPECT_LT((down->direction.unit - Eigen::Vector3d(0, 0, -1)).norm(), 1e-9);
  EXPECT_GT(right->direction.unit.x(), 0.1);
  EXPECT_GT(up->direction.unit.y(), 0.1);
  const PosedCamera& b = listed.images[1].view.value();
  EXPECT_LT((ray(b, {1.5, 1.5})->direction.unit - Eigen::Vector3d(1, 0, 0)).norm(), 1e-9);
  EXPECT_GT(ray(b, {1.5, 0.5})->direction.unit.z(), 0.1);
  EXPECT_LT(ray(b, {2.5, 1.5})->direction.unit.y(), -0.1);
  EXPECT_FALSE(listed.images[2].view);
  std::ofstream(folder / "list.txt") << "a.pgm\n";
  EXPECT_THAT(message_of([&] { list_images(listing); }), HasSubstr("there are 3 cameras, but 1 image names"));
}

TEST(ListImages, TheGivenSunAppliesToAllImages) {
  const fs::path folder = folder_of("sunny", {"a.pgm"});
  const std::string cameras = cameras_in(folder, {"a.pgm"}, R"("sun": {"azimuth": 100, "elevation": 30},)");
  EXPECT_EQ(list_images({.cameras = cameras}).images[0].sun->azimuth.value, 100);
  EXPECT_EQ(
      list_images({.cameras = cameras, .sun = Sun{Degrees{7}, Degrees{8}}}).images[0].sun->azimuth.value, 7);
  EXPECT_FALSE(list_images({.cameras = cameras, .sun_from = ImageListing::SunFrom::nothing}).images[0].sun);
}

TEST(ListImages, EmptyInputIsAnError) {
  EXPECT_THAT(message_of([] { list_images({}); }), HasSubstr("no images are given"));
  EXPECT_THAT(message_of([] { list_images({.files = {folder_of("empty", {}).string()}}); }),
              HasSubstr("there are no images"));
}

pipeline::RunResult load_these_images(const std::string& options) {
  pipeline::Registry registry;
  register_importer_stages(registry);
  pipeline::Pipeline pipeline(registry);
  pipeline.add("flat_ground", R"({"crs": "local"})").add("load_images", options);
  return pipeline::run(pipeline, {.hash_file = hash_file});
}

TEST(LoadImages, ListsImagesWithTheirFingerprints) {
  const fs::path folder = folder_of("stage", {"a.pgm", "b.pgm"});
  const std::string options = R"({"cameras": ")" + cameras_in(folder, {"a.pgm", "b.pgm"}) +
                              R"(", "sun_azimuth": 90, "sun_elevation": 40})";
  const pipeline::RunResult result = load_these_images(options);
  const auto& items = result.artifact<std::vector<pipeline::ImageItem>>("images");
  ASSERT_EQ(items.size(), 2u);
  EXPECT_EQ(items[1].index, 1);
  EXPECT_EQ(items[1].file, (folder / "b.pgm").string());
  EXPECT_THAT(items[1].content,
              AllOf(HasSubstr("\"sun\":[90.0,40.0,0.5]"), ::testing::Not(HasSubstr(folder.string()))));
  EXPECT_EQ(result.artifact<ImageSet>("image_set").size(), 2u);
}

TEST(LoadImages, ChecksItsOptions) {
  EXPECT_THAT(message_of([] { load_these_images(R"({"files": ["a"], "image_sun_angle": "left"})"); }),
              HasSubstr("image_sun_angle is 'left'"));
  EXPECT_THAT(message_of([] { load_these_images(R"({"files": ["a"], "sun": "moon"})"); }),
              HasSubstr("auto, time, none"));
}

TEST(HashFile, OfAFolderNoticesANewImage) {
  const fs::path folder = folder_of("hashed", {"a.pgm"});
  const std::string before = hash_file(folder.string() + "/").sha256;
  std::ofstream(folder / "notes.txt") << "nothing";
  EXPECT_EQ(hash_file(folder.string() + "/").sha256, before);
  std::ofstream(folder / "b.pgm") << "P5";
  EXPECT_NE(hash_file(folder.string() + "/").sha256, before);
  EXPECT_FALSE(hash_file("/no/such/folder/").sha256.empty());
}

}  // namespace
}  // namespace waymark::test
