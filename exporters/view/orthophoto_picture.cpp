// SPDX-License-Identifier: Apache-2.0
#include "exporters/view/orthophoto_picture.hpp"

#include <gdal_priv.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/error.hpp"
#include "exporters/gdal_messages.hpp"
#include "exporters/report/image_picture.hpp"

namespace waymark::exporters {
namespace {

/// Returns whether a photo's coordinates are those of the map: the same CRS, or none given.
bool has_crs_of_map(const OGRSpatialReference* found, const Crs& crs) {
  if (found == nullptr || crs.kind() == CrsKind::local) return true;
  char* wkt = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
  found->exportToWkt(&wkt, options);
  const std::string text = wkt == nullptr ? "" : wkt;
  CPLFree(wkt);
  return Crs::from_text(text).same_as(crs);
}

}  // namespace

OrthophotoPicture read_orthophoto(const std::string& path, const Crs& crs, double near_x,
                                  const Extent& within, std::int64_t longest) {
  const GdalMessages messages;
  const std::unique_ptr<GDALDataset> file(
      GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
  if (!file || file->GetRasterCount() == 0)
    throw Error(ErrorCode::input, "cannot read the orthophoto: " + messages.cause("it is no image"), path);
  double t[6];
  if (file->GetGeoTransform(t) != CE_None || t[2] != 0 || t[4] != 0 || !(t[1] > 0) || !(t[5] < 0))
    throw Error(ErrorCode::input, "the orthophoto has no position or is not north-up", path,
                "gdalwarp makes a north-up file");
  if (!has_crs_of_map(file->GetSpatialRef(), crs))
    throw Error(ErrorCode::input, "the orthophoto is not in the map's CRS, " + crs.id(), path,
                "convert it: gdalwarp -t_srs " + crs.id() + " IN OUT");
  const double columns = file->GetRasterXSize(), rows = file->GetRasterYSize();
  if (crs.kind() == CrsKind::geographic) t[0] += 360 * std::round((near_x - t[0] - columns * t[1] / 2) / 360);
  const auto clamped = [](double at, double max_value) {
    return static_cast<std::int64_t>(std::clamp(at, 0.0, max_value));
  };
  Window part;
  part.column = clamped(std::floor((within.west - t[0]) / t[1]), columns);
  part.row = clamped(std::floor((within.north - t[3]) / t[5]), rows);
  part.columns = clamped(std::ceil((within.east - t[0]) / t[1]), columns) - part.column;
  part.rows = clamped(std::ceil((within.south - t[3]) / t[5]), rows) - part.row;
  if (part.columns < 1 || part.rows < 1)
    throw Error(ErrorCode::input, "the orthophoto does not overlap the view", path,
                "is it of the same place and in the same CRS?");
  auto pixels = image_pixels(path, part, longest);
  if (!pixels)
    throw Error(ErrorCode::input, "cannot read the orthophoto: " + messages.cause("damaged"), path);
  const double west = t[0] + t[1] * double(part.column), north = t[3] + t[5] * double(part.row);
  return {{west, north + t[5] * double(part.rows), west + t[1] * double(part.columns), north},
          std::move(*pixels)};
}

}  // namespace waymark::exporters
