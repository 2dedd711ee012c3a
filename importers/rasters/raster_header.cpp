// SPDX-License-Identifier: Apache-2.0
#include "importers/rasters/raster_header.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string_view>

#include "core/error.hpp"
#include "core/lower_case.hpp"
#include "importers/rasters/reference_radius.hpp"

namespace waymark::importers {
namespace {

constexpr double kFoot = 0.3048;               // international, exact
constexpr double kSurveyFoot = 1200.0 / 3937;  // US, exact

struct NamedUnit {
  double metres;
  std::initializer_list<std::string_view> names;
};

using GeoTransform = std::array<double, 6>;

[[noreturn]] void refuse_raster(const std::string& problem, const std::string& path,
                                const std::string& hint) {
  throw Error(ErrorCode::input, problem, path, hint);
}

int band_of_heights(GDALDataset& dataset, const std::string& path, int wanted) {
  const int bands = dataset.GetRasterCount();
  if (bands == 0) {
    const char* first = CSLFetchNameValue(dataset.GetMetadata("SUBDATASETS"), "SUBDATASET_1_NAME");
    refuse_raster(
        "the file itself contains no raster", path,
        first ? fmt::format("name one of its data sets, e.g. {}", first) : "`gdalinfo` shows its content");
  }
  if (wanted > bands)
    refuse_raster(fmt::format("there is no band {}: this file has {}", wanted, bands), path,
                  "`gdalinfo` lists the bands; pass --band with one of them");
  const bool height_and_alpha =
      bands == 2 && dataset.GetRasterBand(2)->GetColorInterpretation() == GCI_AlphaBand;
  if (wanted == 0)  // as in elevation models of `waymark reconstruct`
    for (int b = 1; b <= bands; ++b)
      if (std::string_view(dataset.GetRasterBand(b)->GetDescription()) == "height") return b;
  if (wanted == 0 && bands > 1 && !height_and_alpha)
    refuse_raster(
        fmt::format("a DEM has one band of heights, this file has {}", bands), path,
        fmt::format("name the right one: `waymark peaks --band 1`, load_dem.band in a job; or extract it: "
                    "gdal_translate -b 1 '{}' dem.tif",
                    path));
  const int number = std::max(1, wanted);
  GDALRasterBand& band = *dataset.GetRasterBand(number);
  if (GDALDataTypeIsComplex(band.GetRasterDataType()))
    refuse_raster(fmt::format("heights are real numbers, this file holds complex ones ({})",
                              GDALGetDataTypeName(band.GetRasterDataType())),
                  path, "use the DEM derived from the interferogram");
  return number;
}

std::optional<GeoTransform> transform_of(GDALDataset& dataset, const std::string& path) {
  GeoTransform t{};
  if (dataset.GetGeoTransform(t.data()) != CE_None) {
    if (dataset.GetGCPCount() > 0)
      refuse_raster("the file is georeferenced by ground control points, not by a grid", path,
                    fmt::format("resample it first: gdalwarp '{}' dem.tif", path));
    return std::nullopt;
  }
  const double tiny = 1e-6 * std::abs(t[1]);
  if (std::abs(t[2]) > tiny || std::abs(t[4]) > tiny)
    refuse_raster("the grid is rotated against the axes of its CRS", path,
                  fmt::format("turn it north up: gdalwarp '{}' dem.tif", path));
  if (!(t[1] > 0) || t[5] == 0)
    refuse_raster(fmt::format("the cells measure {} x {}: columns must run from west to east", t[1], t[5]),
                  path, fmt::format("resample it first: gdalwarp '{}' dem.tif", path));
  return t;
}

Crs crs_of(const GDALDataset& dataset, const std::string& path, const std::string& replacement,
           const std::optional<GeoTransform>& t) {
  if (!replacement.empty()) return Crs::from_text(replacement);
  char* wkt = nullptr;
  const OGRSpatialReference* reference = dataset.GetSpatialRef();
  const char* const wkt2[] = {"FORMAT=WKT2_2019", nullptr};
  if (reference) reference->exportToWkt(&wkt, wkt2);
  const std::string definition = wkt ? wkt : "";
  CPLFree(wkt);
  if (!definition.empty()) return Crs::from_text(definition);
  const bool like_degrees = t && std::abs((*t)[0]) <= 360 && std::abs((*t)[3]) <= 90 && (*t)[1] < 0.1;
  refuse_raster("the file has no coordinate reference system", path,
                like_degrees ? "its numbers look like degrees: pass --crs EPSG:4326 if this is Earth, --crs "
                               "IAU_2015:49900 if Mars, --crs IAU_2015:30100 if the Moon"
                             : "pass --crs, e.g. --crs EPSG:32611, or --crs local for metres on no body");
}

// Converts the corner-based transform of GDAL to centres, here and nowhere else; flips a south-up file.
Georeference place(const Crs& crs, const std::optional<GeoTransform>& transform, std::int64_t rows,
                   const std::string& path) {
  if (!transform && crs.kind() != CrsKind::local)
    refuse_raster("the file has no geotransform", path,
                  "add one: gdal_edit.py -a_ullr WEST NORTH EAST SOUTH FILE");
  const GeoTransform t = transform.value_or(GeoTransform{0, 1, 0, static_cast<double>(rows), 0, -1});
  const double top = t[5] < 0 ? t[3] : t[3] + t[5] * static_cast<double>(rows);
  const double dy = -std::abs(t[5]);
  return {crs, t[0] + t[1] / 2, top + dy / 2, t[1], dy};
}

void check_coordinates(const RasterHeader& header) {
  const Georeference& where = header.where;
  const double east = where.x(static_cast<double>(header.columns)), north = where.y(-1);
  const double south = where.y(static_cast<double>(header.rows)), west = where.x(-1);
  const double furthest_x = std::max(std::abs(west), std::abs(east));
  const double furthest_y = std::max(std::abs(north), std::abs(south));
  const std::string extent = fmt::format("x {:.6g} to {:.6g}, y {:.6g} to {:.6g}", west, east, south, north);
  if (where.crs.kind() == CrsKind::geographic && (furthest_y > 90 - 2 * where.dy || furthest_x > 720))
    refuse_raster(fmt::format("{} is in degrees, but these are none: {}", where.crs.id(), extent),
                  header.path, "pass --crs with the projection these coordinates are in");
  if (where.crs.kind() == CrsKind::projected && furthest_x <= 360 && furthest_y <= 91 && where.dx < 0.1)
    refuse_raster(
        fmt::format("{} is in metres, but these look like degrees: {}", where.crs.id(), extent), header.path,
        "pass --crs with the geographic CRS, e.g. --crs EPSG:4326, or --crs local if they are metres");
}

double nodata_of(GDALRasterBand& band) {
  int known = 0;
  double value = 0;
  switch (band.GetRasterDataType()) {
    case GDT_Int64:
      value = static_cast<double>(band.GetNoDataValueAsInt64(&known));
      break;
    case GDT_UInt64:
      value = static_cast<double>(band.GetNoDataValueAsUInt64(&known));
      break;
    default:
      value = band.GetNoDataValue(&known);
  }
  return known ? value : std::numeric_limits<double>::quiet_NaN();
}

HeightScale height_scale(GDALRasterBand& band, const RasterReading& reading, RasterHeader& header) {
  HeightScale heights;
  const GDALDataType type = band.GetRasterDataType();
  heights.min_void = heights.max_void = nodata_of(band);
  if (type == GDT_Float32) heights.min_void = heights.max_void = static_cast<float>(heights.min_void);
  if (const double huge = std::abs(heights.min_void); huge > 1e30) {  // often written with a few digits only
    heights.min_void -= 1e-5 * huge;
    heights.max_void += 1e-5 * huge;
  }
  const HeightUnit unit =
      reading.height_unit.empty() ? height_unit(band.GetUnitType()) : stated_height_unit(reading.height_unit);
  if (!unit.known)
    header.warnings.push_back(
        fmt::format("{}: heights are in '{}', an unknown unit; metres are assumed: pass --height-unit",
                    header.path, band.GetUnitType()));
  const bool nothing_stated = reading.height_unit.empty() && reading.height_scale == 1 &&
                              std::string_view(band.GetUnitType()).empty();
  const Crs& crs = header.where.crs;
  if (nothing_stated && crs.kind() == CrsKind::projected && std::abs(crs.metres_per_unit() - 1) > 1e-9)
    header.warnings.push_back(
        fmt::format("{}: the CRS counts in units of {:.6g} m and the band names no unit: heights are taken "
                    "to be in metres; "
                    "if they are in feet, name them with gdal_edit.py -units ft",
                    header.path, crs.metres_per_unit()));
  const double metres = unit.metres * reading.height_scale;
  heights.scale = band.GetScale() * metres;
  heights.offset = band.GetOffset() * metres;
  if (!(std::abs(heights.scale) > 0) || !std::isfinite(heights.scale) || !std::isfinite(heights.offset))
    refuse_raster(fmt::format("heights would be {} times the cell plus {}", heights.scale, heights.offset),
                  header.path, "correct the band: gdal_edit.py -scale 1 -offset 0 FILE");
  heights.whole_metres =
      GDALDataTypeIsInteger(type) && heights.scale == 1 && heights.offset == std::floor(heights.offset);
  return heights;
}

CellType cell_type(GDALDataType type, bool masked) {  // a masked cell becomes NaN, which an integer cannot be
  switch (type) {
    case GDT_Byte:
    case GDT_Int16:
      return masked ? CellType::float32 : CellType::int16;
    case GDT_UInt16:
    case GDT_Float32:
      return CellType::float32;
    default:
      return CellType::float64;
  }
}

void subtract_reference_radius(GDALDataset& dataset, RasterHeader& header) {
  const auto [metres, reason] = detect_reference_radius(dataset, header);
  if (metres == 0) return;
  const Body& body = header.where.crs.body();
  header.heights.offset -= metres;
  header.heights.whole_metres = header.heights.whole_metres && metres == std::floor(metres);
  header.warnings.push_back(
      fmt::format("{}: heights are distances from the body's centre: {}, the radius of {} is {:.10g} m; "
                  "{:.10g} m are subtracted",
                  header.path, reason, body.name, body.equatorial_radius, metres));
}

}  // namespace

HeightUnit height_unit(std::string_view name) {
  static const NamedUnit units[] = {
      {1, {"", "m", "metre", "metres", "meter", "meters"}},
      {kFoot, {"ft", "foot", "feet", "international foot", "foot (international)"}},
      {kSurveyFoot,
       {"us survey foot", "us survey feet", "us-ft", "ft-us", "ftus", "foot_us", "us_survey_foot"}},
      {1000, {"km", "kilometre", "kilometer", "kilometres", "kilometers"}},
      {0.1, {"dm", "decimetre", "decimeter"}},
      {0.01, {"cm", "centimetre", "centimeter", "centimetres", "centimeters"}},
      {0.001, {"mm", "millimetre", "millimeter"}},
  };
  const std::string lower = lower_case(name);
  for (const NamedUnit& unit : units)
    if (std::ranges::find(unit.names, lower) != unit.names.end()) return {unit.metres, true};
  return {1, false};
}

HeightUnit stated_height_unit(std::string_view name) {
  const HeightUnit unit = height_unit(name);
  if (!unit.known)
    throw Error(ErrorCode::usage, "there is no unit of height '" + std::string(name) + "'", "height_unit",
                "name one of m, km, dm, cm, mm, ft, us-ft, or pass --height-scale");
  return unit;
}

RasterHeader read_header(GDALDataset& dataset, const std::string& path, const RasterReading& reading) {
  const GdalListener quiet;
  const int number = band_of_heights(dataset, path, reading.band);
  GDALRasterBand& band = *dataset.GetRasterBand(number);
  const auto transform = transform_of(dataset, path);
  RasterHeader header;
  header.path = path;
  header.band = number;
  header.columns = dataset.GetRasterXSize();
  header.rows = dataset.GetRasterYSize();
  header.where = place(crs_of(dataset, path, reading.crs, transform), transform, header.rows, path);
  header.south_up = transform && (*transform)[5] > 0;
  check_coordinates(header);
  band.GetBlockSize(&header.block_columns, &header.block_rows);
  header.square_blocks =
      header.block_columns <= 1024 && std::string_view(dataset.GetDriver()->GetDescription()) != "VRT";
  header.masked = (band.GetMaskFlags() & (GMF_ALL_VALID | GMF_NODATA)) == 0;
  header.cells = cell_type(band.GetRasterDataType(), header.masked);
  header.heights = height_scale(band, reading, header);
  subtract_reference_radius(dataset, header);
  return header;
}

}  // namespace waymark::importers
