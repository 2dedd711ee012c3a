// SPDX-License-Identifier: Apache-2.0
#include "workflows/detection/colour_image.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "importers/images/image.hpp"
#include "workflows/detection/image_canopy.hpp"

namespace waymark::workflows {
namespace {

constexpr double kCell = 0.6;  // metres: of the images that the networks are trained on

/// Returns means of squares of `across` pixels; pixels without data are left out.
Grid<float> average_squares(const Pixels& pixels, std::int64_t across, float white) {
  Grid<float> out(pixels.columns() / across, pixels.rows() / across);
  for (std::int64_t r = 0; r < out.rows(); ++r)
    for (std::int64_t c = 0; c < out.columns(); ++c) {
      float sum = 0;
      int count = 0;
      for (std::int64_t y = r * across; y < (r + 1) * across; ++y)
        for (std::int64_t x = c * across; x < (c + 1) * across; ++x)
          if (const float value = pixels(x, y); !std::isnan(value)) sum += value, ++count;
      out(c, r) = count > 0 ? sum / (static_cast<float>(count) * white) : std::nanf("");
    }
  return out;
}

/// Returns the pixel value of white. Eight bits are used in full; deeper pixels rarely are, so white is then
/// estimated from the brightest 0.5 % of 64 rows.
float white_level(const std::vector<std::shared_ptr<const ImageSource>>& bands, const ImageInfo& image) {
  if (!(image.saturated > 255)) return 255;
  std::vector<float> values;
  const std::int64_t step = std::max<std::int64_t>(1, image.rows / 64);
  for (const auto& band : bands)
    for (std::int64_t row = 0; row < image.rows; row += step) {
      const Pixels line = band->read({0, row, image.columns, 1});
      for (const float value : line.cells())
        if (!std::isnan(value)) values.push_back(value);
    }
  if (values.empty()) return static_cast<float>(image.saturated);
  const auto bright = values.begin() + static_cast<std::ptrdiff_t>(0.995 * double(values.size() - 1));
  std::nth_element(values.begin(), bright, values.end());
  constexpr float kUsualFraction = 0.9F;  // of white, in pictures of eight bits
  return std::max(*bright / kUsualFraction, 1e-6F);
}

}  // namespace

ColourImage::ColourImage(const ImageInfo& image, double metres, int max_bands)
    : across_(std::max<std::int64_t>(1, std::llround(kCell / metres))),
      columns_((image.columns + across_ - 1) / across_),
      rows_((image.rows + across_ - 1) / across_),
      cell_(metres * static_cast<double>(across_)) {
  const int bands = std::min(max_bands, band_count(image.path));
  if (bands < 3)
    throw Error(ErrorCode::input, "not a colour image: it has fewer than three bands", image.path);
  for (int band = 1; band <= bands; ++band)
    bands_.push_back(importers::import_image(image.path, {.georeference = false, .band = band}));
  white_ = white_level(bands_, image);
}

ColourImage::~ColourImage() = default;

pipeline::ColourWindow ColourImage::read(const Window& cells) const {
  pipeline::ColourWindow window{cells, cell_, {}};
  for (const auto& band : bands_)
    window.bands.push_back(average_squares(band->read({cells.column * across_, cells.row * across_,
                                                       cells.columns * across_, cells.rows * across_}),
                                           across_, white_));
  for (std::size_t i = 0; i < window.bands[0].cells().size(); ++i) {
    const bool unknown = std::ranges::any_of(
        window.bands, [&](const Grid<float>& band) { return std::isnan(band.cells()[i]); });
    if (!unknown) continue;
    for (Grid<float>& band : window.bands) band.cells()[i] = std::nanf("");
  }
  return window;
}

}  // namespace waymark::workflows
