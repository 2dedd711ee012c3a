// SPDX-License-Identifier: Apache-2.0
#include "apps/colour_image.hpp"

#include <algorithm>
#include <cmath>

#include "apps/image_canopy.hpp"
#include "core/error.hpp"
#include "importers/images/image.hpp"

namespace waymark {
namespace {

constexpr double kCell = 0.6;  // metres: of the images that crowns were learnt from

/// Means of squares of `across` pixels, without those that are not known.
Grid<float> averaged(const Pixels& pixels, std::int64_t across, float full) {
  Grid<float> out(pixels.columns() / across, pixels.rows() / across);
  for (std::int64_t r = 0; r < out.rows(); ++r)
    for (std::int64_t c = 0; c < out.columns(); ++c) {
      float sum = 0;
      int count = 0;
      for (std::int64_t y = r * across; y < (r + 1) * across; ++y)
        for (std::int64_t x = c * across; x < (c + 1) * across; ++x)
          if (const float value = pixels(x, y); !std::isnan(value)) sum += value, ++count;
      out(c, r) = count > 0 ? sum / (static_cast<float>(count) * full) : std::nanf("");
    }
  return out;
}

}  // namespace

ColourImage::ColourImage(const ImageInfo& image, double metres, int most_bands)
    : across_(std::max<std::int64_t>(1, std::llround(kCell / metres))),
      columns_((image.columns + across_ - 1) / across_),
      rows_((image.rows + across_ - 1) / across_),
      cell_(metres * static_cast<double>(across_)),
      full_(image.saturated > 0 ? static_cast<float>(image.saturated) : 255.0F) {
  const int bands = std::min(most_bands, band_count(image.path));
  if (bands < 3)
    throw Error(ErrorCode::input, "not a colour image: it has fewer than three bands", image.path);
  for (int band = 1; band <= bands; ++band)
    bands_.push_back(import_image(image.path, {.georeference = false, .band = band}));
}

ColourImage::~ColourImage() = default;

ColourWindow ColourImage::read(const Window& cells) const {
  ColourWindow window{cells, cell_, {}};
  for (const auto& band : bands_)
    window.bands.push_back(averaged(band->read({cells.column * across_, cells.row * across_,
                                                cells.columns * across_, cells.rows * across_}),
                                    across_, full_));
  for (std::size_t i = 0; i < window.bands[0].cells().size(); ++i) {
    const bool unknown = std::ranges::any_of(
        window.bands, [&](const Grid<float>& band) { return std::isnan(band.cells()[i]); });
    if (!unknown) continue;
    for (Grid<float>& band : window.bands) band.cells()[i] = std::nanf("");
  }
  return window;
}

}  // namespace waymark
