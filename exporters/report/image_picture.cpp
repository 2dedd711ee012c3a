// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/image_picture.hpp"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "exporters/gdal_messages.hpp"

namespace waymark::exporters {
namespace {

constexpr double kLargePart = 1e8;  // pixels; beyond, averaging all of them costs seconds
constexpr double kClipped = 0.005;  // fraction of pixels that become black, and white
constexpr int kQuality = 82;

using Dataset = std::unique_ptr<GDALDataset>;

Dataset open_image(const std::string& path) {
  return Dataset(
      GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
}

std::optional<std::vector<float>> read_band(GDALRasterBand& band, const Window& part, int columns, int rows) {
  GDALRasterIOExtraArg extra;
  INIT_RASTERIO_EXTRA_ARG(extra);
  const bool large = static_cast<double>(part.cells()) > kLargePart && band.GetOverviewCount() == 0;
  const bool shrinks = part.columns > columns;
  extra.eResampleAlg = large ? GRIORA_NearestNeighbour : shrinks ? GRIORA_Average : GRIORA_Bilinear;
  std::vector<float> cells(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const bool read = band.RasterIO(GF_Read, static_cast<int>(part.column), static_cast<int>(part.row),
                                  static_cast<int>(part.columns), static_cast<int>(part.rows), cells.data(),
                                  columns, rows, GDT_Float32, 0, 0, &extra) == CE_None;
  if (!read) return {};
  int has_nodata = FALSE;
  const double nodata = band.GetNoDataValue(&has_nodata);
  for (float& cell : cells)
    if (has_nodata != FALSE && cell == static_cast<float>(nodata)) cell = std::nanf("");
  return cells;
}

struct Stretch {
  float dark = 0, bright = 1;
  std::uint8_t operator()(float value) const {
    if (std::isnan(value)) return 0;
    return static_cast<std::uint8_t>(
        std::lround(255 * std::clamp((value - dark) / (bright - dark), 0.F, 1.F)));
  }
};

Stretch stretch_of(const std::vector<std::vector<float>>& bands) {
  std::vector<float> values;
  for (const auto& band : bands)
    for (const float value : band)
      if (std::isfinite(value)) values.push_back(value);
  if (values.empty()) return {};
  const auto at = [&](double share) {
    const auto place =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), place, values.end());
    return *place;
  };
  const float dark = at(kClipped), bright = at(1 - kClipped);
  return {dark, bright > dark ? bright : dark + 1};
}

}  // namespace

std::optional<Window> image_extent(const std::string& path) {
  const GdalMessages quiet;
  const Dataset image = open_image(path);
  if (!image || image->GetRasterCount() == 0) return {};
  return Window{0, 0, image->GetRasterXSize(), image->GetRasterYSize()};
}

std::optional<Grid<Colour>> image_pixels(const std::string& path, const Window& part, std::int64_t longest) {
  const GdalMessages quiet;
  const Dataset image = open_image(path);
  if (!image || image->GetRasterCount() == 0 || part.columns < 1 || part.rows < 1) return {};
  const double shrink =
      std::min(1.0, static_cast<double>(longest) / static_cast<double>(std::max(part.columns, part.rows)));
  const int columns = std::max(1, static_cast<int>(std::lround(shrink * static_cast<double>(part.columns))));
  const int rows = std::max(1, static_cast<int>(std::lround(shrink * static_cast<double>(part.rows))));
  const bool colour =
      image->GetRasterCount() >= 3 && image->GetRasterBand(1)->GetRasterDataType() == GDT_Byte;
  std::vector<std::vector<float>> bands;
  for (int b = 1; b <= (colour ? 3 : 1); ++b) {
    auto cells = read_band(*image->GetRasterBand(b), part, columns, rows);
    if (!cells) return {};
    bands.push_back(std::move(*cells));
  }
  const Stretch stretch = stretch_of(bands);
  Grid<Colour> pixels(columns, rows);
  for (std::size_t i = 0; i < bands[0].size(); ++i)
    pixels.cells()[i] = {stretch(bands[0][i]), stretch(bands[colour ? 1 : 0][i]),
                         stretch(bands[colour ? 2 : 0][i]),
                         static_cast<std::uint8_t>(std::isnan(bands[0][i]) ? 0 : 255)};
  return pixels;
}

std::optional<ImagePicture> image_picture(const std::string& path, const Window& part, std::int64_t longest) {
  const auto pixels = image_pixels(path, part, longest);
  if (!pixels) return {};
  return ImagePicture{.jpeg = encode_jpeg(*pixels, kQuality),
                      .columns = pixels->columns(),
                      .rows = pixels->rows(),
                      .part = part};
}

}  // namespace waymark::exporters
