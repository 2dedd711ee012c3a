// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include "core/units.hpp"
#include "importers/gdal_session.hpp"
namespace waymark {

/// When an image was taken, as its file says.
struct TimeTaken {
  std::optional<double> utc;  ///< seconds since 1970-01-01
  std::string local;          ///< a time without offset, "2019-04-11T11:01:21"; empty: none
};

/// EXIF: original time and its offset, else GPS time (UTC). `time_zone` ("+08:00", "Z") is used where EXIF
/// has no offset; empty: then the time stays local. PDS: START_TIME, which is UTC.
TimeTaken time_taken(GDALDataset& dataset, const std::string& time_zone);

/// The sun as a planetary label tells it.
struct LabelSun {
  std::optional<Degrees> image_angle;  ///< towards the sun in the image, from x (right) towards y (down)
  std::optional<Degrees> elevation;    ///< 90 minus the incidence angle, above the ellipsoid's horizon
};

/// Reads SUB_SOLAR_AZIMUTH (HiRISE, LROC: clockwise from the image's right) and INCIDENCE_ANGLE from PDS3 or
/// ISIS label text; ISIS's SubSolarAzimuth and IncidenceAngle too.
LabelSun label_sun(std::string_view label);

/// Label text of an image: at the head of the file itself, or the .LBL (.lbl) beside it; empty where there is
/// none.
std::string label_of(const std::string& image_path);

}  // namespace waymark
