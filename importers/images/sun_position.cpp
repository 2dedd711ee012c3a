// SPDX-License-Identifier: Apache-2.0
#include "importers/images/sun_position.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cmath>

#include "core/error.hpp"
#include "importers/tables/text_table.hpp"

namespace waymark::importers {
namespace {

double wrapped(double degrees) {
  const double turned = std::fmod(degrees, 360.0);
  return turned < 0 ? turned + 360 : turned;
}

double rad(double degrees) {
  return degrees * kRadiansPerDegree;
}

// Right ascension and declination, radians; `days` from J2000 in dynamical time (Meeus 25.2 to 25.8).
struct Equatorial {
  double ascension, declination;
};
Equatorial apparent_sun(double days) {
  const double t = days / 36525;
  const double mean_longitude = 280.46646 + t * (36000.76983 + t * 0.0003032);
  const double anomaly = rad(357.52911 + t * (35999.05029 - t * 0.0001537));
  const double centre = (1.914602 - t * (0.004817 + t * 0.000014)) * std::sin(anomaly) +
                        (0.019993 - t * 0.000101) * std::sin(2 * anomaly) + 0.000289 * std::sin(3 * anomaly);
  const double node = rad(125.04 - 1934.136 * t);
  const double longitude = rad(mean_longitude + centre - 0.00569 - 0.00478 * std::sin(node));
  const double obliquity =
      rad(23.4392911 - t * (0.0130042 + t * (1.64e-7 - t * 5.04e-7)) + 0.00256 * std::cos(node));
  return {std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude)),
          std::asin(std::sin(obliquity) * std::sin(longitude))};
}

// Greenwich apparent sidereal time, degrees (Meeus 12.4; the nutation in longitude is below 0.005 deg).
double sidereal(double days) {
  const double t = days / 36525;
  return wrapped(280.46061837 + 360.98564736629 * days + t * t * (0.000387933 - t / 38710000));
}

// Dynamical minus universal time, seconds: 64 s in 2000, 69 s in 2020. The sun moves 1e-5 deg in a second.
constexpr double kDeltaT = 67;

}  // namespace

Sun sun_from_direction(const Eigen::Vector3d& towards_sun) {
  const Eigen::Vector3d s = towards_sun.normalized();
  return {.azimuth = Degrees{wrapped(std::atan2(s.x(), s.y()) / kRadiansPerDegree)},
          .elevation = Degrees{std::atan2(s.z(), std::hypot(s.x(), s.y())) / kRadiansPerDegree}};
}

Sun sun_on_earth(double unix_seconds, double lon, double lat) {
  const double days = (unix_seconds - 946728000.0) / 86400;  // J2000: 2000-01-01 12:00
  const auto [ascension, declination] = apparent_sun(days + kDeltaT / 86400);
  const double hour = rad(sidereal(days) + lon) - ascension, latitude = rad(lat);
  // East, north, up.
  const Eigen::Vector3d towards(-std::cos(declination) * std::sin(hour),
                                std::sin(declination) * std::cos(latitude) -
                                    std::cos(declination) * std::cos(hour) * std::sin(latitude),
                                std::sin(declination) * std::sin(latitude) +
                                    std::cos(declination) * std::cos(hour) * std::cos(latitude));
  // Parallax: seen from the surface, the sun is 8.8" lower at the horizon than from the centre.
  Sun sun = sun_from_direction(towards);
  sun.elevation.value -= 8.794 / 3600 * std::cos(rad(sun.elevation.value));
  return sun;
}

Sun sun_on_map(double unix_seconds, const Crs& crs, double x, double y) {
  if (crs.kind() == CrsKind::local || crs.body().name != earth().name)
    throw Error(ErrorCode::input,
                fmt::format("the sun follows from the time on Earth only; this map is on {}",
                            crs.kind() == CrsKind::local ? "no body" : crs.body().name),
                "", "give sun_azimuth and sun_elevation, or the sun in the camera file");
  const Crs degrees = geographic_crs(crs);
  const CrsTransform to_degrees(crs, degrees), to_map(degrees, crs);
  const auto [lon, lat] = to_degrees(x, y);
  Sun sun = sun_on_earth(unix_seconds, lon, lat);
  if (crs.kind() == CrsKind::geographic) return sun;
  // Azimuth of true north in the grid, clockwise from its y axis.
  constexpr double kStep = 1e-4;
  const auto [x0, y0] = to_map(lon, lat - kStep);
  const auto [x1, y1] = to_map(lon, lat + kStep);
  sun.azimuth.value = wrapped(sun.azimuth.value + std::atan2(x1 - x0, y1 - y0) / kRadiansPerDegree);
  return sun;
}

std::optional<double> utc_seconds(std::string_view text) {
  // Format: "YYYY-MM-DDTHH:MM[:SS[.fff]]" and "Z", "+HH:MM" or "+HHMM".
  const auto digits = [&](std::size_t at, std::size_t count, double& value) {
    if (at + count > text.size()) return false;
    value = 0;
    for (std::size_t i = at; i < at + count; ++i) {
      if (text[i] < '0' || text[i] > '9') return false;
      value = 10 * value + (text[i] - '0');
    }
    return true;
  };
  double year, month, day, hour, minute, second = 0;
  if (text.size() < 17 || text[4] != '-' || text[7] != '-' || (text[10] != 'T' && text[10] != ' ') ||
      text[13] != ':')
    return std::nullopt;
  if (!digits(0, 4, year) || !digits(5, 2, month) || !digits(8, 2, day) || !digits(11, 2, hour) ||
      !digits(14, 2, minute))
    return std::nullopt;
  std::size_t at = 16;
  if (text[at] == ':') {
    std::size_t end = at + 1;
    while (end < text.size() && ((text[end] >= '0' && text[end] <= '9') || text[end] == '.')) ++end;
    if (!parse_number(text.substr(at + 1, end - at - 1), second)) return std::nullopt;
    at = end;
  }
  double offset = 0;
  if (text.substr(at) != "Z") {
    const bool colon = text.size() == at + 6 && text[at + 3] == ':';
    double hours, minutes;
    if (at >= text.size() || (text[at] != '+' && text[at] != '-') || !(colon || text.size() == at + 5) ||
        !digits(at + 1, 2, hours) || !digits(at + (colon ? 4 : 3), 2, minutes))
      return std::nullopt;
    offset = (text[at] == '-' ? -60 : 60) * (60 * hours + minutes);
  }
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(year)),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok() || hour > 24 || minute > 59 || !(second < 61)) return std::nullopt;
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return 86400.0 * static_cast<double>(days) + 3600 * hour + 60 * minute + second - offset;
}

std::string utc_text(double unix_seconds) {
  const auto whole = std::chrono::seconds(static_cast<std::int64_t>(std::floor(unix_seconds)));
  const auto date = std::chrono::floor<std::chrono::days>(whole);
  const std::chrono::year_month_day ymd{std::chrono::sys_days(date)};
  const std::int64_t rest = (whole - date).count();
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", static_cast<int>(ymd.year()),
                     static_cast<unsigned>(ymd.month()), static_cast<unsigned>(ymd.day()), rest / 3600,
                     rest / 60 % 60, rest % 60);
}

std::string precise_utc_text(double unix_seconds) {
  const auto milliseconds = std::llround(unix_seconds * 1e3);
  const std::string whole = utc_text(std::floor(static_cast<double>(milliseconds) / 1e3));
  const auto rest = ((milliseconds % 1000) + 1000) % 1000;
  return rest == 0 ? whole : fmt::format("{}.{:03}Z", whole.substr(0, whole.size() - 1), rest);
}

}  // namespace waymark::importers
