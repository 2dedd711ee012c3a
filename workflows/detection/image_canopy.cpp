// SPDX-License-Identifier: Apache-2.0
#include "workflows/detection/image_canopy.hpp"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>

#include "importers/gdal_session.hpp"
#include "importers/images/image.hpp"

namespace waymark::workflows {
namespace {

constexpr float kHighest = 150;  // metres

class ImageCanopy final : public CanopySource {
 public:
  ImageCanopy(const ImageInfo& image, CanopySign sign, double metres) : name_(image.name), sign_(sign) {
    grid_.columns = image.columns, grid_.rows = image.rows;
    grid_.where = {Crs::local(), 0, 0, metres, -metres};
    const int bands = sign == CanopySign::height ? 1 : 3;
    for (int band = 1; band <= bands; ++band)
      bands_.push_back(importers::import_image(image.path, {.georeference = false, .band = band}));
    full_ = image.saturated > 0 ? static_cast<float>(image.saturated) : 255.0F;
  }

  const GridGeometry& geometry() const override { return grid_; }
  const std::string& name() const override { return name_; }
  double ground_elevation(std::int64_t, std::int64_t) const override { return std::nan(""); }
  Grid<std::uint8_t> forest_types(const Window&) const override { return {}; }

  Grid<float> read(const Window& window) const override {
    std::vector<Pixels> pixels;
    for (const auto& band : bands_) pixels.push_back(band->read(window));
    Grid<float> canopy(window.columns, window.rows, kNoCanopy);
    for (std::size_t i = 0; i < canopy.cells().size(); ++i) {
      const auto at = [&](std::size_t band) { return pixels[band].cells()[i]; };
      const float sign = sign_ == CanopySign::height ? height(at(0)) : greenness(at(0), at(1), at(2));
      if (!std::isnan(sign)) canopy.cells()[i] = sign;
    }
    return canopy;
  }

 private:
  static float height(float h) { return h <= kHighest && h > -1000 ? std::max(h, 0.0F) : std::nanf(""); }
  // Squared: lawns are as green as crowns, but brighter.
  float darkness(float red, float green, float blue) const {
    const float dark = std::clamp(1 - (red + green + blue) / (3 * full_), 0.0F, 1.0F);
    return dark * dark;
  }
  // Twelve times the excess green: about the numbers a vegetation index of infrared would have.
  float greenness(float red, float green, float blue) const {
    const float index = 12 * (2 * green - red - blue) / std::max(red + green + blue, 1.0F);
    return std::max(index, 0.0F) * darkness(red, green, blue);
  }

  GridGeometry grid_;
  std::string name_;
  CanopySign sign_;
  std::vector<std::shared_ptr<const importers::ImportedImage>> bands_;
  float full_ = 255;
};

/// Returns true if a band labelled as transparency is one: files with near infrared (NAIP) mislabel theirs.
/// Transparency is all or nothing except at seams; 64 rows are sampled.
bool is_transparency(GDALRasterBand& band) {
  if (band.GetColorInterpretation() != GCI_AlphaBand) return false;
  const int columns = band.GetXSize(), rows = band.GetYSize();
  std::vector<double> row(static_cast<std::size_t>(columns));
  const double full = band.GetRasterDataType() == GDT_Byte ? 255 : 65535;
  double seen = 0, between = 0;
  for (int r = 0; r < rows; r += std::max(1, rows / 64)) {
    if (band.RasterIO(GF_Read, 0, r, columns, 1, row.data(), columns, 1, GDT_Float64, 0, 0) != CE_None)
      return true;  // reading the pixels later reports the error
    seen += columns;
    between += static_cast<double>(std::ranges::count_if(row, [&](double v) { return v > 0 && v < full; }));
  }
  return between < 0.05 * seen;
}

}  // namespace

std::unique_ptr<const CanopySource> image_canopy(const ImageInfo& image, CanopySign sign, double metres) {
  return std::make_unique<ImageCanopy>(image, sign, metres);
}

int band_count(const std::string& path) {
  const auto file = importers::open_raster(path);
  const int bands = file->GetRasterCount();
  return bands > 1 && is_transparency(*file->GetRasterBand(bands)) ? bands - 1 : bands;
}

}  // namespace waymark::workflows
