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
namespace waymark::inline geo {

/// Brightness, linear in the values of the file; NaN for pixels without data.
using Pixels = Grid<float>;

/// Metadata of an image.
struct ImageInfo {
  std::string name;  ///< unique in its set: file name without folders
  std::string path;  ///< anything GDAL opens
  std::int64_t columns = 0, rows = 0;
  Crs crs = Crs::local();             ///< of `view` and `ortho`: projected or local
  std::optional<PosedCamera> view;    ///< a frame camera with its pose
  std::optional<Georeference> ortho;  ///< an orthophoto: pixel -> map
  std::optional<Sun> sun;
  /// Direction to the sun in the image, from x (right) to y (down); for images without a pose.
  std::optional<Degrees> image_sun_angle;
  std::optional<Meters> gsd;  ///< of an image without pose and georeference
  double saturated = 0;       ///< pixels at or above this value are saturated; 0: unknown
  std::string taken_utc;      ///< ISO 8601; empty: unknown
};

/// Image read by windows. Thread-safe.
class ImageSource {
 public:
  virtual ~ImageSource() = default;
  virtual const ImageInfo& info() const = 0;
  /// Returns the pixels of a window; NaN outside the image. Colour images give luminance (Rec. 709). Throws
  /// Error if the file is damaged.
  virtual Pixels read(const Window& window) const = 0;
};

/// Image as passed between stages.
using ImageHandle = std::shared_ptr<const ImageSource>;
/// Images of a job, in the order of their list.
using ImageSet = std::vector<ImageHandle>;

}  // namespace waymark::inline geo
