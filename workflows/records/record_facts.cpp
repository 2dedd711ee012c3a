// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "core/error.hpp"
#include "exporters/records/map_extent.hpp"
#include "geodb/map_store.hpp"
#include "workflows/records/make_stac.hpp"

namespace waymark::workflows {
namespace {

namespace fs = std::filesystem;
using exporters::MapBox;
using exporters::RecordFacts;

constexpr double kAlike = 1;  // degrees within which the sun of all images is one

[[noreturn]] void refuse(const std::string& file) {
  throw Error(ErrorCode::input, "this is neither a map nor a raster that GDAL reads", file,
              "`waymark stac` takes .gpkg of Waymark, GeoTIFF and other rasters");
}

/// Returns the direction of map north at the middle of a box, degrees clockwise from true north.
double azimuth_of_map_north(const MapBox& box, const Crs& crs) {
  if (crs.kind() != CrsKind::projected) return 0;
  const CrsTransform to_body(crs, geographic_crs(crs));
  const double x = (box.min_x + box.max_x) / 2, y = (box.min_y + box.max_y) / 2;
  const auto here = to_body(x, y), north = to_body(x, y + 1 / crs.metres_per_unit());
  constexpr double kDegree = 3.14159265358979323846 / 180;
  return std::atan2(std::remainder(north.x - here.x, 360.0) * std::cos(here.y * kDegree), north.y - here.y) /
         kDegree;
}

void add_sun(RecordFacts& facts, const std::vector<geodb::ImageRecord>& images) {
  if (images.empty() || !facts.box || facts.crs.kind() == CrsKind::local) return;
  const auto& first = images.front();
  for (const geodb::ImageRecord& image : images)
    if (!image.sun_azimuth || !image.sun_elevation ||
        !(std::abs(std::remainder(image.sun_azimuth->value - first.sun_azimuth->value, 360.0)) <= kAlike) ||
        !(std::abs(image.sun_elevation->value - first.sun_elevation->value) <= kAlike))
      return;
  const double azimuth = first.sun_azimuth->value + azimuth_of_map_north(*facts.box, facts.crs);
  facts.sun_azimuth = azimuth - 360 * std::floor(azimuth / 360);
  facts.sun_elevation = first.sun_elevation->value;
}

void add_images(RecordFacts& facts, const std::vector<geodb::ImageRecord>& images) {
  for (const geodb::ImageRecord& image : images) {
    if (image.gsd && (!facts.gsd || image.gsd->value < *facts.gsd)) facts.gsd = image.gsd->value;
    if (image.taken_utc.empty()) continue;
    facts.first_image =
        facts.first_image.empty() ? image.taken_utc : std::min(facts.first_image, image.taken_utc);
    facts.last_image = std::max(facts.last_image, image.taken_utc);
  }
  add_sun(facts, images);
}

/// Returns when a file was last written, or SOURCE_DATE_EPOCH.
std::string time_of(const std::string& file) {
  using namespace std::chrono;
  std::int64_t seconds = 0;
  if (const char* epoch = std::getenv("SOURCE_DATE_EPOCH")) {
    seconds = std::strtoll(epoch, nullptr, 10);
  } else {
    std::error_code missing;
    const auto written = fs::last_write_time(file, missing);
    if (!missing)
      seconds = duration_cast<std::chrono::seconds>(file_clock::to_sys(written).time_since_epoch()).count();
  }
  const year_month_day day{sys_days(floor<days>(std::chrono::seconds(seconds)))};
  const std::int64_t rest = ((seconds % 86400) + 86400) % 86400;
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", static_cast<int>(day.year()),
                     static_cast<unsigned>(day.month()), static_cast<unsigned>(day.day()), rest / 3600,
                     rest / 60 % 60, rest % 60);
}

/// Returns "0.1.0" of "waymark 0.1.0".
std::string version_number(const std::string& version) {
  return version.substr(version.rfind(' ') + 1);
}

// "2026:11:24 10:00:00", TIFF 6.0, tag 306
std::string time_of_tiff(const char* tag) {
  const std::string text = tag ? tag : "";
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0;
  if (std::sscanf(text.c_str(), "%4d:%2d:%2d %2d:%2d:%2d", &year, &month, &day, &hour, &minute, &second) != 6)
    return "";
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", year, month, day, hour, minute, second);
}

std::string media_type(GDALDataset& raster) {
  const char* layout = raster.GetMetadataItem("LAYOUT", "IMAGE_STRUCTURE");
  const bool tiff = EQUAL(raster.GetDriver()->GetDescription(), "GTiff");
  if (tiff)
    return std::string("image/tiff; application=geotiff") +
           (layout && EQUAL(layout, "COG") ? "; profile=cloud-optimized" : "");
  const char* type = raster.GetDriver()->GetMetadataItem(GDAL_DMD_MIMETYPE);
  return type ? type : "application/octet-stream";
}

/// Returns the extent of a map. In degrees across the antimeridian, longitudes are those from 0 to 360.
std::optional<MapBox> extent_of(const geodb::MapStore& store, const std::string& map) {
  std::optional<MapBox> box = exporters::map_extent(map);
  if (!box || store.crs().kind() != CrsKind::geographic || box->max_x - box->min_x <= 180) return box;
  double west = 360, east = 0;
  const auto extend = [&](double x) {
    const double eastern = x - 360 * std::floor(x / 360);
    west = std::min(west, eastern), east = std::max(east, eastern);
  };
  for (const std::string& type : store.types().names())
    store.visit(type, [&](Landmark&& landmark) { extend(landmark.position.xyz.x()); });
  for (const geodb::ImageRecord& image : store.images())
    for (const geodb::ImageRecord::Ring& ring : image.footprint)
      for (const Eigen::Vector2d& corner : ring) extend(corner.x());
  if (east - west < box->max_x - box->min_x) box->min_x = west, box->max_x = east;
  return box;
}

}  // namespace

RecordFacts facts_of_map(const std::string& map) {
  const geodb::MapStore store = geodb::MapStore::open(map);
  RecordFacts facts{.id = fs::path(map).stem(), .crs = store.crs(), .box = extent_of(store, map)};
  for (const std::string& type : store.types().names()) facts.landmarks.emplace_back(type, store.count(type));
  add_images(facts, store.images());
  const std::vector<geodb::RunRecord> runs = store.runs();
  if (!runs.empty()) {
    facts.created = runs.back().started_utc;
    facts.software_version = version_number(runs.back().version);
    facts.lineage = runs.back().command_line;
  } else {
    facts.created = time_of(map);
  }
  facts.title = "Landmarks of " + facts.id;
  facts.assets.push_back(
      {.key = "map", .type = "application/geopackage+sqlite3", .title = "Waymark map", .roles = {"data"}});
  return facts;
}

RecordFacts facts_of_raster(const std::string& raster) {
  GDALAllRegister();
  CPLPushErrorHandler(CPLQuietErrorHandler);
  const GDALDatasetUniquePtr file(GDALDataset::Open(raster.c_str(), GDAL_OF_RASTER));
  CPLPopErrorHandler();
  if (!file) refuse(raster);
  RecordFacts facts{.id = fs::path(raster).stem()};
  facts.shape = {file->GetRasterYSize(), file->GetRasterXSize()};
  std::array<double, 6> t{};
  if (file->GetGeoTransform(t.data()) == CE_None) {
    facts.transform = t;
    const auto columns = static_cast<double>(file->GetRasterXSize()),
               rows = static_cast<double>(file->GetRasterYSize());
    const auto [min_x, max_x] =
        std::minmax({t[0], t[0] + columns * t[1], t[0] + rows * t[2], t[0] + columns * t[1] + rows * t[2]});
    const auto [min_y, max_y] =
        std::minmax({t[3], t[3] + columns * t[4], t[3] + rows * t[5], t[3] + columns * t[4] + rows * t[5]});
    facts.box = MapBox{min_x, min_y, max_x, max_y};
  }
  if (const OGRSpatialReference* srs = file->GetSpatialRef(); srs && !srs->IsLocal()) {
    char* wkt = nullptr;
    const char* form[] = {"FORMAT=WKT2_2019", nullptr};
    srs->exportToWkt(&wkt, form);
    const std::string text = wkt ? wkt : "";
    CPLFree(wkt);
    facts.crs = Crs::from_text(text);
  }
  facts.created = time_of(raster);
  facts.first_image = facts.last_image = time_of_tiff(file->GetMetadataItem("TIFFTAG_DATETIME"));
  if (const char* version = file->GetMetadataItem("WAYMARK_VERSION"))
    facts.software_version = version_number(version);
  facts.assets.push_back(
      {.key = "raster", .type = media_type(*file), .title = fs::path(raster).filename(), .roles = {"data"}});
  return facts;
}

}  // namespace waymark::workflows
