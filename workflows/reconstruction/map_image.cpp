// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/map_image.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "core/error.hpp"
#include "importers/images/image.hpp"
#include "pipeline/reconstruction/surface/image_levels.hpp"
#include "workflows/reconstruction/read_photos.hpp"

namespace waymark::workflows {
namespace {

constexpr double kMaxPixels = 36e6, kMaxStretch = 2e-3;

/// Pixels of the file and where they lie in its CRS.
struct Orthophoto {
  Pixels pixels = {};
  Georeference where = {};
  int factor = 1;  ///< by which the file was reduced
};

std::shared_ptr<const importers::ImportedImage> opened(const std::string& file, const std::string& crs) {
  std::shared_ptr<const importers::ImportedImage> image = importers::import_image(file);
  const bool without_crs = image->info().ortho && image->info().ortho->crs.kind() == CrsKind::local;
  if (without_crs && !crs.empty() && crs != "local") image = importers::import_image(file, {.crs = crs});
  if (!image->info().ortho)
    throw Error(ErrorCode::input, "the map image has no georeference", file,
                "give it a world file and a CRS: gdal_translate -a_srs CRS -a_ullr WEST NORTH EAST SOUTH");
  return image;
}

Orthophoto read_orthophoto(const std::string& file, const std::string& crs,
                           std::vector<std::string>& messages) {
  const auto image = opened(file, crs);
  const ImageInfo& info = image->info();
  Orthophoto out{.where = *info.ortho};
  out.factor = reduction_to(info.columns, info.rows, kMaxPixels);
  out.pixels = block_means([&](const Window& window) { return image->read(window); }, info.columns, info.rows,
                           out.factor);
  const double by = out.factor;
  out.where.x0 += out.where.dx * (by - 1) / 2, out.where.y0 += out.where.dy * (by - 1) / 2;
  out.where.dx *= by, out.where.dy *= by;
  if (out.factor > 1)
    messages.push_back(fmt::format("{} is used at a {} of its resolution; cut out the site for more", file,
                                   out.factor == 2 ? "half" : fmt::format("{}th", out.factor)));
  return out;
}

Crs given_crs(const std::string& crs) {
  Crs given = Crs::from_text(crs);
  if (given.kind() == CrsKind::geographic)
    throw Error(ErrorCode::usage, fmt::format("{} is in degrees; heights need metres", given.id()), "--crs",
                "pass a projected CRS, or leave it out");
  return given;
}

// Whether lengths in the CRS are those on the ground, up to 0.2 %, at a position.
bool is_true_to_scale(const Crs& crs, const Crs& ground, double x, double y) {
  const CrsTransform to_ground(crs, ground);
  const double step = 1000 / crs.metres_per_unit();
  const auto at = to_ground(x, y), east = to_ground(x + step, y), north = to_ground(x, y + step);
  Eigen::Matrix2d by_metre;
  by_metre << east.x - at.x, north.x - at.x, east.y - at.y, north.y - at.y;
  const Eigen::Vector2d stretch = by_metre.jacobiSvd().singularValues() / 1000;
  return (stretch.array() - 1).abs().maxCoeff() < kMaxStretch;
}

Crs map_crs_of(const Orthophoto& photo, const std::string& file, const std::string& crs,
               std::vector<std::string>& messages) {
  const Crs& own = photo.where.crs;
  if (own.kind() == CrsKind::local) return own;
  const Crs wanted = crs.empty() ? own : given_crs(crs);
  const Crs degrees = geographic_crs(own);
  const auto middle = CrsTransform(own, degrees)(photo.where.x(double(photo.pixels.columns()) / 2),
                                                 photo.where.y(double(photo.pixels.rows()) / 2));
  const std::string projection = importers::local_projection(degrees, middle.x, middle.y);
  Crs ground = Crs::from_text(projection);
  const auto there = CrsTransform(degrees, wanted)(middle.x, middle.y);
  if (is_true_to_scale(wanted, ground, there.x, there.y)) return wanted;
  messages.push_back(fmt::format(
      "metres of {} are not those on the ground at {}{}", wanted.id(), file,
      crs.empty() ? fmt::format("; the CRS is {} instead (--crs chooses another)", projection)
                  : fmt::format(": lengths are wrong by more than 0.2 %; pass --crs \"{}\"", projection)));
  return crs.empty() ? ground : wanted;
}

// Grid of square cells in the map's frame, which covers the orthophoto.
pipeline::SurfaceGrid grid_of(const Orthophoto& photo, const std::optional<CrsTransform>& to_map, double unit,
                              const std::string& file) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  constexpr int kSteps = 16;  // along each side
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j) {
      const double x = photo.where.x(double(photo.pixels.columns()) * i / kSteps - 0.5),
                   y = photo.where.y(double(photo.pixels.rows()) * j / kSteps - 0.5);
      const auto at = to_map ? (*to_map)(x, y) : CrsTransform::XY{x, y};
      if (!std::isfinite(at.x) || !std::isfinite(at.y)) continue;
      low = low.cwiseMin(Eigen::Vector2d(at.x, at.y) * unit);
      high = high.cwiseMax(Eigen::Vector2d(at.x, at.y) * unit);
    }
  const Eigen::Vector2d size = high - low;
  if (!(size.minCoeff() > 0) || !(size.maxCoeff() < 1e8))
    throw Error(ErrorCode::usage, "the map image is not within reach of the CRS of the map", file,
                "pass a --crs for its site, or leave it out");
  const double cell =
      std::sqrt(size.x() * size.y() / (double(photo.pixels.columns()) * double(photo.pixels.rows())));
  return {.west = low.x(),
          .north = high.y(),
          .cell = cell,
          .columns = std::max<std::int64_t>(1, std::llround(size.x() / cell)),
          .rows = std::max<std::int64_t>(1, std::llround(size.y() / cell))};
}

}  // namespace

void check_map_image(const std::string& file, const std::string& crs) {
  const auto image = opened(file, crs);
  const Crs& own = image->info().ortho->crs;
  if (own.kind() == CrsKind::local || crs.empty()) return;
  if (crs == "local")
    throw Error(ErrorCode::usage, fmt::format("the map image is in {}, but --crs is local", own.id()), file,
                "leave out --crs");
  CrsTransform(given_crs(crs), own);
}

MapImage read_map_image(const std::string& file, const std::string& crs) {
  MapImage out;
  const Orthophoto photo = read_orthophoto(file, crs, out.messages);
  out.crs = map_crs_of(photo, file, crs, out.messages);
  std::optional<CrsTransform> to_map, from_map;
  if (!out.crs.same_as(photo.where.crs)) {
    to_map.emplace(photo.where.crs, out.crs);
    from_map.emplace(out.crs, photo.where.crs);
  }
  const double unit = out.crs.kind() == CrsKind::local ? 1 : out.crs.metres_per_unit();
  out.image.grid = grid_of(photo, to_map, unit, file);
  out.image.brightness = Grid<float>(out.image.grid.columns, out.image.grid.rows);
  for (std::int64_t r = 0; r < out.image.grid.rows; ++r)
    for (std::int64_t c = 0; c < out.image.grid.columns; ++c) {
      const double x = out.image.grid.x(double(c)) / unit, y = out.image.grid.y(double(r)) / unit;
      const auto at = from_map ? (*from_map)(x, y) : CrsTransform::XY{x, y};
      out.image.brightness(c, r) =
          pipeline::bilinear(photo.pixels, static_cast<float>(photo.where.column(at.x)),
                             static_cast<float>(photo.where.row(at.y)));
    }
  return out;
}

}  // namespace waymark::workflows
