// SPDX-License-Identifier: Apache-2.0
#include "importers/hash.hpp"

#include <gmock/gmock.h>

#include "pipeline/engine/runner.hpp"
#include "tests/importers/raster_maker.hpp"
#include "tests/support/dem_art.hpp"

namespace waymark::test {
using namespace importers;
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(HashFile, KnowsThePublishedSum) {  // FIPS 180-4, appendix B.1
  const InputFile file = hash_file(write_text("abc.txt", "abc"));
  EXPECT_EQ(file.bytes, 3u);
  EXPECT_EQ(file.sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(HashFile, OfAPlainFileIsThatOfItsBytes) {
  const std::string path = write_text("large.bin", std::string(3'000'000, 'x'));
  EXPECT_EQ(hash_file(path), pipeline::hash_plain_file(path));
  const std::string raster = write_raster({.path = write_text("a.tif", ""), .cells = dem_art("1 2")});
  EXPECT_EQ(hash_file(raster), pipeline::hash_plain_file(raster));
}

TEST(HashFile, ReadsVirtualPaths) {
  const std::string path = write_raster({.path = "/vsimem/hashed.tif", .cells = dem_art("1 2")});
  EXPECT_EQ(hash_file(path).path, path);
  EXPECT_GT(hash_file(path).bytes, 100u);
}

TEST(HashFile, OfAVirtualRasterSeesItsSources) {
  const std::string source = write_raster({.path = write_text("source.tif", ""), .cells = dem_art("1 2")});
  const std::string vrt = write_text("mosaic.vrt", "");
  GDALDatasetH opened = GDALOpen(source.c_str(), GA_ReadOnly);
  GDALClose(GDALCreateCopy(GDALGetDriverByName("VRT"), vrt.c_str(), opened, 0, nullptr, nullptr, nullptr));
  GDALClose(opened);
  EXPECT_THAT(raster_file_list(vrt), ElementsAre(vrt, source));
  const std::string before = hash_file(vrt).sha256;
  write_raster({.path = source, .cells = dem_art("1 3")});
  EXPECT_NE(hash_file(vrt).sha256, before);
}

TEST(HashFile, OfADeviceEnds) {
  EXPECT_EQ(hash_file("/dev/zero").bytes, 0u);
}

TEST(HashFile, SaysWhichFileIsMissing) {
  EXPECT_THAT(message_of([] { hash_file("/no/such/file"); }),
              AllOf(HasSubstr("the file cannot be read"), HasSubstr("/no/such/file")));
}

}  // namespace
}  // namespace waymark::test
