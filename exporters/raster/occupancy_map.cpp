// SPDX-License-Identifier: Apache-2.0
#include "exporters/raster/occupancy_map.hpp"

#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/atomic_file.hpp"
#include "core/error.hpp"
#include "core/output_error.hpp"
#include "exporters/gdal_messages.hpp"
#include "geodb/write_map.hpp"

namespace waymark::exporters {
namespace {

namespace fs = std::filesystem;

GDALDatasetUniquePtr open_band(const fs::path& raster, int band, const fs::path& output,
                               const GdalMessages& messages) {
  GDALDatasetUniquePtr set(
      GDALDataset::Open(raster.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
  if (!set || set->GetRasterCount() < band)
    fail_output(output, messages.cause("the raster that it is made from cannot be read"));
  return set;
}

std::vector<Eigen::Vector2d> corners_of(const OGRLinearRing& ring) {
  std::vector<Eigen::Vector2d> corners;
  for (const OGRPoint& corner : ring) corners.emplace_back(corner.getX(), corner.getY());
  return corners;
}

geodb::Shape shape_of(const OGRFeature& feature, std::span<const char* const> names) {
  const OGRPolygon& polygon = *feature.GetGeometryRef()->toPolygon();
  geodb::ShapePart part{.outer = corners_of(*polygon.getExteriorRing())};
  for (int i = 0; i < polygon.getNumInteriorRings(); ++i)
    part.holes.push_back(corners_of(*polygon.getInteriorRing(i)));
  const auto code = static_cast<std::size_t>(feature.GetFieldAsInteger(0));
  return {.parts = {std::move(part)},
          .values = {static_cast<std::int64_t>(code),
                     code < names.size() ? AttributeValue(std::string(names[code])) : AttributeValue(),
                     polygon.get_Area()}};
}

}  // namespace

void write_occupancy_map(const fs::path& yaml, const fs::path& raster, const OccupancyBands& bands,
                         const Crs& crs) {
  constexpr long kUnknown = 255, kLethal = 100;  // as Nav2's costmaps read mode `raw`
  const GdalMessages messages;
  const GDALDatasetUniquePtr set =
      open_band(raster, std::max(bands.probability, bands.classes), yaml, messages);
  std::array<double, 6> t{};
  set->GetGeoTransform(t.data());
  if (!(std::abs(t[1] + t[5]) < 1e-6 * t[1]))
    throw Error(ErrorCode::input,
                fmt::format("cells of {:g} x {:g} are not square, as those of Nav2 are", t[1], -t[5]),
                raster.string(), "resample the DEM: gdalwarp -tr");
  const int columns = set->GetRasterXSize(), rows = set->GetRasterYSize();
  const fs::path image = fs::path(yaml).replace_extension(".pgm");
  std::string pgm = fmt::format("P5\n{} {}\n255\n", columns, rows);
  pgm.reserve(pgm.size() + static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  std::vector<float> probability(static_cast<std::size_t>(columns)), code(probability.size());
  const auto read = [&](int band, int r, std::vector<float>& row) {
    if (set->GetRasterBand(band)->RasterIO(GF_Read, 0, r, columns, 1, row.data(), columns, 1, GDT_Float32, 0,
                                           0, nullptr) != CE_None)
      fail_output(yaml, messages.cause("the raster that it is made from cannot be read"));
  };
  for (int r = 0; r < rows; ++r) {
    read(bands.probability, r, probability);
    read(bands.classes, r, code);
    for (std::size_t i = 0; i < code.size(); ++i) {
      const float p = probability[i];
      const auto is = [&](int one) { return code[i] == static_cast<float>(one); };
      const long cell = is(bands.lethal_class) ? kLethal
                        : is(bands.unknown_class) || std::isnan(p)
                            ? kUnknown
                            : std::min(std::lround(100 * p), kLethal - 1);
      pgm.push_back(static_cast<char>(cell));
    }
  }
  write_file(image, pgm);
  const double metres = crs.kind() == CrsKind::projected ? crs.metres_per_unit() : 1;
  const std::string unit =
      metres == 1 ? "Metres of " : fmt::format("Metres, {:.12g} times x and y of ", metres);
  write_file(yaml, fmt::format(
                       "# {}{}. 100: hazard, 0 to 99: probability of one in per cent, 255: unknown.\n"
                       "image: {}\nmode: raw\nresolution: {:.12g}\norigin: [{:.12g}, {:.12g}, 0]\nnegate: 0\n"
                       "occupied_thresh: 0.65\nfree_thresh: 0.196\n",
                       unit, crs.id(), image.filename().string(), metres * t[1], metres * t[0],
                       metres * (t[3] + rows * t[5])));
}

void write_class_polygons(const fs::path& map, const std::string& layer_name, const fs::path& raster,
                          int band, std::span<const char* const> names, const Crs& crs) {
  const GdalMessages messages;
  const GDALDatasetUniquePtr set = open_band(raster, band, map, messages);
  // GDAL makes all polygons at once: they go to a scratch file, from which they are read one by one.
  const AtomicFile scratch(map);
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
  const std::unique_ptr<GDALDataset> file(
      driver->Create(scratch.path().c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  if (!file) fail_output(map, messages.cause("GDAL has no GeoPackage driver"));
  const char* no_index[] = {"SPATIAL_INDEX=NO", nullptr};
  OGRLayer* polygons = file->CreateLayer("polygons", nullptr, wkbPolygon,
                                         const_cast<char**>(static_cast<const char**>(no_index)));
  OGRFieldDefn code("code", OFTInteger);
  if (!polygons || polygons->CreateField(&code) != OGRERR_NONE) fail_output(map, messages.cause("no layer"));
  GDALRasterBand* cells = set->GetRasterBand(band);
  file->StartTransaction();
  // The band is its own mask: class 0 makes no polygons.
  if (GDALPolygonize(cells, cells, OGRLayer::ToHandle(polygons), 0, nullptr, nullptr, nullptr) != CE_None ||
      file->CommitTransaction() != OGRERR_NONE || !messages.failures().empty())
    fail_output(map, messages.cause("not all of it was written"));

  using Kind = AttributeSpec::Kind;
  geodb::MapContents contents;
  contents.crs = crs;
  contents.layers.push_back({.name = layer_name,
                             .summary = "Areas of the classes of " + raster.filename().string(),
                             .columns = {{"code", "", Kind::integer, "Number of the class"},
                                         {"class", "", Kind::text, "Class"},
                                         {"area", "", Kind::real, "In the square of the unit of the CRS"}},
                             .style = {.colour = "#c62828", .fill = "#c62828"},
                             .generator = [&](const std::function<void(const geodb::Shape&)>& take) {
                               for (const auto& feature : *polygons) take(shape_of(*feature, names));
                             }});
  geodb::write_map(map, contents);
}

}  // namespace waymark::exporters
