// SPDX-License-Identifier: Apache-2.0
#include "importers/images/photo_metadata.hpp"

#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "importers/images/exif_tags.hpp"
#include "importers/images/image_header.hpp"
#include "importers/tables/text_table.hpp"

namespace waymark::importers {
namespace {

// Parses "(46) (50) (33.3855)", "(3.61)" and "20".
std::vector<double> exif_numbers(const std::string& text) {
  std::vector<double> out;
  std::string word;
  for (const char c : text + " ") {
    if (c != '(' && c != ')' && c != ' ' && c != ',') {
      word += c;
      continue;
    }
    double value = 0;
    if (!word.empty() && parse_number(word, value) && std::isfinite(value)) out.push_back(value);
    word.clear();
  }
  return out;
}

std::optional<double> exif_number(const ExifTags& exif, const char* name) {
  const std::vector<double> all = exif_numbers(exif.text(name));
  return all.empty() ? std::nullopt : std::optional(all[0]);
}

// Degrees, minutes, seconds with the letter of the hemisphere.
std::optional<double> exif_angle(const ExifTags& exif, const char* name, const char* reference, char negative,
                                 double limit) {
  const std::vector<double> part = exif_numbers(exif.text(name));
  if (part.empty()) return std::nullopt;
  double value = part[0];
  if (part.size() > 1) value += part[1] / 60;
  if (part.size() > 2) value += part[2] / 3600;
  if (const std::string letter = exif.text(reference); !letter.empty() && letter[0] == negative)
    value = -value;
  return std::abs(value) <= limit ? std::optional(value) : std::nullopt;
}

// Value of an XMP property, as attribute name="value" or element <name>value</name>.
std::optional<double> xmp_number(std::string_view xmp, std::string_view name) {
  for (std::size_t at = xmp.find(name); at != xmp.npos; at = xmp.find(name, at + 1)) {
    std::size_t from = at + name.size();
    if (from + 1 >= xmp.size()) break;
    if (xmp[from] == '=')
      from += 2;
    else if (xmp[from] == '>')
      from += 1;
    else
      continue;
    const std::size_t end = xmp.find_first_of("\"'<", from);
    if (end == xmp.npos) break;
    std::string_view word = xmp.substr(from, end - from);
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    if (parse_number(word, value) && std::isfinite(value)) return value;
  }
  return std::nullopt;
}

// Pixels of this file per pixel of the camera's: the longer sides are compared, since programs that turn a
// picture leave the dimensions that EXIF states.
double scale_of_file(const ExifTags& exif, const PhotoMetadata& photo) {
  const double columns = exif_number(exif, "EXIF_PixelXDimension").value_or(0);
  const double rows = exif_number(exif, "EXIF_PixelYDimension").value_or(0);
  if (!(columns > 0)) return 1;
  if (!(rows > 0)) return double(photo.columns) / columns;
  return double(std::max(photo.columns, photo.rows)) / std::max(columns, rows);
}

void read_focal_length(const ExifTags& exif, PhotoMetadata& photo) {
  const double longer = double(std::max(photo.columns, photo.rows));
  photo.focal = 0.85 * longer;
  const auto plausible = [&](double focal) { return focal > 0.2 * longer && focal < 60 * longer; };
  const auto film = exif_number(exif, "EXIF_FocalLengthIn35mmFilm");
  if (film && plausible(*film / 36 * longer)) {
    photo.focal = *film / 36 * longer;
    photo.focal_sd = 0.05;
    photo.focal_source = FocalSource::film_equivalent;
  }
  const auto millimetres = exif_number(exif, "EXIF_FocalLength");
  const auto resolution = exif_number(exif, "EXIF_FocalPlaneXResolution");
  if (!millimetres || !resolution || !(*resolution > 0)) return;
  const int unit = static_cast<int>(exif_number(exif, "EXIF_FocalPlaneResolutionUnit").value_or(2));
  const double unit_mm = unit == 3 ? 10 : unit == 4 ? 1 : unit == 5 ? 1e-3 : 25.4;
  const double focal = *millimetres * *resolution / unit_mm * scale_of_file(exif, photo);
  if (!plausible(focal)) return;
  photo.focal = focal;
  photo.focal_sd = 0.03;
  photo.focal_source = FocalSource::plane_resolution;
}

void read_position(const ExifTags& exif, PhotoMetadata& photo) {
  const auto lat = exif_angle(exif, "EXIF_GPSLatitude", "EXIF_GPSLatitudeRef", 'S', 90);
  const auto lon = exif_angle(exif, "EXIF_GPSLongitude", "EXIF_GPSLongitudeRef", 'W', 180);
  if (!lat || !lon || (*lat == 0 && *lon == 0)) return;  // receivers without a fix write zeros
  photo.position = {.lon = *lon, .lat = *lat};
  auto altitude = exif_number(exif, "EXIF_GPSAltitude");
  if (!altitude || std::abs(*altitude) > 2e5) return;
  const std::string below = exif.text("EXIF_GPSAltitudeRef");
  if (below == "0x01" || below == "1") altitude = -*altitude;
  photo.position->altitude = altitude;
}

}  // namespace

PhotoMetadata read_photo_metadata(GDALDataset& dataset, const std::string& path) {
  const ImageHeader header = read_image_header(dataset, path, 0);
  PhotoMetadata photo{.columns = header.columns, .rows = header.rows};
  std::array<double, 6> transform{};
  photo.is_orthophoto = dataset.GetGeoTransform(transform.data()) == CE_None && dataset.GetSpatialRef();
  const ExifTags exif = read_exif_tags(dataset);
  photo.camera = exif.text("EXIF_Make");
  if (const std::string model = exif.text("EXIF_Model"); !model.empty())
    photo.camera += (photo.camera.empty() ? "" : " ") + model;
  if (const auto turn = exif_number(exif, "EXIF_Orientation"); turn && *turn >= 1 && *turn <= 8)
    photo.orientation = static_cast<int>(*turn);
  read_focal_length(exif, photo);
  read_position(exif, photo);
  char** const xmp_lines = dataset.GetMetadata("xml:XMP");
  const std::string_view xmp = xmp_lines && xmp_lines[0] ? xmp_lines[0] : "";
  photo.height_above_takeoff = xmp_number(xmp, "RelativeAltitude");
  const auto yaw = xmp_number(xmp, "GimbalYawDegree"), pitch = xmp_number(xmp, "GimbalPitchDegree"),
             roll = xmp_number(xmp, "GimbalRollDegree");
  if (yaw && pitch && std::abs(*yaw) <= 360 && std::abs(*pitch) <= 180)
    photo.gimbal = {.yaw = *yaw, .pitch = *pitch, .roll = roll.value_or(0)};
  return photo;
}

}  // namespace waymark::importers
