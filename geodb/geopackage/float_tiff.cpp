// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstring>

#include "geodb/geopackage/dem_coverage.hpp"

namespace waymark::geodb {
namespace {

enum class Field : std::uint16_t { number16 = 3, number32 = 4 };

struct Entry {
  std::uint16_t tag;
  Field type;
  std::uint32_t value;
};

template <class T>
void append(std::vector<std::byte>& bytes, T value) {
  const std::size_t end = bytes.size();
  bytes.resize(end + sizeof value);
  std::memcpy(bytes.data() + end, &value, sizeof value);
}

}  // namespace

std::vector<std::byte> float_tiff(const Grid<float>& cells) {
  const auto width = static_cast<std::uint32_t>(cells.columns()),
             height = static_cast<std::uint32_t>(cells.rows());
  const std::uint32_t byte_count = width * height * 4;
  constexpr std::uint32_t kEntries = 10, kHeader = 8, kDirectory = 2 + kEntries * 12 + 4;
  const std::array<Entry, kEntries> entries{{
      {256, Field::number32, width},
      {257, Field::number32, height},
      {258, Field::number16, 32},                    // bits per sample
      {259, Field::number16, 1},                     // no compression
      {262, Field::number16, 1},                     // black is zero
      {273, Field::number32, kHeader + kDirectory},  // where the strip begins
      {277, Field::number16, 1},                     // samples per pixel
      {278, Field::number32, height},                // rows per strip
      {279, Field::number32, byte_count},
      {339, Field::number16, 3},  // IEEE float
  }};
  std::vector<std::byte> tiff;
  tiff.reserve(kHeader + kDirectory + byte_count);
  for (const char c : {'I', 'I'}) append(tiff, c);
  append(tiff, std::uint16_t{42});
  append(tiff, kHeader);
  append(tiff, static_cast<std::uint16_t>(kEntries));
  for (const auto& [tag, type, value] : entries) {
    append(tiff, tag);
    append(tiff, type);
    append(tiff, std::uint32_t{1});
    append(tiff, value);
  }
  append(tiff, std::uint32_t{0});  // no further directory
  for (const float cell : cells.cells()) append(tiff, cell);
  return tiff;
}

}  // namespace waymark::geodb
