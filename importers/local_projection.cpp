// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "importers/images/image.hpp"

namespace waymark::importers {

std::string local_projection(const Crs& crs, double lon, double lat) {
  const Body& body = crs.body();
  const double wrapped = std::remainder(lon, 360.0);
  const std::string shape =
      body == earth() ? "+datum=WGS84"
                      : fmt::format("+a={} +b={:.10g}", body.equatorial_radius, body.polar_radius());
  return fmt::format("+proj=tmerc +lat_0={:.4f} +lon_0={:.4f} {} +units=m +no_defs", lat, wrapped, shape);
}

}  // namespace waymark::importers
