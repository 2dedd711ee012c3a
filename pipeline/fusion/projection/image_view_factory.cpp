// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/image_view_factory.hpp"

#include <fmt/format.h>

#include "core/error.hpp"
#include "geo/terrain.hpp"
#include "pipeline/fusion/projection/footprint.hpp"

namespace waymark::pipeline {

ImageView make_image_view(const ImageInfo& info) {
  ImageView image;
  image.name = info.name;
  image.columns = info.columns, image.rows = info.rows;
  image.view = info.view;
  image.sun = info.sun;
  image.taken_utc = info.taken_utc;
  if (info.view) {
    const Camera& camera = info.view->camera;
    if (camera.columns != info.columns || camera.rows != info.rows)
      throw Error(ErrorCode::input,
                  fmt::format("the camera of image '{}' has {} x {} pixels, the image {} x {}", info.name,
                              camera.columns, camera.rows, info.columns, info.rows),
                  info.path, "use the image the camera was calibrated for, or scale the camera parameters");
    return image;
  }
  if (!info.ortho)
    throw Error(ErrorCode::input, fmt::format("image '{}' has neither a pose nor a georeference", info.name),
                info.path, "add it to the camera file, or run `waymark detect` for results in pixels");
  if (info.ortho->crs.kind() == CrsKind::geographic)
    throw Error(ErrorCode::input, fmt::format("image '{}' has a CRS in degrees, not metres", info.name),
                info.path, "warp it to the CRS of the DEM: gdalwarp -t_srs");
  const Georeference& where = *info.ortho;
  const double unit = where.crs.metres_per_unit();
  image.ortho = OrthoGrid{where.x0 * unit, where.y0 * unit, where.dx * unit, where.dy * unit};
  return image;
}

void compute_footprint(ImageView& image, const Terrain& terrain, double metres_per_unit) {
  const Footprint ground = footprint(image, terrain);
  image.footprint = ground.rings;
  for (auto& ring : image.footprint)
    for (auto& corner : ring) corner /= metres_per_unit;
  image.area = ground.area;
  if (ground.gsd > 0) image.gsd = ground.gsd;
}

}  // namespace waymark::pipeline
