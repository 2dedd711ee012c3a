// SPDX-License-Identifier: Apache-2.0
#include "workflows/reconstruction/photo_altimeter.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "importers/cameras/altimeter_table.hpp"
#include "workflows/reconstruction/photo_control.hpp"

namespace waymark::workflows {

PhotoAltimeter photo_altimeter(const std::string& table, const Photos& photos) {
  const std::vector<importers::AltimeterReading> readings = importers::read_altimeter_table(table);
  PhotoAltimeter out;
  std::string first_absent;
  std::size_t absent = 0;
  for (const importers::AltimeterReading& reading : readings) {
    const auto image = picture_named(photos, reading.image);
    if (!image) {
      if (absent++ == 0) first_absent = reading.image;
      continue;
    }
    if (reading.above_ground)
      out.above_ground.push_back({.image = *image,
                                  .height = *reading.above_ground,
                                  .sd = reading.sd.value_or(std::max(0.1, 0.01 * *reading.above_ground))});
    if (reading.height)
      out.heights.push_back(
          {.image = *image, .height = *reading.height, .sd = reading.sd.value_or(1), .biased = false});
  }
  if (absent == readings.size())
    throw Error(ErrorCode::input,
                fmt::format("none of its {} readings is of one of the {} images; the first names '{}'",
                            readings.size(), photos.photos.size(), first_absent),
                table,
                fmt::format("readings name images by their file names, e.g. {}", photos.photos[0].name));
  if (absent > 0)
    out.warnings.push_back(
        fmt::format("{} of {} altimeter readings are of images that are not there, e.g. {}", absent,
                    readings.size(), first_absent));
  return out;
}

}  // namespace waymark::workflows
