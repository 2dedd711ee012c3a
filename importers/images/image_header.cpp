// SPDX-License-Identifier: Apache-2.0
#include "importers/images/image_header.hpp"

#include <fmt/format.h>
#include <gdal_priv.h>

#include <array>
#include <cmath>

#include "core/error.hpp"
#include "importers/images/image.hpp"

namespace waymark::importers {
namespace {

using GeoTransform = std::array<double, 6>;  // as in GDAL, about the corner of the first pixel

[[noreturn]] void refuse(const std::string& problem, const std::string& path, const std::string& hint) {
  throw Error(ErrorCode::input, problem, path, hint);
}

// Programs write the identity if they know no georeference.
std::optional<GeoTransform> transform_of(GDALDataset& dataset) {
  GeoTransform t{};
  if (dataset.GetGeoTransform(t.data()) != CE_None) return std::nullopt;
  const bool nothing = t == GeoTransform{0, 1, 0, 0, 0, 1} || t == GeoTransform{0, 1, 0, 0, 0, -1};
  return nothing && !dataset.GetSpatialRef() ? std::nullopt : std::optional(t);
}

std::string definition_of(const GDALDataset& dataset) {
  char* wkt = nullptr;
  const char* const wkt2[] = {"FORMAT=WKT2_2019", nullptr};
  const OGRSpatialReference* reference = dataset.GetSpatialRef();
  if (reference) reference->exportToWkt(&wkt, wkt2);
  const std::string definition = wkt ? wkt : "";
  CPLFree(wkt);
  return definition;
}

std::string warp_command(const std::string& path, const std::string& target) {
  return fmt::format("gdalwarp -r cubic{} '{}' north_up.tif",
                     target.empty() ? "" : " -t_srs '" + target + "'", path);
}

Crs crs_of(const GDALDataset& dataset, const std::string& path, const std::string& replacement,
           std::vector<std::string>& warnings) {
  if (!replacement.empty()) return Crs::from_text(replacement);
  const std::string definition = definition_of(dataset);
  if (!definition.empty()) return Crs::from_text(definition);
  warnings.push_back(fmt::format(
      "{} has a georeference but names no CRS: metres on no body are assumed; pass crs otherwise", path));
  return Crs::local();
}

void refuse_degrees(const Crs& crs, const GeoTransform& t, const ImageHeader& header,
                    const std::string& path) {
  if (crs.kind() != CrsKind::geographic) return;
  const double lon = t[0] + t[1] * static_cast<double>(header.columns) / 2;
  const double lat = t[3] + t[5] * static_cast<double>(header.rows) / 2;
  refuse(fmt::format("the image is in degrees ({}): its pixels have no size in metres", crs.id()), path,
         "project it: " + warp_command(path, local_projection(crs, lon, lat)));
}

double full_scale(GDALRasterBand& band) {
  const char* bits = band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE");
  const GDALDataType type = band.GetRasterDataType();
  if (type != GDT_Byte && type != GDT_UInt16) return 0;
  const int n = bits ? std::atoi(bits) : type == GDT_Byte ? 8 : 16;
  return n >= 2 && n <= 16 ? std::ldexp(1.0, n) - 1 : 0;
}

}  // namespace

ImageHeader read_image_header(GDALDataset& dataset, const std::string& path, int band) {
  const int bands = dataset.GetRasterCount();
  if (bands == 0) {
    const char* first = CSLFetchNameValue(dataset.GetMetadata("SUBDATASETS"), "SUBDATASET_1_NAME");
    refuse("the file itself contains no image", path,
           first ? fmt::format("name one of its data sets, e.g. {}", first) : "`gdalinfo` shows its content");
  }
  if (band < 0 || band > bands)
    refuse(fmt::format("there is no band {}: the image has {}", band, bands), path,
           "name a band from 1, or 0 for brightness");
  GDALRasterBand& one = *dataset.GetRasterBand(std::max(band, 1));
  if (GDALDataTypeIsComplex(one.GetRasterDataType()))
    refuse(fmt::format("the pixels are complex numbers ({})", GDALGetDataTypeName(one.GetRasterDataType())),
           path,
           "make an intensity image: gdal_translate -ot Float32 DERIVED_SUBDATASET:INTENSITY:FILE out.tif");
  return {
      .columns = dataset.GetRasterXSize(), .rows = dataset.GetRasterYSize(), .saturated = full_scale(one)};
}

std::optional<Georeference> orthophoto_georeference(GDALDataset& dataset, const std::string& path,
                                                    const std::string& crs,
                                                    std::vector<std::string>& warnings) {
  const auto found = transform_of(dataset);
  if (!found) return std::nullopt;
  const GeoTransform& t = *found;
  const ImageHeader header = read_image_header(dataset, path, 0);
  const double tiny = 1e-3 / static_cast<double>(std::max(header.columns, header.rows));  // of a pixel
  if (std::abs(t[2]) > tiny * std::abs(t[1]) || std::abs(t[4]) > tiny * std::abs(t[5]))
    refuse("the image is rotated against the axes of its CRS", path,
           "an orthophoto: " + warp_command(path, {}) + "; a frame image: give its camera");
  if (!(t[1] > 0) || !(t[5] < 0))
    refuse(fmt::format("the pixels measure {} x {}: columns must run east and rows south", t[1], t[5]), path,
           "resample it: " + warp_command(path, {}));
  const Crs where = crs_of(dataset, path, crs, warnings);
  refuse_degrees(where, t, header, path);
  if (const double ratio = -t[5] / t[1]; !(std::abs(ratio - 1) < 0.01))
    warnings.push_back(
        fmt::format("{} has pixels of {:.6g} x {:.6g}: circles appear as ellipses", path, t[1], -t[5]));
  return Georeference{where, t[0] + t[1] / 2, t[3] + t[5] / 2, t[1], t[5]};
}

}  // namespace waymark::importers
