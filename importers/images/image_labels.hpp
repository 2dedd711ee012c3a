// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include "core/units.hpp"
#include "importers/gdal_session.hpp"
namespace waymark::importers {

/// Time of exposure, from the image file.
struct TimeTaken {
  std::optional<double> utc;  ///< seconds since 1970-01-01
  std::string local;          ///< time without offset, "2019-04-11T11:01:21"; empty: none
  /// Seconds since 1970-01-01 of the camera's own clock, with EXIF's fraction of a second; the offset is
  /// unknown.
  std::optional<double> clock = {};
};

/// Reads the time of exposure. EXIF: original time and its offset, else GPS time (UTC). `time_zone`
/// ("+08:00", "Z") applies if EXIF has no offset; if it is empty, the time stays local. PDS: START_TIME,
/// which is UTC.
TimeTaken time_taken(GDALDataset& dataset, const std::string& time_zone);

/// The sun according to a planetary label.
struct LabelSun {
  std::optional<Degrees> image_angle;  ///< towards the sun in the image, from x (right) towards y (down)
  std::optional<Degrees> elevation;    ///< 90 minus the incidence angle, above the ellipsoid's horizon
};

/// Reads SUB_SOLAR_AZIMUTH (HiRISE, LROC: clockwise from the image's right) and INCIDENCE_ANGLE from PDS3 or
/// ISIS label text, also SubSolarAzimuth and IncidenceAngle of ISIS.
LabelSun label_sun(std::string_view label);

/// Returns the label text of an image, from the head of the file or the .LBL (.lbl) beside it; empty if there
/// is none.
std::string label_of(const std::string& image_path);

}  // namespace waymark::importers
