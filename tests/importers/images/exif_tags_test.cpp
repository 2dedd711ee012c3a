// SPDX-License-Identifier: Apache-2.0
#include "importers/images/exif_tags.hpp"

#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <gmock/gmock.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <tuple>
#include <vector>

#include "importers/images/image_labels.hpp"
#include "importers/images/photo_metadata.hpp"

namespace waymark::test {
namespace {
using namespace importers;

/// Bytes of a TIFF structure, in either order.
class TiffBytes {
 public:
  explicit TiffBytes(bool big) : big_(big) { text(big ? "MM" : "II"), number(42, 2), number(8, 4); }

  void number(std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) bytes_ += static_cast<char>(value >> 8 * (big_ ? size - 1 - i : i) & 0xff);
  }
  void text(const std::string& bytes) { bytes_ += bytes; }

  struct Entry {
    std::uint32_t tag, type, count;
    std::vector<std::uint32_t> values = {};
    std::string ascii = {};
  };
  // Appends a directory, followed by the values that do not fit into it.
  void directory(const std::vector<Entry>& entries) {
    number(static_cast<std::uint32_t>(entries.size()), 2);
    std::size_t beside = bytes_.size() + 12 * entries.size() + 4;
    TiffBytes values(big_);
    values.bytes_.clear();
    for (const Entry& e : entries) {
      const int size = e.type == 3 ? 2 : 4;
      TiffBytes one(big_);
      one.bytes_ = e.ascii;
      for (const std::uint32_t v : e.values) one.number(v, size);
      number(e.tag, 2), number(e.type, 2), number(e.count, 4);
      if (one.bytes_.size() > 4) {
        number(static_cast<std::uint32_t>(beside + values.bytes_.size()), 4);
        values.text(one.bytes_);
      } else {
        text(one.bytes_ + std::string(4 - one.bytes_.size(), '\0'));
      }
    }
    number(0, 4);
    text(values.bytes_);
  }
  std::size_t size() const { return bytes_.size(); }
  const std::string& bytes() const { return bytes_; }

 private:
  bool big_;
  std::string bytes_ = {};
};

using Entry = TiffBytes::Entry;

// A picture of one pixel, turned, by a camera at 46.5 degrees south, 7.25 degrees east.
std::string picture_bytes(bool big) {
  const auto whole = [&](std::uint32_t picture, std::uint32_t navigation, std::uint32_t pixel) {
    TiffBytes out(big);
    out.directory({{0x100, 4, 1, {1}},
                   {0x101, 4, 1, {1}},
                   {0x102, 3, 1, {8}},
                   {0x103, 3, 1, {1}},
                   {0x106, 3, 1, {1}},
                   {0x10f, 2, 6, {}, std::string("Maker\0", 6)},
                   {0x110, 2, 2, {}, std::string("M\0", 2)},
                   {0x111, 4, 1, {pixel}},
                   {0x112, 3, 1, {6}},
                   {0x115, 3, 1, {1}},
                   {0x116, 4, 1, {1}},
                   {0x117, 4, 1, {1}},
                   {0x8769, 4, 1, {picture}},
                   {0x8825, 4, 1, {navigation}}});
    const std::size_t first = out.size();
    out.directory({{0x9003, 2, 20, {}, std::string("2024:05:06 07:08:09\0", 20)},
                   {0x9011, 2, 7, {}, std::string("+02:00\0", 7)},
                   {0x920a, 5, 1, {88, 10}},
                   {0xa405, 3, 1, {24}}});
    const std::size_t second = out.size();
    out.directory({{1, 2, 2, {}, std::string("S\0", 2)},
                   {2, 5, 3, {46, 1, 30, 1, 0, 1}},
                   {3, 2, 2, {}, std::string("E\0", 2)},
                   {4, 5, 3, {7, 1, 15, 1, 0, 0}}});
    const std::size_t third = out.size();
    out.text("x");
    return std::tuple(out.bytes(), static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(second),
                      static_cast<std::uint32_t>(third));
  };
  const auto [draft, picture, navigation, pixel] = whole(0, 0, 0);
  return std::get<0>(whole(picture, navigation, pixel));
}

std::string file_of(const std::string& name, const std::string& bytes) {
  const auto path = std::filesystem::path(testing::TempDir()) / name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path.string();
}

// A PNG of one pixel with a chunk of EXIF before its data.
std::string png_bytes(const std::string& exif) {
  const GdalListener quiet;
  GDALDriverManager& drivers = *GetGDALDriverManager();
  const GdalDataset memory(drivers.GetDriverByName("MEM")->Create("", 1, 1, 1, GDT_Byte, nullptr));
  const std::string path = "/vsimem/exif_tags_test.png";
  GDALClose(
      drivers.GetDriverByName("PNG")->CreateCopy(path.c_str(), memory.get(), 0, nullptr, nullptr, nullptr));
  vsi_l_offset size = 0;
  GByte* const made = VSIGetMemFileBuffer(path.c_str(), &size, 0);
  const std::string png(reinterpret_cast<const char*>(made), static_cast<std::size_t>(size));
  VSIUnlink(path.c_str());
  constexpr std::size_t kHead = 33;  // signature and IHDR
  TiffBytes length(true);
  const std::size_t before = length.size();
  length.number(static_cast<std::uint32_t>(exif.size()), 4);
  return png.substr(0, kHead) + length.bytes().substr(before) + "eXIf" + exif + std::string(4, '\0') +
         png.substr(kHead);
}

void expect_the_picture(const std::string& path) {
  const GdalListener quiet;
  const GdalDataset dataset = open_raster(path);
  const PhotoMetadata m = read_photo_metadata(*dataset, path);
  EXPECT_EQ(m.camera, "Maker M");
  EXPECT_EQ(m.orientation, 6);
  EXPECT_EQ(m.focal_source, FocalSource::film_equivalent);
  ASSERT_TRUE(m.position);
  EXPECT_NEAR(m.position->lat, -46.5, 1e-9);
  EXPECT_NEAR(m.position->lon, 7.25, 1e-9);
  EXPECT_EQ(time_taken(*dataset, "").utc, 1714972089.0);  // 05:08:09 UTC
}

TEST(ExifTags, TiffHasThemInItsOwnDirectories) {
  for (const bool big : {false, true})
    expect_the_picture(file_of(big ? "exif_big.tif" : "exif_little.tif", picture_bytes(big)));
}

TEST(ExifTags, PngHasThemInAChunk) {
  std::string png = png_bytes(picture_bytes(true));
  // GDAL does not check the sums of chunks that it does not read.
  expect_the_picture(file_of("exif.png", png));
}

TEST(ExifTags, DamagedTagsAreAbsent) {
  const std::string whole = picture_bytes(false);
  for (std::size_t at = 8; at < 190; ++at) {
    std::string bytes = whole;
    for (const char wrong : {'\0', '\x7f', '\xff'}) {
      bytes[at] = wrong;
      const std::string path = file_of("exif_damaged.tif", bytes);
      const GdalListener quiet;
      const GdalDataset dataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
      if (!dataset) continue;
      EXPECT_LE(read_exif_tags(*dataset).values.size(), 12u);
    }
  }
}

}  // namespace
}  // namespace waymark::test
