// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "core/grid.hpp"
#include "core/units.hpp"
#include "geo/camera.hpp"
#include "geo/georeference.hpp"
#include "geo/sun.hpp"
namespace waymark {

/// Brightness, linear in the file's numbers; NaN where there is no data.
using Pixels = Grid<float>;

/// All that is known about an image but its pixels.
struct ImageInfo {
  std::string name;  ///< unique in its set: file name without folders
  std::string path;  ///< anything GDAL opens
  std::int64_t columns = 0, rows = 0;
  Crs crs = Crs::local();             ///< of `view` and `ortho`: projected or local
  std::optional<PosedCamera> view;    ///< a frame camera with its pose
  std::optional<Georeference> ortho;  ///< an orthophoto: pixel -> map
  std::optional<Sun> sun;
  /// Towards the sun in the image, from x (right) towards y (down); for images without a pose.
  std::optional<Degrees> image_sun_angle;
  std::optional<Meters> gsd;  ///< of an image without pose and georeference
  double saturated = 0;       ///< pixels at or above are blown out; 0: unknown
  std::string taken_utc;      ///< ISO 8601; empty: unknown
};

/// An image that is read window by window. Safe to read from many threads.
class ImageSource {
 public:
  virtual ~ImageSource() = default;
  virtual const ImageInfo& info() const = 0;
  /// Pixels outside the image are NaN. Colour images give luminance (Rec. 709). Throws Error where the file
  /// is damaged.
  virtual Pixels read(const Window& window) const = 0;
};

/// An image as it is passed between stages.
using ImageHandle = std::shared_ptr<const ImageSource>;
using ImageSet = std::vector<ImageHandle>;

}  // namespace waymark
