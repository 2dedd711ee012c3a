// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include "geo/crs.hpp"
#include "geo/sun.hpp"
namespace waymark::importers {

/// Returns the sun for a vector towards it in the grid frame, any length > 0.
Sun sun_from_direction(const Eigen::Vector3d& towards_sun);

/// Computes the position of the sun on Earth: azimuth clockwise from true north, elevation without refraction
/// (below 0.1 deg above 10 deg of elevation). Longitude east, degrees; time in seconds since 1970-01-01 UTC.
/// Meeus, Astronomical Algorithms (1998), ch. 25 (low accuracy) and 12; better than 0.01 deg from 1950 to
/// 2050.
Sun sun_on_earth(double unix_seconds, double lon, double lat);

/// Computes the sun at a position of a map on Earth, azimuth from grid north. x, y are in the units of the
/// CRS. Throws Error{input} for a map on another body or on none.
Sun sun_on_map(double unix_seconds, const Crs& crs, double x, double y);

/// Returns seconds since 1970-01-01 UTC of an ISO 8601 time with Z or an offset, "2019-04-11T11:01:21+08:00".
/// `std::nullopt` for other text and for a time without offset, since local time is not UTC.
std::optional<double> utc_seconds(std::string_view text);

/// Returns the time as "2019-04-11T03:01:21Z".
std::string utc_text(double unix_seconds);
/// Returns the time as "2019-04-11T03:01:21.250Z", without a fraction if it is whole.
std::string precise_utc_text(double unix_seconds);

}  // namespace waymark::importers
