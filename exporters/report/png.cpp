// SPDX-License-Identifier: Apache-2.0
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <atomic>
#include <memory>

#include "core/error.hpp"
#include "exporters/gdal_messages.hpp"
#include "exporters/report/relief_picture.hpp"

namespace waymark::exporters {
namespace {

std::string unique_name() {
  static std::atomic<int> count = 0;
  return fmt::format("/vsimem/waymark_relief_{}.png", count++);
}

std::string taken_from_memory(const std::string& name) {
  vsi_l_offset bytes = 0;
  GByte* content = VSIGetMemFileBuffer(name.c_str(), &bytes, FALSE);
  std::string copy(content, content + bytes);
  VSIUnlink(name.c_str());
  return copy;
}

}  // namespace

std::string encode_png(const Grid<Colour>& picture) {
  const GdalMessages messages;
  const int columns = static_cast<int>(picture.columns()), rows = static_cast<int>(picture.rows());
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  GDALDriver* png = GetGDALDriverManager()->GetDriverByName("PNG");
  if (memory == nullptr || png == nullptr)
    throw Error(ErrorCode::environment, "this GDAL has no PNG driver", "the relief of a report",
                "install GDAL's raster drivers (Debian: libgdal32)");
  const std::unique_ptr<GDALDataset> pixels(memory->Create("", columns, rows, 4, GDT_Byte, nullptr));
  std::vector<Colour> cells(picture.cells().begin(), picture.cells().end());
  const std::string name = unique_name();
  CPLStringList options;
  options.SetNameValue("ZLEVEL", "9");
  const bool copied = pixels->RasterIO(GF_Write, 0, 0, columns, rows, cells.data(), columns, rows, GDT_Byte,
                                       4, nullptr, 4, 4 * columns, 1, nullptr) == CE_None;
  pixels->GetRasterBand(4)->SetColorInterpretation(GCI_AlphaBand);
  const std::unique_ptr<GDALDataset> file(
      copied ? png->CreateCopy(name.c_str(), pixels.get(), FALSE, options.List(), nullptr, nullptr)
             : nullptr);
  if (!file)
    throw Error(ErrorCode::environment,
                "the relief picture could not be encoded: " + messages.cause("out of memory"));
  return taken_from_memory(name);
}

}  // namespace waymark::exporters
