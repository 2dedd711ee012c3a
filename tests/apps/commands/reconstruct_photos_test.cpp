// SPDX-License-Identifier: Apache-2.0
// `waymark reconstruct` with pictures that cannot be used, or whose metadata are wrong.
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/apps/photo_files.hpp"
#include "tests/apps/photo_flight.hpp"
#include "tests/apps/program.hpp"

namespace waymark::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

class ReconstructPhotos : public PhotoFlight {
 protected:
  Outcome run(std::vector<std::string> more = {}) {
    std::vector<std::string> words{"reconstruct", folder_ / "images", "--until", "poses",
                                   "-o",          folder_ / "out"};
    words.insert(words.end(), more.begin(), more.end());
    return waymark(words);
  }
  Outcome run_with_lens() { return run({"--lens", (grid_flight() / "truth/cameras.json").string()}); }
};

TEST_F(ReconstructPhotos, OneImageIsTooFew) {
  write_good(1);
  const Outcome one = run();
  EXPECT_EQ(one.code, 1);
  EXPECT_THAT(one.err, HasSubstr("1 usable image is found, but poses need two or more that overlap"));
}

TEST_F(ReconstructPhotos, TwoCopiesShowNoParallax) {
  write_photo(image("a.jpg"), pictures_[0]);
  write_photo(image("b.jpg"), pictures_[0]);
  const Outcome copies = run();
  EXPECT_EQ(copies.code, 1);
  EXPECT_THAT(copies.err, AllOf(HasSubstr("show no parallax"), HasSubstr("copies")));
}

TEST_F(ReconstructPhotos, ImagesWithoutOverlapAreRefused) {
  for (unsigned i = 0; i < 3; ++i) write_photo(image(std::to_string(i) + ".jpg"), noise_picture(300, 300, i));
  const Outcome apart = run();
  EXPECT_EQ(apart.code, 1);
  EXPECT_THAT(apart.err, AllOf(HasSubstr("no two of them match"), HasSubstr("overlap by 60 %")));
}

TEST_F(ReconstructPhotos, ImagesOfOneColourAreNamed) {
  for (const int grey : {0, 90, 255})
    write_photo(image(std::to_string(grey) + ".jpg"),
                uniform_picture(300, 300, static_cast<unsigned char>(grey)));
  const Outcome flat = run();
  EXPECT_EQ(flat.code, 1);
  EXPECT_THAT(flat.err, AllOf(HasSubstr("3 images are faulty"), HasSubstr("all its pixels have one value")));
}

TEST_F(ReconstructPhotos, BadImagesAmongGoodOnesAreNamedAndTheRestGoesOn) {
  write_good(6);
  write_photo(image("black.jpg"), uniform_picture(300, 300, 0));
  write_photo(image("mirrored.jpg"), mirrored_picture(pictures_[2]));
  write_photo(image("stranger.jpg"), noise_picture(300, 300, 7));
  write_photo(image("smaller_stranger.jpg"), noise_picture(240, 160, 8));
  write_text(folder_ / "images/damaged.jpg", "no picture");
  write_text(folder_ / "images/notes.txt", "flown at noon");
  const Outcome mixed = run_with_lens();
  EXPECT_EQ(mixed.code, 3) << mixed.err;
  EXPECT_THAT(mixed.err, HasSubstr("6 of 11 images posed"));
  for (const char* name :
       {"black.jpg", "mirrored.jpg", "stranger.jpg", "smaller_stranger.jpg", "damaged.jpg"})
    EXPECT_THAT(mixed.err, HasSubstr("not posed: " + std::string(name)));
  EXPECT_THAT(mixed.err, Not(HasSubstr("notes.txt")));
  const std::string report = text_of(folder_ / "out/report.html");
  EXPECT_THAT(report, AllOf(HasSubstr("Failed images"), HasSubstr("mirrored.jpg"), HasSubstr("damaged.jpg")));
}

TEST_F(ReconstructPhotos, ImagesOfTwoSizesHaveTwoLenses) {
  write_good(3);
  for (std::size_t i = 3; i < 6; ++i) write_photo(image(names_[i]), halved_picture(pictures_[i]));
  const Outcome mixed = run();
  EXPECT_THAT(mixed.err, AllOf(HasSubstr("lens 1: 3 images of 300 x 300"), HasSubstr("images of 150 x 150")));
}

// The lens of the flight in a camera file, changed.
std::string lens_file(const TempFolder& folder, const std::function<void(json&)>& change) {
  json file = json::parse(text_of(grid_flight() / "truth/cameras.json"));
  change(file);
  write_text(folder / "lens.json", file.dump());
  return folder / "lens.json";
}

TEST_F(ReconstructPhotos, ALensFileMayNameNoImages) {
  write_good(4);
  const Outcome made = run({"--lens", lens_file(folder_, [](json& file) {
                              file.erase("images"), file.erase("frame"), file.erase("sun");
                            })});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, AllOf(HasSubstr("4 of 4 images posed"), HasSubstr("kept fixed")));
  EXPECT_THAT(made.err, Not(HasSubstr("not here")));
}

TEST_F(ReconstructPhotos, ALensFileMayNameOtherImages) {
  write_good(4);
  const Outcome made = run({"--lens", lens_file(folder_, [](json& file) {
                              for (std::size_t i = 2; i < 6; ++i)
                                file["images"][i]["name"] = "earlier_" + std::to_string(i) + ".png";
                            })});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, AllOf(HasSubstr("4 of 4 images posed"), HasSubstr("kept fixed"),
                              HasSubstr("4 of the 6 images that it names are not here, e.g. earlier_2.png")));
}

TEST_F(ReconstructPhotos, OfTwoLensesOfOneSizeTheNamedOneHolds) {
  write_good(4);
  const auto two = [](json& file) {
    file["cameras"]["other"] = file["cameras"]["lens"];
    file["cameras"]["other"]["fx"] = file["cameras"]["other"]["fy"] = 400;
  };
  EXPECT_THAT(run({"--lens", lens_file(folder_, two)}).err, HasSubstr("kept fixed"));
  const Outcome unnamed = run({"--lens", lens_file(folder_, [&](json& file) {
                                 two(file);
                                 file["images"] = json::array();
                               })});
  EXPECT_THAT(unnamed.err, HasSubstr("has 2 lenses for 300 x 300 pixels and does not name"));
}

TEST_F(ReconstructPhotos, ARollingShutterNeedsTimes) {
  write_good(4);
  const std::string lens = (grid_flight() / "truth/cameras.json").string();
  const Outcome untimed = run({"--lens", lens, "--readout-time", "0.05"});
  ASSERT_EQ(untimed.code, 0) << untimed.err;
  EXPECT_THAT(untimed.err, AllOf(HasSubstr("4 of 4 images of a rolling shutter have no time of exposure"),
                                 HasSubstr("without times of exposure it is not modelled")));
  const Outcome timed = run({"--lens", lens_file(folder_, [](json& file) {
                               file["cameras"]["lens"]["readout_time"] = 0.05;
                               for (std::size_t i = 0; i < 6; ++i)
                                 file["images"][i]["taken_utc"] =
                                     "2030-01-01T00:00:0" + std::to_string(i) + ".5Z";
                             })});
  ASSERT_EQ(timed.code, 0) << timed.err;
  EXPECT_THAT(timed.err, HasSubstr("rolling shutter of 50 ms: the motion of 4 of 4 images is estimated"));
  EXPECT_EQ(json::parse(text_of(folder_ / "out/cameras.json"))["cameras"]["lens_1"]["readout_time"], 0.05);
  EXPECT_EQ(run({"--lens", lens, "--readout-time", "-1"}).code, 2);
}

// Heights of the six cameras above the ground, which is level to some metres.
std::string altimeter_table(const TempFolder& folder, const std::vector<std::string>& names) {
  const json truth = json::parse(text_of(grid_flight() / "truth/cameras.json"));
  std::string table = "image,above_ground,sd\n";
  for (std::size_t i = 0; i < names.size(); ++i)
    table += names[i] + "," + std::to_string(double(truth["images"][i]["centre"][2])) + ",3\n";
  write_text(folder / "altimeter.csv", table + "stranger.jpg,80,1\n");
  return folder / "altimeter.csv";
}

TEST_F(ReconstructPhotos, AnAltimeterGivesALocalFrameOfTrueSize) {
  write_good(6);
  const std::string lens = (grid_flight() / "truth/cameras.json").string();
  const Outcome made = waymark({"reconstruct", folder_ / "images", "-o", folder_ / "out", "--lens", lens,
                                "--altimeter", altimeter_table(folder_, names_), "--until", "dem"});
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, AllOf(HasSubstr("frame: local"), HasSubstr("a local frame of true size by 6 heights"),
                              HasSubstr("1 of 7 altimeter readings are of images that are not there")));
  EXPECT_TRUE(fs::exists(folder_ / "out/dem.tif"));
  const json found = json::parse(text_of(folder_ / "out/cameras.json")), truth = json::parse(text_of(lens));
  const auto apart = [](const json& file) {
    double squares = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      squares +=
          std::pow(double(file["images"][0]["centre"][axis]) - double(file["images"][5]["centre"][axis]), 2);
    return std::sqrt(squares);
  };
  EXPECT_NEAR(apart(found) / apart(truth), 1, 0.02);
  EXPECT_NEAR(double(found["images"][0]["centre"][2]), 300, 40);  // of the ground below it, which has relief
}

TEST_F(ReconstructPhotos, AnAltimeterOfOtherImagesIsRefused) {
  write_good(4);
  write_text(folder_ / "other.csv", "image,above_ground\nx.jpg,80\n");
  const Outcome other = run({"--altimeter", folder_ / "other.csv"});
  EXPECT_EQ(other.code, 1);
  EXPECT_THAT(other.err,
              HasSubstr("none of its 1 readings is of one of the 4 images; the first names 'x.jpg'"));
}

TEST_F(ReconstructPhotos, PixelsCountAsStoredWhateverTheOrientation) {
  for (std::size_t i = 0; i < 6; ++i)
    write_photo(image(names_[i]), pictures_[i], {.orientation = i % 2 == 0 ? 1 : 6});
  const Outcome turned = run_with_lens();
  EXPECT_EQ(turned.code, 0) << turned.err;
  EXPECT_THAT(turned.err, HasSubstr("6 of 6 images posed"));
}

TEST_F(ReconstructPhotos, MirroredPicturesAreNamed) {
  for (std::size_t i = 0; i < 6; ++i)
    write_photo(image(names_[i]), pictures_[i], {.orientation = i == 3 ? 2 : 1});
  const Outcome mirrored = run_with_lens();
  EXPECT_EQ(mirrored.code, 3);
  EXPECT_THAT(mirrored.err,
              AllOf(HasSubstr("5 of 6 images posed"),
                    HasSubstr(names_[3] + ": it is stored as a mirror image (EXIF orientation 2)")));
}

TEST_F(ReconstructPhotos, OnePositionInTheWrongHemisphereIsNamed) {
  positions_[0].lon = -*positions_[0].lon;
  write_good(6, true);
  const Outcome made = run_with_lens();
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, AllOf(HasSubstr("frame: EPSG:32632"), HasSubstr("the GPS position of " + names_[0]),
                              HasSubstr("wrong hemisphere of longitude")));
}

TEST_F(ReconstructPhotos, GpsGivesTheFrame) {
  write_good(6, true);
  const Outcome made = run_with_lens();
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, HasSubstr("frame: EPSG:32632"));
  EXPECT_TRUE(fs::exists(folder_ / "out/points.las"));
}

TEST_F(ReconstructPhotos, TheWrongHemisphereMirrorsTheImages) {
  for (PhotoExif& position : positions_) position.lon = -*position.lon;
  write_good(6, true);
  const Outcome east = run_with_lens();
  EXPECT_THAT(east.err, AllOf(HasSubstr("6 of 6 cameras look up"), HasSubstr("the hemispheres are right")));
  EXPECT_THAT(east.err, HasSubstr("frame: arbitrary"));
  for (PhotoExif& position : positions_) position.lon = -*position.lon, position.lat = -*position.lat;
  write_good(6, true);
  EXPECT_THAT(run_with_lens().err, HasSubstr("6 of 6 cameras look up"));
}

TEST_F(ReconstructPhotos, ExchangedLatitudeAndLongitudeGiveNoFrame) {
  for (PhotoExif& position : positions_) std::swap(position.lon, position.lat);
  write_good(6, true);
  const Outcome swapped = run_with_lens();
  EXPECT_THAT(swapped.err, HasSubstr("frame: arbitrary"));
  EXPECT_THAT(swapped.err, HasSubstr("latitude and longitude are not exchanged"));
}

TEST_F(ReconstructPhotos, WithoutAReferenceThereIsNoMetricMap) {
  write_good(6);
  const Outcome poses = run_with_lens();
  EXPECT_EQ(poses.code, 0) << poses.err;
  EXPECT_THAT(poses.err, HasSubstr("frame: arbitrary position, direction and scale"));
  const json file = json::parse(text_of(folder_ / "out/cameras.json"));
  EXPECT_EQ(file["frame"]["axes"], "arbitrary");
  EXPECT_FALSE(fs::exists(folder_ / "out/points.las"));
  const Outcome map =
      waymark({"reconstruct", folder_ / "images", "-o", folder_ / "out", "--lens",
               (grid_flight() / "truth/cameras.json").string(), "--map-landmarks", folder_ / "map.gpkg"});
  EXPECT_EQ(map.code, 1);
  EXPECT_THAT(map.err, HasSubstr("heights need poses in metres, but the frame of the poses is arbitrary"));
  EXPECT_FALSE(fs::exists(folder_ / "map.gpkg"));
  // Neither do these poses enter by themselves.
  const Outcome given = waymark({"reconstruct", folder_ / "images", "-o", folder_ / "again", "--cameras",
                                 folder_ / "out/cameras.json", "--crs", "local"});
  EXPECT_EQ(given.code, 1) << given.err;
  EXPECT_THAT(given.err, HasSubstr("the camera frame has no position, direction or scale in the map"));
}

TEST_F(ReconstructPhotos, ACoarseDemGivesTheFrame) {
  write_good(6);
  const std::string lens = (grid_flight() / "truth/cameras.json").string();
  const Outcome placed =
      run({"--lens", lens, "--dem", (grid_flight() / "dem.tif").string(), "--crs", "local"});
  ASSERT_EQ(placed.code, 0) << placed.err;
  EXPECT_THAT(placed.err,
              AllOf(HasSubstr("frame: local"), HasSubstr("placed in the coarse DEM by its relief")));
  const json found = json::parse(text_of(folder_ / "out/cameras.json")), truth = json::parse(text_of(lens));
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)  // a cell of the DEM
      EXPECT_NEAR(double(found["images"][i]["centre"][axis]), double(truth["images"][i]["centre"][axis]), 4)
          << i << " " << axis;
}

TEST_F(ReconstructPhotos, PicturesWithoutASunGiveAMap) {
  write_good(6);
  const Outcome mapped =
      waymark({"reconstruct", folder_ / "images", "-o", folder_ / "out", "--lens",
               (grid_flight() / "truth/cameras.json").string(), "--dem", (grid_flight() / "dem.tif").string(),
               "--crs", "local", "--map-landmarks", folder_ / "map.gpkg"});
  ASSERT_EQ(mapped.code, 0) << mapped.err;
  EXPECT_EQ(waymark({"validate", folder_ / "map.gpkg"}).code, 0);
}

TEST_F(ReconstructPhotos, AFlatDemGivesNoFrame) {
  write_good(6);
  std::string dem = "ncols 60\nnrows 60\nxllcorner -120\nyllcorner -120\ncellsize 4\n";
  for (int row = 0; row < 60; ++row) {
    for (int column = 0; column < 60; ++column) dem += "0 ";
    dem += "\n";
  }
  write_text(folder_ / "flat.asc", dem);
  const Outcome flat = run({"--lens", (grid_flight() / "truth/cameras.json").string(), "--dem",
                            folder_ / "flat.asc", "--crs", "local"});
  EXPECT_THAT(flat.err, AllOf(HasSubstr("in the DEM"), HasSubstr("frame: arbitrary")));
}

}  // namespace
}  // namespace waymark::test
