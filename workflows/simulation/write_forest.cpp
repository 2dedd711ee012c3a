// SPDX-License-Identifier: Apache-2.0
#include "workflows/simulation/write_forest.hpp"

#include <fmt/format.h>

#include <optional>

#include "exporters/las_file.hpp"
#include "exporters/raster/raster_file.hpp"
#include "exporters/staging_folder.hpp"
#include "testbed/forest/forest_files.hpp"

namespace waymark {

Scene make_forest_terrain(const Scenario& scenario) {
  SiteModel ground = scenario.ground;
  constexpr double kMargin = 30;  // m; a machine may leave the forest
  ground.width = scenario.forest.width + 2 * kMargin;
  ground.height = scenario.forest.height + 2 * kMargin;
  ground.craters.density = 0;
  ground.rocks.k = 0;
  ground.dunes.cover = 0;
  ground.outcrops.cover = 0;
  return make_scene(ground, static_cast<std::uint64_t>(scenario.seed));
}

WrittenForest write_forest(const std::filesystem::path& folder, const Scenario& scenario, const Scene& scene,
                           const Crs& crs) {
  const ForestModel& law = scenario.forest;
  const double east = scenario.ground.east, north = scenario.ground.north;
  const double unit = crs.kind() == CrsKind::local ? 1 : crs.metres_per_unit();
  const auto seed = static_cast<std::uint64_t>(scenario.seed);
  SyntheticForest forest = plant_forest(law, scene.terrain, east, north, seed);

  std::optional<LasFile> cloud;
  if (law.points)
    cloud.emplace(folder / "points.las", crs, (east - law.width / 2) / unit, (north - law.height / 2) / unit);
  std::int64_t returns = 0;
  const ForestRasters rasters =
      scan_forest(law, forest, scene.terrain, east, north, seed, [&](std::span<const LaserReturn> row) {
        returns += static_cast<std::int64_t>(row.size());
        if (!cloud) return;
        for (const LaserReturn& r : row)
          cloud->add({r.x / unit, r.y / unit, r.z, r.intensity, r.number, r.of, r.kind, r.time});
      });
  if (cloud) cloud->close();
  const Georeference where{crs, rasters.x0 / unit, rasters.y0 / unit, rasters.cell / unit,
                           -rasters.cell / unit};
  write_raster(folder / "dtm.tif", rasters.dtm, where);
  write_raster(folder / "dsm.tif", rasters.dsm, where);
  write_raster(folder / "chm.tif", rasters.chm, where);
  const ForestTruth truth = forest_truth(law, forest, visible_crown_fraction(law, forest, seed), unit);
  write_file(folder / "truth/landmarks.csv", truth.trees);
  write_file(folder / "truth/understory.csv", truth.understory);
  write_file(folder / "stands.geojson", stands_geojson(forest, crs, unit));
  write_file(folder / "job.json", forest_job(scenario.name, law, scenario.crs));
  std::string summary = fmt::format("{:.0f} x {:.0f} m of forest, {} stands, {} trees, {} laser returns",
                                    law.width, law.height, law.stands, forest.trees.size(), returns);
  return {std::move(forest.trees), std::move(summary)};
}

}  // namespace waymark
