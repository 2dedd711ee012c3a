// SPDX-License-Identifier: Apache-2.0
#include "photo_files.hpp"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <memory>
#include <random>
#include <sstream>
#include <stdexcept>

namespace waymark::test {
namespace {

/// Little-endian TIFF directory, as in EXIF.
class Directory {
 public:
  explicit Directory(std::uint32_t offset) : offset_(offset) {}
  void add(std::uint16_t tag, std::uint16_t type, std::uint32_t count, const std::string& value) {
    entries_.push_back({tag, type, count, value});
  }
  /// Bytes of the directory and its long values.
  std::string bytes() const {
    std::string head, tail;
    put(head, static_cast<std::uint16_t>(entries_.size()));
    const auto end = static_cast<std::uint32_t>(offset_ + 2 + 12 * entries_.size() + 4);
    for (const Entry& e : entries_) {
      put(head, e.tag), put(head, e.type), put(head, e.count);
      if (e.value.size() <= 4) {
        head += e.value + std::string(4 - e.value.size(), '\0');
      } else {
        put(head, static_cast<std::uint32_t>(end + tail.size()));
        tail += e.value;
      }
    }
    put(head, std::uint32_t{0});
    return head + tail;
  }
  template <class T>
  static void put(std::string& to, T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) to += static_cast<char>(value >> (8 * i) & 0xff);
  }

 private:
  struct Entry {
    std::uint16_t tag, type;
    std::uint32_t count;
    std::string value;
  };
  std::uint32_t offset_;
  std::vector<Entry> entries_;
};

std::string rational(double value, std::uint32_t denominator) {
  std::string out;
  Directory::put(out, static_cast<std::uint32_t>(std::llround(value * denominator)));
  Directory::put(out, denominator);
  return out;
}

std::string degrees(double value) {
  value = std::abs(value);
  const double whole = std::floor(value), minutes = std::floor((value - whole) * 60);
  return rational(whole, 1) + rational(minutes, 1) +
         rational(((value - whole) * 60 - minutes) * 60, 1'000'000);
}

std::string exif_segment(const PhotoExif& exif) {
  constexpr std::uint16_t kByte = 1, kText = 2, kShort = 3, kLong = 4, kRational = 5;
  const std::string tiff_head("II\x2a\0\x08\0\0\0", 8);
  std::string orientation, pointer;
  Directory::put(orientation, static_cast<std::uint16_t>(exif.orientation));
  constexpr std::uint32_t kGps = 8 + 2 + 2 * 12 + 4;
  Directory::put(pointer, kGps);
  Directory first(8), gps(kGps);
  first.add(0x0112, kShort, 1, orientation);
  first.add(0x8825, kLong, 1, pointer);
  if (exif.lat && exif.lon) {
    gps.add(1, kText, 2, *exif.lat < 0 ? std::string("S\0", 2) : std::string("N\0", 2));
    gps.add(2, kRational, 3, degrees(*exif.lat));
    gps.add(3, kText, 2, *exif.lon < 0 ? std::string("W\0", 2) : std::string("E\0", 2));
    gps.add(4, kRational, 3, degrees(*exif.lon));
  }
  if (exif.altitude) {
    gps.add(5, kByte, 1, std::string(1, '\0'));
    gps.add(6, kRational, 1, rational(*exif.altitude, 1000));
  }
  const std::string body = std::string("Exif\0\0", 6) + tiff_head + first.bytes() + gps.bytes();
  std::string segment = "\xff\xe1";
  const std::size_t length = body.size() + 2;
  segment += static_cast<char>(length >> 8 & 0xff);
  segment += static_cast<char>(length & 0xff);
  return segment + body;
}

}  // namespace

GreyPicture read_picture(const std::filesystem::path& file) {
  GDALAllRegister();
  const std::unique_ptr<GDALDataset> dataset(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
  if (!dataset) throw std::runtime_error("cannot read " + file.string());
  GreyPicture out{dataset->GetRasterXSize(), dataset->GetRasterYSize()};
  out.grey.resize(static_cast<std::size_t>(out.columns) * static_cast<std::size_t>(out.rows));
  if (dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, out.columns, out.rows, out.grey.data(), out.columns,
                                          out.rows, GDT_Byte, 0, 0) != CE_None)
    throw std::runtime_error("cannot read " + file.string());
  return out;
}

void write_photo(const std::filesystem::path& file, const GreyPicture& picture, const PhotoExif& exif) {
  GDALAllRegister();
  GDALDriverManager& drivers = *GetGDALDriverManager();
  const std::unique_ptr<GDALDataset> memory(
      drivers.GetDriverByName("MEM")->Create("", picture.columns, picture.rows, 1, GDT_Byte, nullptr));
  std::vector<unsigned char> grey = picture.grey;
  if (memory->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, picture.columns, picture.rows, grey.data(),
                                         picture.columns, picture.rows, GDT_Byte, 0, 0) != CE_None)
    throw std::runtime_error("cannot fill a picture");
  const std::string plain = file.string() + ".plain";
  CPLStringList options;
  options.SetNameValue("QUALITY", "97");
  GDALClose(drivers.GetDriverByName("JPEG")->CreateCopy(plain.c_str(), memory.get(), FALSE, options.List(),
                                                        nullptr, nullptr));
  std::ifstream in(plain, std::ios::binary);
  std::stringstream bytes;
  bytes << in.rdbuf();
  const std::string jpeg = bytes.str();
  std::ofstream(file, std::ios::binary) << jpeg.substr(0, 2) << exif_segment(exif) << jpeg.substr(2);
  std::filesystem::remove(plain);
  std::filesystem::remove(plain + ".aux.xml");
}

GreyPicture mirrored_picture(const GreyPicture& picture) {
  GreyPicture out = picture;
  for (int r = 0; r < picture.rows; ++r)
    std::reverse(out.grey.begin() + r * picture.columns, out.grey.begin() + (r + 1) * picture.columns);
  return out;
}

GreyPicture halved_picture(const GreyPicture& picture) {
  GreyPicture out{picture.columns / 2, picture.rows / 2};
  const auto at = [&](int c, int r) {
    return int{picture.grey[static_cast<std::size_t>(r * picture.columns + c)]};
  };
  for (int r = 0; r < out.rows; ++r)
    for (int c = 0; c < out.columns; ++c)
      out.grey.push_back(static_cast<unsigned char>(
          (at(2 * c, 2 * r) + at(2 * c + 1, 2 * r) + at(2 * c, 2 * r + 1) + at(2 * c + 1, 2 * r + 1) + 2) /
          4));
  return out;
}

GreyPicture uniform_picture(int columns, int rows, unsigned char grey) {
  return {columns, rows, std::vector<unsigned char>(static_cast<std::size_t>(columns * rows), grey)};
}

GreyPicture noise_picture(int columns, int rows, unsigned seed) {
  std::mt19937 random(seed);
  GreyPicture out = uniform_picture(columns, rows, 0);
  const int across = (columns + 3) / 4;
  std::vector<unsigned char> blocks(static_cast<std::size_t>(across * ((rows + 3) / 4)));
  for (unsigned char& block : blocks) block = static_cast<unsigned char>(40 + random() % 180);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      out.grey[static_cast<std::size_t>(r * columns + c)] =
          blocks[static_cast<std::size_t>(r / 4 * across + c / 4)];
  return out;
}

}  // namespace waymark::test
