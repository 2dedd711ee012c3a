// SPDX-License-Identifier: Apache-2.0
#include "workflows/query/area_of_map.hpp"

#include <memory>

#include "geodb/map_store.hpp"
#include "importers/tables/area_of_interest.hpp"

namespace waymark::workflows {

MapArea area_of_map(const std::string& aoi, const std::filesystem::path& map) {
  const Crs crs = geodb::MapStore::open(map).crs();
  const auto area = std::make_shared<const importers::Area>(importers::read_area_of_interest(aoi, crs));
  MapArea found{[area](double x, double y) { return area->contains(x, y); }, {}};
  const Eigen::AlignedBox2d box = area->box();
  const bool in_one_turn =
      crs.kind() != CrsKind::geographic || (box.min().x() >= -180 && box.max().x() <= 180);
  if (in_one_turn) found.box = {box.min().x(), box.min().y(), box.max().x(), box.max().y()};
  return found;
}

}  // namespace waymark::workflows
