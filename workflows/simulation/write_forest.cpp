// SPDX-License-Identifier: Apache-2.0
#include "workflows/simulation/write_forest.hpp"

#include <fmt/format.h>

#include <optional>

#include "exporters/las_file.hpp"
#include "exporters/raster/raster_file.hpp"
#include "exporters/staging_folder.hpp"
#include "testbed/forest/forest_files.hpp"

namespace waymark::workflows {

testbed::Scene make_forest_terrain(const testbed::Scenario& scenario) {
  testbed::SiteModel ground = scenario.ground;
  constexpr double kMargin = 30;  // m; a machine may leave the forest
  ground.width = scenario.forest.width + 2 * kMargin;
  ground.height = scenario.forest.height + 2 * kMargin;
  ground.craters.density = 0;
  ground.rocks.k = 0;
  ground.dunes.cover = 0;
  ground.outcrops.cover = 0;
  return testbed::make_scene(ground, static_cast<std::uint64_t>(scenario.seed));
}

WrittenForest write_forest(const std::filesystem::path& folder, const testbed::Scenario& scenario,
                           const testbed::Scene& scene, const Crs& crs) {
  const testbed::ForestModel& law = scenario.forest;
  const double east = scenario.ground.east, north = scenario.ground.north;
  const double unit = crs.kind() == CrsKind::local ? 1 : crs.metres_per_unit();
  const auto seed = static_cast<std::uint64_t>(scenario.seed);
  testbed::SyntheticForest forest = testbed::plant_forest(law, scene.terrain, east, north, seed);

  std::optional<exporters::LasFile> cloud;
  if (law.points)
    cloud.emplace(folder / "points.las", crs, (east - law.width / 2) / unit, (north - law.height / 2) / unit);
  std::int64_t returns = 0;
  const testbed::ForestRasters rasters = testbed::scan_forest(
      law, forest, scene.terrain, east, north, seed, [&](std::span<const testbed::LaserReturn> row) {
        returns += static_cast<std::int64_t>(row.size());
        if (!cloud) return;
        for (const testbed::LaserReturn& r : row)
          cloud->add({r.x / unit, r.y / unit, r.z, r.intensity, r.number, r.of, r.kind, r.time});
      });
  if (cloud) cloud->close();
  const Georeference where{crs, rasters.x0 / unit, rasters.y0 / unit, rasters.cell / unit,
                           -rasters.cell / unit};
  exporters::write_raster(folder / "dtm.tif", rasters.dtm, where);
  exporters::write_raster(folder / "dsm.tif", rasters.dsm, where);
  exporters::write_raster(folder / "chm.tif", rasters.chm, where);
  const testbed::ForestTruth truth =
      testbed::forest_truth(law, forest, testbed::visible_crown_fraction(law, forest, seed), unit);
  exporters::write_file(folder / "truth/landmarks.csv", truth.trees);
  exporters::write_file(folder / "truth/understory.csv", truth.understory);
  exporters::write_file(folder / "stands.geojson", testbed::stands_geojson(forest, crs, unit));
  exporters::write_file(folder / "job.json", testbed::forest_job(scenario.name, law, scenario.crs));
  std::string summary = fmt::format("{:.0f} x {:.0f} m of forest, {} stands, {} trees, {} laser returns",
                                    law.width, law.height, law.stands, forest.trees.size(), returns);
  return {std::move(forest.trees), std::move(summary)};
}

}  // namespace waymark::workflows
