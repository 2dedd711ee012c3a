// SPDX-License-Identifier: Apache-2.0
// Small files that become large in memory.
#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>

#include "core/error.hpp"
#include "importers/images/image.hpp"
#include "importers/points/canopy.hpp"
#include "importers/rasters/dem.hpp"
#include "tests/support/laz_writer.hpp"

namespace waymark::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class Decompression : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "/decompression-XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return (folder_ / name).string();
  }
  static std::string refusal(const std::function<void()>& read) {
    try {
      read();
      return {};
    } catch (const Error& error) {
      return error.what();
    }
  }
  fs::path folder_;
};

/// A TIFF of one Deflate tile of side x side floats, of which some bytes are there.
std::string one_tile(std::uint32_t side) {
  std::string bytes = "II*";
  const auto put = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); };
  const auto entry = [&](std::uint16_t tag, std::uint16_t type, std::uint32_t value) {
    put(tag), put(type), put(std::uint32_t{1}), put(value);
  };
  bytes += '\0';
  put(std::uint32_t{8}), put(std::uint16_t{11});
  constexpr std::uint32_t kContent = 8 + 2 + 11 * 12 + 4;
  entry(256, 4, side), entry(257, 4, side), entry(258, 3, 32), entry(259, 3, 8), entry(262, 3, 1);
  entry(277, 3, 1), entry(322, 4, side), entry(323, 4, side), entry(324, 4, kContent), entry(325, 4, 10);
  entry(339, 3, 3);
  put(std::uint32_t{0});
  return bytes + std::string(10, 'x');
}

TEST_F(Decompression, OfATiffThatStatesMoreThanItCanHoldIsRefusedByName) {
  const std::string file = write("tile.tif", one_tile(1 << 15));
  const auto named = AllOf(HasSubstr("blocks of 32768 x 32768 cells"), HasSubstr("tile.tif"));
  EXPECT_THAT(refusal([&] { importers::import_dem({.files = {file}, .crs = "local"}); }), named);
  EXPECT_THAT(refusal([&] { importers::import_image(file, {.crs = "local"}); }), named);
  // A tile that a file of this size may hold; whether it does, reading says.
  const std::string small = write("small.tif", one_tile(1 << 10));
  EXPECT_THAT(refusal([&] { importers::import_dem({.files = {small}, .crs = "local"}); }),
              testing::Not(HasSubstr("blocks of")));
}

TEST_F(Decompression, OfPointsIsBoundedByTheMemory) {
  LazFile file{.format = 6, .origin = {500000, 5000000, 100}, .scale = 0.01};
  std::vector<RawPoint> chunk(20'000);
  for (RawPoint& p : chunk) p.at = {100, 100, 100}, p.classification = 2, p.time = 1000;
  chunk[0].at = {0, 0, 0}, chunk.back().at = {2000, 2000, 1500};
  for (int i = 0; i < 20; ++i) file.chunks.push_back(chunk);
  const std::string bytes = laz_bytes(file), path = write("bomb.laz", bytes);
  ASSERT_LT(bytes.size(), 40'000u) << "400,000 points";
  const auto read = [&](std::int64_t memory) {
    const auto canopy = importers::import_canopy({.las = {path}, .memory_bytes = memory});
    canopy->read({0, 0, 8, 8});
  };
  EXPECT_THAT(refusal([&] { read(2'000'000); }), AllOf(HasSubstr("4 times --memory holds (8 MB)"),
                                                       HasSubstr("bomb.laz"), HasSubstr("--memory")));
  EXPECT_EQ(refusal([&] { read(20'000'000); }), "");
}

}  // namespace
}  // namespace waymark::test
