// SPDX-License-Identifier: Apache-2.0
#include "exporters/raster/image_file.hpp"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/atomic_file.hpp"
#include "core/output_error.hpp"
#include "exporters/gdal_messages.hpp"

namespace waymark::exporters {

void write_image(const std::filesystem::path& path, const Pixels& image, int bits) {
  GdalMessages messages;
  AtomicFile aside(path);
  const int columns = static_cast<int>(image.columns()), rows = static_cast<int>(image.rows());
  const double full = bits == 16 ? 65535 : 255;
  std::vector<std::uint16_t> values;
  values.reserve(image.cells().size());
  for (const float p : image.cells())
    values.push_back(static_cast<std::uint16_t>(p > 0 ? std::lround(std::min(1.0, double(p)) * full) : 0));

  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  const GDALDatasetUniquePtr picture(
      memory->Create("", columns, rows, 1, bits == 16 ? GDT_UInt16 : GDT_Byte, nullptr));
  if (!picture || picture->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, columns, rows, values.data(), columns,
                                                      rows, GDT_UInt16, 0, 0, nullptr) != CE_None)
    fail_output(path, messages.cause("out of memory"));
  const char* const options[] = {"ZLEVEL=6", nullptr};
  GDALDriver* png = GetGDALDriverManager()->GetDriverByName("PNG");
  GDALDatasetUniquePtr file(png->CreateCopy(aside.path().c_str(), picture.get(), false,
                                            const_cast<char**>(options), nullptr, nullptr));
  if (!file) fail_output(path, messages.cause("not all of it was written"));
  file.reset();
  if (!messages.failures().empty()) fail_output(path, messages.cause("not all of it was written"));
  aside.commit();
}

}  // namespace waymark::exporters
