// SPDX-License-Identifier: Apache-2.0
#include "importers/images/image_pixels.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/error.hpp"

namespace waymark::importers {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
constexpr std::array<float, 3> kRec709{0.2126F, 0.7152F, 0.0722F};
constexpr std::int64_t kStripPixels = std::int64_t{1} << 20;

// One band with its weight and no-data values.
struct Channel {
  GDALRasterBand* band = nullptr;
  float weight = 1;
  float nodata = kNothing;          // NaN if there is none, equal to nothing
  float lowest = -3.4e38F;          // special values of ISIS are below
  std::vector<float> palette = {};  // brightness by index
};

std::vector<float> palette_of(GDALRasterBand& band) {
  std::vector<float> bright;
  if (const GDALColorTable* table = band.GetColorTable())
    for (int i = 0; i < table->GetColorEntryCount(); ++i) {
      const GDALColorEntry& c = *table->GetColorEntry(i);
      bright.push_back(c.c4 == 0
                           ? kNothing
                           : kRec709[0] * static_cast<float>(c.c1) + kRec709[1] * static_cast<float>(c.c2) +
                                 kRec709[2] * static_cast<float>(c.c3));
    }
  return bright;
}

Channel channel(GDALDataset& dataset, int index, float weight) {
  Channel made{.band = dataset.GetRasterBand(index), .weight = weight};
  int known = 0;
  const double nodata = made.band->GetNoDataValue(&known);
  if (known) made.nodata = static_cast<float>(nodata);
  if (made.band->GetRasterDataType() == GDT_Int16)
    if (const std::string driver = dataset.GetDriverName();
        driver.starts_with("ISIS") || driver.starts_with("PDS"))
      made.lowest = -32752;
  if (made.band->GetColorInterpretation() == GCI_PaletteIndex) made.palette = palette_of(*made.band);
  return made;
}

// Returns red, green, blue if the file names them; else the first band.
std::vector<Channel> channels(GDALDataset& dataset, int band) {
  if (band > 0) return {channel(dataset, band, 1)};
  std::array<int, 3> colours{};
  for (int i = dataset.GetRasterCount(); i > 0; --i) {
    const int kind = dataset.GetRasterBand(i)->GetColorInterpretation() - GCI_RedBand;
    if (kind >= 0 && kind < 3) colours[static_cast<std::size_t>(kind)] = i;
  }
  if (std::ranges::count(colours, 0) > 0) return {channel(dataset, 1, 1)};
  std::vector<Channel> made;
  for (std::size_t i = 0; i < 3; ++i) made.push_back(channel(dataset, colours[i], kRec709[i]));
  return made;
}

// Returns a mask or alpha band. No-data values are compared here, since all bands of a colour must have them.
GDALRasterBand* mask_of(GDALRasterBand& band) {
  const int flags = band.GetMaskFlags();
  return (flags & (GMF_ALL_VALID | GMF_NODATA)) ? nullptr : band.GetMaskBand();
}

void read_band(GDALRasterBand& band, const Window& window, GDALDataType type, void* into,
               const std::string& path) {
  const GdalListener gdal;
  if (band.RasterIO(GF_Read, static_cast<int>(window.column), static_cast<int>(window.row),
                    static_cast<int>(window.columns), static_cast<int>(window.rows), into,
                    static_cast<int>(window.columns), static_cast<int>(window.rows), type, 0, 0,
                    nullptr) != CE_None ||
      gdal.content_is_missing())
    throw Error(ErrorCode::input,
                fmt::format("rows {} to {} of the image cannot be read: {}", window.row, window.end_row() - 1,
                            gdal.error_about(path)),
                path, "the file is damaged: fetch or write it again");
}

void add(const Channel& from, std::vector<float>& read, std::vector<float>& sum, std::vector<char>& there) {
  for (std::size_t i = 0; i < sum.size(); ++i) {
    float value = read[i];
    const bool special = value == from.nodata || !(value >= from.lowest) || !(value <= 3.4e38F);
    if (!from.palette.empty()) {
      const auto index = static_cast<std::size_t>(std::max(value, 0.0F));
      value = index < from.palette.size() ? from.palette[index] : kNothing;
    }
    there[i] = static_cast<char>(there[i] | static_cast<char>(!special));
    sum[i] += from.weight * value;
  }
}

// A pixel of a colour image is missing if all its bands are.
std::vector<float> read_strip(const std::vector<Channel>& all, const Window& strip, const std::string& path) {
  const auto size = static_cast<std::size_t>(strip.cells());
  std::vector<float> sum(size, 0), read(size);
  std::vector<char> there(size, 0);
  for (const Channel& one : all) {
    read_band(*one.band, strip, GDT_Float32, read.data(), path);
    add(one, read, sum, there);
  }
  if (GDALRasterBand* mask = mask_of(*all[0].band)) {
    std::vector<unsigned char> shown(size);
    read_band(*mask, strip, GDT_Byte, shown.data(), path);
    for (std::size_t i = 0; i < size; ++i) there[i] = static_cast<char>(there[i] & (shown[i] != 0));
  }
  for (std::size_t i = 0; i < size; ++i)
    if (!there[i]) sum[i] = kNothing;
  return sum;
}

}  // namespace

Pixels read_pixels(GDALDataset& dataset, const Window& window, int band, const std::string& path) {
  Pixels pixels(window.columns, window.rows, kNothing);
  const std::int64_t left = std::max<std::int64_t>(window.column, 0),
                     top = std::max<std::int64_t>(window.row, 0);
  const std::int64_t right = std::min<std::int64_t>(window.end_column(), dataset.GetRasterXSize());
  const std::int64_t bottom = std::min<std::int64_t>(window.end_row(), dataset.GetRasterYSize());
  if (left >= right || top >= bottom) return pixels;
  const std::vector<Channel> all = channels(dataset, band);
  const std::int64_t step = std::max<std::int64_t>(1, kStripPixels / (right - left));
  for (std::int64_t row = top; row < bottom; row += step) {
    const Window strip{left, row, right - left, std::min(step, bottom - row)};
    const std::vector<float> values = read_strip(all, strip, path);
    for (std::int64_t r = 0; r < strip.rows; ++r)
      std::copy_n(values.begin() + r * strip.columns, strip.columns,
                  pixels.row(row + r - window.row).begin() + (left - window.column));
  }
  return pixels;
}

}  // namespace waymark::importers
