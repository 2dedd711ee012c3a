// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include "geo/image_source.hpp"
#include "pipeline/forest/crown_evidence.hpp"
namespace waymark::workflows {

/// Colour image (red, green, blue, near infrared from a fourth band) in cells of about 0.6 m. Finer pixels
/// are averaged in squares. Safe to read from many threads.
class ColourImage {
 public:
  /// `metres`: size of a pixel. Throws Error{input} for unreadable bands or fewer than three.
  ColourImage(const ImageInfo& image, double metres, int max_bands = 4);
  ~ColourImage();

  bool infrared() const { return bands_.size() > 3; }
  std::int64_t pixels_per_cell() const { return across_; }
  double cell() const { return cell_; }  ///< metres
  std::int64_t columns() const { return columns_; }
  std::int64_t rows() const { return rows_; }
  /// Returns the centre of a cell in pixels.
  double pixel(std::int64_t cell) const {
    return (static_cast<double>(cell) + 0.5) * static_cast<double>(across_) - 0.5;
  }
  /// Reads cells; NaN outside the image and where it has no data.
  pipeline::ColourWindow read(const Window& cells) const;

 private:
  std::vector<std::shared_ptr<const ImageSource>> bands_;
  std::int64_t across_ = 1, columns_ = 0, rows_ = 0;
  double cell_ = 0.6;
  float white_ = 255;
};

}  // namespace waymark::workflows
