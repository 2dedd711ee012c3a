// SPDX-License-Identifier: Apache-2.0
#include "importers/keep_hashes.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "importers/hash.hpp"
#include "tests/importers/raster_maker.hpp"
#include "tests/support/dem_art.hpp"

namespace waymark::test {
using namespace importers;
namespace {

namespace fs = std::filesystem;
using std::chrono::seconds;

/// Hashers with a folder in common, as those of the calls of a plan.
class KeepHashes : public testing::Test {
 protected:
  InputFile hash_in_new_call(const std::string& path, seconds settled = seconds(-1)) {
    const auto counted = [&](const std::string& file) {
      ++readings_;
      return hash_file(file);
    };
    return keep_hashes(counted, folder_, settled)(path);
  }
  static std::string large_file(const std::string& name, char content, std::size_t bytes = 2'000'000) {
    return write_text(name, std::string(bytes, content));
  }

  fs::path folder_ = fs::path(write_text("kept", "")).parent_path() / "inputs";
  int readings_ = 0;

  void SetUp() override { fs::remove_all(folder_); }
};

TEST_F(KeepHashes, ReadALargeFileOnce) {
  const std::string path = large_file("large.bin", 'x');
  for (int call = 0; call < 3; ++call) EXPECT_EQ(hash_in_new_call(path), hash_file(path));
  EXPECT_EQ(readings_, 1);
}

TEST_F(KeepHashes, NoticeWhatChanged) {
  const std::string path = large_file("large.bin", 'x');
  hash_in_new_call(path);
  large_file("large.bin", 'y', 2'000'001);
  EXPECT_EQ(hash_in_new_call(path), hash_file(path)) << "size";
  const auto written = fs::last_write_time(path);
  fs::rename(large_file("other.bin", 'z', 2'000'001), path);
  fs::last_write_time(path, written);
  EXPECT_EQ(hash_in_new_call(path), hash_file(path)) << "another file of the same size and time";
  fs::last_write_time(path, written + seconds(1));
  hash_in_new_call(path);
  EXPECT_EQ(readings_, 4);
}

TEST_F(KeepHashes, NoticeTheSourcesOfAVirtualRaster) {
  const RasterFile source{.path = write_text("source.tif", ""),
                          .cells = Grid<double>(1200, 1000, 3.),
                          .options = {"COMPRESS=NONE"}};
  write_raster(source);
  const std::string vrt = write_text("mosaic.vrt", "");
  GDALDatasetH opened = GDALOpen(source.path.c_str(), GA_ReadOnly);
  GDALClose(GDALCreateCopy(GDALGetDriverByName("VRT"), vrt.c_str(), opened, 0, nullptr, nullptr, nullptr));
  GDALClose(opened);
  hash_in_new_call(vrt);
  EXPECT_EQ(hash_in_new_call(vrt), hash_file(vrt));
  EXPECT_EQ(readings_, 1);
  std::ofstream(source.path, std::ios::app) << "more";
  EXPECT_EQ(hash_in_new_call(vrt), hash_file(vrt));
  EXPECT_EQ(readings_, 2);
}

TEST_F(KeepHashes, ReadAgainWhatMayStillChange) {
  const std::string path = large_file("large.bin", 'x'), small = write_text("small.bin", "abc"),
                    in_memory =
                        write_raster({.path = "/vsimem/a.tif", .cells = Grid<double>(1200, 1000, 3.)});
  for (int call = 0; call < 2; ++call) {
    hash_in_new_call(path, seconds(1000));
    hash_in_new_call(small);
    hash_in_new_call(in_memory);
  }
  EXPECT_EQ(readings_, 6);
}

TEST_F(KeepHashes, ReadAgainIfTheirRecordIsDamaged) {
  const std::string path = large_file("large.bin", 'x');
  hash_in_new_call(path);
  for (const char* text : {"", "{", "[]", R"({"bytes": 3, "sha256": "ab"})", R"({"bytes": -1})"}) {
    for (const auto& record : fs::directory_iterator(folder_)) std::ofstream(record.path()) << text;
    EXPECT_EQ(hash_in_new_call(path), hash_file(path)) << text;
  }
  EXPECT_EQ(readings_, 6);
}

}  // namespace
}  // namespace waymark::test
