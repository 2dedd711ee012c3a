// SPDX-License-Identifier: Apache-2.0
#include "importers/cameras/altimeter_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "core/error.hpp"
#include "importers/tables/named_cells.hpp"
#include "importers/tables/table_number.hpp"

namespace waymark::importers {

std::vector<AltimeterReading> read_altimeter_table(const std::string& path) {
  NamedCells cells(path);
  const char* hint = "an altimeter table needs image, and above_ground or height in metres";
  const std::size_t image = cells.need("image", {"image", "name", "file"}, hint);
  const auto above = cells.find({"above_ground", "range", "altimeter"}), height = cells.find({"height", "z"});
  const auto sd = cells.find({"sd"});
  if (!above && !height) cells.need("above_ground", {}, hint);
  std::vector<AltimeterReading> all;
  std::set<std::string> known;
  while (cells.next()) {
    AltimeterReading reading{.image = cells.text(image)};
    if (!known.insert(reading.image).second)
      throw Error(ErrorCode::input, fmt::format("two rows are of the image '{}'", reading.image),
                  cells.location(), "give each image one row");
    const auto value = [&](std::optional<std::size_t> column) -> std::optional<double> {
      if (!column || is_missing(cells.text(*column))) return std::nullopt;
      return cells.number(*column, "metres; leave the cell empty if it is unknown");
    };
    reading.above_ground = value(above);
    reading.height = value(height);
    if (reading.above_ground && !(*reading.above_ground > 0))
      throw Error(ErrorCode::input,
                  fmt::format("the height above ground {} is not above 0", *reading.above_ground),
                  cells.location(), "leave the cell empty if it is unknown");
    if (sd && !is_missing(cells.text(*sd))) reading.sd = cells.deviation(sd, 0);
    all.push_back(std::move(reading));
  }
  if (all.empty()) throw Error(ErrorCode::input, "there are no readings", path, "add a row for each image");
  return all;
}

}  // namespace waymark::importers
