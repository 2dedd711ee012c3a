// SPDX-License-Identifier: Apache-2.0
#include "exporters/vector/vector_format.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <sstream>
#include <string_view>

#include "core/error.hpp"
#include "core/lower_case.hpp"
#include "exporters/gdal_messages.hpp"

namespace waymark::exporters {
namespace {

// Formats defined in WGS 84. GDAL has no flag for it.
constexpr std::array kOnlyWgs84 = {"KML", "LIBKML", "GPX", "GeoRSS", "GPSBabel", "GeoJSONSeq"};  // RFC 8142
constexpr std::array kOneLayer = {"DXF", "DGN"};  // GDAL reports that they hold several
constexpr std::array kSilent = {"KML", "GML",    "MapInfo File", "ODS",    "XLSX",
                                "DXF", "GeoRSS", "GPX",          "OGR_GMT"};  // on writes that fail
constexpr std::size_t kDbfName = 10;                                          // dBASE III field names
constexpr std::int64_t kSheetRows = 1'048'576;  // of Excel and LibreOffice, the first with the names

bool has(GDALDriver& driver, const char* key) {
  return driver.GetMetadataItem(key) != nullptr;
}

std::vector<GDALDriver*> writers() {
  std::vector<GDALDriver*> found;
  GDALDriverManager& manager = *GetGDALDriverManager();
  for (int i = 0; i < manager.GetDriverCount(); ++i) {
    GDALDriver& driver = *manager.GetDriver(i);
    if (has(driver, GDAL_DCAP_VECTOR) && has(driver, GDAL_DCAP_CREATE) && has(driver, GDAL_DCAP_CREATE_LAYER))
      found.push_back(&driver);
  }
  // An extension that several drivers claim belongs to the one for vectors only: .xml is GML,
  // not PDS4.
  std::stable_partition(found.begin(), found.end(), [](GDALDriver* d) { return !has(*d, GDAL_DCAP_RASTER); });
  // LIBKML's time grows with the square of the placemarks (GDAL 3.6: 70 s for 2000): .kml goes to the plain
  // KML driver.
  std::stable_partition(found.begin(), found.end(),
                        [](GDALDriver* d) { return !EQUAL(d->GetDescription(), "LIBKML"); });
  return found;
}

std::vector<std::string> extensions(GDALDriver& driver) {
  const char* listed = driver.GetMetadataItem(GDAL_DMD_EXTENSIONS);
  std::istringstream words(listed != nullptr ? listed : "");
  std::vector<std::string> all;
  for (std::string word; words >> word;) all.push_back("." + word);
  return all;
}

GDALDriver& driver_called(const std::string& name, const std::vector<GDALDriver*>& all) {
  std::vector<std::string> lower_names;
  for (GDALDriver* driver : all) {
    if (lower_case(driver->GetDescription()) == lower_case(name)) return *driver;
    lower_names.push_back(lower_case(driver->GetDescription()));
  }
  const std::string nearest = nearest_name(lower_case(name), lower_names);
  const auto match = std::find(lower_names.begin(), lower_names.end(), nearest);
  const std::string hint =
      match == lower_names.end()
          ? "`ogrinfo --formats` lists them: those with w and 'vector'"
          : fmt::format("did you mean {}?",
                        all[static_cast<std::size_t>(match - lower_names.begin())]->GetDescription());
  throw Error(ErrorCode::usage, fmt::format("this GDAL has no vector format '{}' to write", name),
              "-of " + name, hint);
}

GDALDriver& driver_for(const std::string& out, const std::vector<GDALDriver*>& all) {
  const std::string file = lower_case(out.substr(out.find_last_of('/') + 1));
  std::vector<std::string> known;
  for (GDALDriver* driver : all) {
    for (const std::string& extension : extensions(*driver)) {
      if (file.size() > extension.size() && file.ends_with(extension)) return *driver;
      known.push_back(extension);
    }
    const char* prefix = driver->GetMetadataItem(GDAL_DMD_CONNECTION_PREFIX);
    if (prefix != nullptr && out.starts_with(prefix)) return *driver;
  }
  const auto dot = file.find_last_of('.');
  const std::string given = dot == std::string::npos || dot == 0 ? "" : file.substr(dot);
  const std::string nearest = given.empty() ? "" : nearest_name(given, known);
  throw Error(ErrorCode::usage,
              given.empty()
                  ? fmt::format("cannot recognise the format of {}: its name has no extension", file)
                  : fmt::format("no vector format has the extension {}", given),
              out,
              (nearest.empty() ? "" : fmt::format("did you mean {}? ", nearest)) +
                  "name the format with -of, e.g. -of GeoJSON");
}

/// Returns the projection with a false easting and northing of 0.
Crs without_false_origin(const Crs& crs) {
  if (crs.kind() != CrsKind::projected) return crs;
  OGRSpatialReference srs;
  srs.importFromWkt(crs.wkt2().c_str());
  const auto is_zero = [&](const char* name) { return std::abs(srs.GetProjParm(name, 0)) < 1e-9; };
  if (is_zero(SRS_PP_FALSE_EASTING) && is_zero(SRS_PP_FALSE_NORTHING)) return crs;
  srs.SetProjParm(SRS_PP_FALSE_EASTING, 0);
  srs.SetProjParm(SRS_PP_FALSE_NORTHING, 0);
  srs.SetProjCS((crs.name() + " without false origin").c_str());
  if (OGR_SRSNode* root = srs.GetRoot(); root->FindChild("AUTHORITY") >= 0)
    root->DestroyChild(root->FindChild("AUTHORITY"));
  const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
  char* text = nullptr;
  srs.exportToWkt(&text, options);
  const std::string wkt = text;
  CPLFree(text);
  return Crs::from_text(wkt);
}

std::string cut(const std::string& name, std::size_t longest) {
  if (name.size() <= longest) return name;
  const std::size_t ending = name.find_last_of('_');
  const bool keep = ending != std::string::npos && name.size() - ending <= 4;
  return keep ? name.substr(0, longest - (name.size() - ending)) + name.substr(ending)
              : name.substr(0, longest);
}

}  // namespace

VectorFormat vector_format(const std::string& out, const std::string& driver_name) {
  const GdalMessages quiet;
  const auto all = writers();
  GDALDriver& driver = driver_name.empty() ? driver_for(out, all) : driver_called(driver_name, all);
  VectorFormat format{.driver = driver.GetDescription()};
  const auto is_in = [&](const auto& names) {
    return std::find(names.begin(), names.end(), format.driver) != names.end();
  };
  format.is_file = !has(driver, GDAL_DMD_CONNECTION_PREFIX) || has(driver, GDAL_DMD_EXTENSIONS);
  format.one_layer = !has(driver, GDAL_DCAP_MULTIPLE_VECTOR_LAYERS) || is_in(kOneLayer);
  format.can_be_read = has(driver, GDAL_DCAP_OPEN) && format.driver != "MVT";  // a tree of tiles
  format.is_table = has(driver, GDAL_DCAP_NONSPATIAL) || format.driver == "CSV";
  format.only_wgs84 = is_in(kOnlyWgs84);
  format.reports_writes = !is_in(kSilent);
  format.has_false_origin = format.driver != "PDS4";
  format.earth_only = format.only_wgs84 || format.driver == "GeoJSON";
  if (format.driver.ends_with("KML")) format.name_field = "Name", format.description_field = "Description";
  if (format.driver == "GPX") format.name_field = "name", format.description_field = "desc";
  if (format.driver == "GeoRSS") format.name_field = "title", format.description_field = "description";
  // With the tables and functions of SpatiaLite, and only the CRS that is used instead of 6000 (6 MB).
  const char* offered = driver.GetMetadataItem(GDAL_DMD_CREATIONOPTIONLIST);
  if (format.driver == "SQLite" && offered != nullptr &&
      std::string_view(offered).find("'SPATIALITE'") != std::string_view::npos)
    format.creation_options = {"SPATIALITE=YES", "INIT_WITH_EPSG=NO"};
  // Measured with 1,000,000 rocks (GDAL 3.6): of FlatGeobuf the index alone.
  if (format.driver == "FlatGeobuf") format.bytes_per_landmark = 220;
  if (format.driver == "ODS") format.bytes_per_landmark = 500;
  if (format.driver == "XLSX") format.bytes_per_landmark = 670;
  if (format.driver == "ODS" || format.driver == "XLSX") format.max_landmarks = kSheetRows - 1;
  format.max_name_length = format.driver == "ESRI Shapefile" ? kDbfName : 0;
  return format;
}

Crs output_crs(const VectorFormat& format, const Crs& map_crs, const std::string& asked,
               const std::string& what) {
  const Crs wgs84 = Crs::from_text("EPSG:4326");
  const bool on_earth = map_crs.kind() != CrsKind::local && map_crs.body().name == earth().name;
  Crs wanted = !asked.empty() ? Crs::from_text(asked) : format.earth_only && on_earth ? wgs84 : map_crs;
  if (!format.has_false_origin) wanted = without_false_origin(wanted);
  if (!wanted.same_as(map_crs)) static_cast<void>(CrsTransform(map_crs, wanted));  // throws PROJ's reason
  if (format.earth_only && !on_earth)
    throw Error(
        ErrorCode::usage,
        fmt::format("{} holds positions on Earth only; this map is {}", format.driver,
                    map_crs.kind() == CrsKind::local ? "in local metres" : "on " + map_crs.body().name),
        fmt::format("{}: {}", what, map_crs.id()),
        "write .gpkg, .fgb or .shp, which keep the CRS, or .csv, which has plain columns");
  if (format.only_wgs84 && !wanted.same_as(wgs84))
    throw Error(ErrorCode::usage, fmt::format("{} holds EPSG:4326 only, not {}", format.driver, wanted.id()),
                "--crs " + asked, "leave out --crs, or write .gpkg, .fgb or .shp, which hold any CRS");
  return wanted;
}

std::vector<std::string> shorten_names(const VectorFormat& format, const std::vector<std::string>& names) {
  if (format.max_name_length == 0) return names;
  std::vector<std::string> fitting;
  std::set<std::string> taken;
  for (const std::string& name : names) {
    std::string shorter = cut(name, format.max_name_length);
    for (int n = 2; !taken.insert(shorter).second; ++n) {
      const std::string number = fmt::format("{}", n);
      shorter = name.substr(0, format.max_name_length - number.size()) + number;
    }
    fitting.push_back(shorter);
  }
  return fitting;
}

}  // namespace waymark::exporters
