// SPDX-License-Identifier: Apache-2.0
#include "importers/images/image_labels.hpp"

#include <cpl_vsi.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "core/error.hpp"
#include "importers/images/exif_tags.hpp"
#include "importers/images/sun_position.hpp"
#include "importers/json_value.hpp"
#include "importers/tables/text_table.hpp"

namespace waymark::importers {
namespace {

constexpr std::size_t kLabelBytes = std::size_t{1} << 18;

// Converts "2019:04:11 11:01:21" to "2019-04-11T11:01:21".
std::string iso(std::string exif) {
  if (exif.size() < 19) return {};
  exif[4] = exif[7] = '-';
  exif[10] = 'T';
  return exif.substr(0, 19);
}

// Parses a time such as "(3) (1) (22.5)" as 03:01:22.5.
std::optional<double> gps_time(const std::string& date, const std::string& time) {
  if (date.size() < 10) return std::nullopt;
  std::array<double, 3> part{};
  std::size_t at = 0;
  for (double& value : part) {
    const std::size_t open = time.find('(', at), close = time.find(')', at);
    if (open == time.npos || close == time.npos ||
        !parse_number(time.substr(open + 1, close - open - 1), value))
      return std::nullopt;
    at = close + 1;
  }
  const auto midnight = utc_seconds(iso(date + " 00:00:00") + "Z");
  return midnight ? std::optional(*midnight + 3600 * part[0] + 60 * part[1] + part[2]) : std::nullopt;
}

// Returns the number after "KEY = " in label text.
std::optional<double> keyword(std::string_view label, std::string_view key) {
  for (std::size_t at = label.find(key); at != label.npos; at = label.find(key, at + 1)) {
    const bool begins =
        at == 0 || !(std::isalnum(static_cast<unsigned char>(label[at - 1])) || label[at - 1] == '_');
    std::size_t next = label.find_first_not_of(" \t", at + key.size());
    if (!begins || next == label.npos || label[next] != '=') continue;
    next = label.find_first_not_of(" \t\"", next + 1);
    if (next == label.npos) continue;
    const std::size_t end = std::min(label.find_first_of(" \t\r\n<\"", next), label.size());
    double value = 0;
    if (parse_number(label.substr(next, end - next), value) && value > -1e30) return value;
  }
  return std::nullopt;
}

bool is_label(std::string_view head) {
  const std::string_view start = head.substr(0, 2048);
  return start.find("PDS_VERSION_ID") != start.npos || start.find("Object = IsisCube") != start.npos;
}

}  // namespace

TimeTaken time_taken(GDALDataset& dataset, const std::string& time_zone) {
  const ExifTags exif = read_exif_tags(dataset);
  TimeTaken taken;
  std::string time = iso(exif.text("EXIF_DateTimeOriginal"));
  if (time.empty()) time = iso(exif.text("EXIF_DateTime"));
  std::string offset = exif.text("EXIF_OffsetTimeOriginal");
  if (offset.empty()) offset = exif.text("EXIF_OffsetTime");
  if (!time.empty() && !offset.empty()) taken.utc = utc_seconds(time + offset);
  if (!taken.utc) taken.utc = gps_time(exif.text("EXIF_GPSDateStamp"), exif.text("EXIF_GPSTimeStamp"));
  if (!taken.utc && !time.empty() && !time_zone.empty()) taken.utc = utc_seconds(time + time_zone);
  if (!taken.utc) taken.local = time;
  taken.clock = time.empty() ? taken.utc : utc_seconds(time + "Z");
  double fraction = 0;
  if (const std::string digits = exif.text("EXIF_SubSecTime_Original");
      taken.clock && !time.empty() && !digits.empty() && parse_number("0." + digits, fraction))
    *taken.clock += fraction;
  return taken;
}

LabelSun label_sun(std::string_view label) {
  LabelSun sun;
  std::optional<double> angle = keyword(label, "SUB_SOLAR_AZIMUTH");
  if (!angle) angle = keyword(label, "SubSolarAzimuth");
  std::optional<double> incidence = keyword(label, "INCIDENCE_ANGLE");
  if (!incidence) incidence = keyword(label, "IncidenceAngle");
  if (angle && *angle >= -360 && *angle <= 360) sun.image_angle = Degrees{*angle};
  if (incidence && *incidence >= 0 && *incidence < 90) sun.elevation = Degrees{90 - *incidence};
  return sun;
}

std::string label_of(const std::string& image_path) {
  for (const char* extension : {".LBL", ".lbl"}) {
    const std::string beside = std::filesystem::path(image_path).replace_extension(extension).string();
    VSIStatBufL status;
    if (VSIStatL(beside.c_str(), &status) == 0) return read_vsi_head(beside, kLabelBytes);
  }
  try {
    std::string head = read_vsi_head(image_path, kLabelBytes);
    return is_label(head) ? head : "";
  } catch (const Error&) {  // a name that only GDAL understands names no file
    return "";
  }
}

}  // namespace waymark::importers
