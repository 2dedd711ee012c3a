// SPDX-License-Identifier: Apache-2.0
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <atomic>
#include <memory>

#include "core/error.hpp"
#include "exporters/gdal_messages.hpp"
#include "exporters/report/relief_picture.hpp"

namespace waymark::exporters {
namespace {

std::string unique_name(const char* extension) {
  static std::atomic<int> count = 0;
  return fmt::format("/vsimem/waymark_picture_{}.{}", count++, extension);
}

std::string taken_from_memory(const std::string& name) {
  vsi_l_offset bytes = 0;
  GByte* content = VSIGetMemFileBuffer(name.c_str(), &bytes, FALSE);
  std::string copy(content, content + bytes);
  VSIUnlink(name.c_str());
  return copy;
}

/// Encodes the first `bands` of red, green, blue, alpha with a driver of GDAL.
std::string encoded(const Grid<Colour>& picture, const char* driver, int bands, const char* option) {
  const GdalMessages messages;
  const int columns = static_cast<int>(picture.columns()), rows = static_cast<int>(picture.rows());
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  GDALDriver* format = GetGDALDriverManager()->GetDriverByName(driver);
  if (memory == nullptr || format == nullptr)
    throw Error(ErrorCode::environment, fmt::format("this GDAL has no {} driver", driver),
                "the pictures of a report", "install GDAL's raster drivers (Debian: libgdal32)");
  const std::unique_ptr<GDALDataset> pixels(memory->Create("", columns, rows, bands, GDT_Byte, nullptr));
  std::vector<Colour> cells(picture.cells().begin(), picture.cells().end());
  const std::string name = unique_name(driver);
  CPLStringList options;
  options.AddString(option);
  const bool copied = pixels->RasterIO(GF_Write, 0, 0, columns, rows, cells.data(), columns, rows, GDT_Byte,
                                       bands, nullptr, 4, 4 * columns, 1, nullptr) == CE_None;
  if (bands == 4) pixels->GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
  const std::unique_ptr<GDALDataset> file(
      copied ? format->CreateCopy(name.c_str(), pixels.get(), FALSE, options.List(), nullptr, nullptr)
             : nullptr);
  if (!file)
    throw Error(ErrorCode::environment, "a picture could not be encoded: " + messages.cause("out of memory"));
  file->FlushCache();
  return taken_from_memory(name);
}

}  // namespace

std::string encode_png(const Grid<Colour>& picture) {
  return encoded(picture, "PNG", 4, "ZLEVEL=6");
}

std::string encode_rgb_png(const Grid<Colour>& picture) {
  return encoded(picture, "PNG", 3, "ZLEVEL=6");
}

std::string encode_jpeg(const Grid<Colour>& picture, int quality) {
  const bool grey = std::ranges::all_of(
      picture.cells(), [](const Colour& c) { return c.red == c.green && c.green == c.blue; });
  return encoded(picture, "JPEG", grey ? 1 : 3, fmt::format("QUALITY={}", quality).c_str());
}

}  // namespace waymark::exporters
