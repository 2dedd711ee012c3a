// SPDX-License-Identifier: Apache-2.0
#include "workflows/simulation/write_forest.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "core/atomic_file.hpp"
#include "exporters/las_file.hpp"
#include "exporters/raster/raster_file.hpp"
#include "testbed/forest/forest_scan.hpp"

namespace waymark::workflows {
namespace {

using Json = nlohmann::ordered_json;

// Truth tables as CSV; coordinates in units of the CRS (`unit` metres each), everything else in metres.
// - `trees`: type,x,y,z,height,diameter,crown_diameter,crown_base,species,stand,exposed, as read by
//   `waymark evaluate landmarks`. `exposed`: fraction of the crown that no other overtops.
// - `understory`: trees below 7 cm DBH, same columns, ignored in evaluation.
struct ForestTruth {
  std::string trees, understory;
};

ForestTruth forest_truth(const testbed::ForestModel& law, const testbed::SyntheticForest& forest,
                         const std::vector<double>& exposed, double unit) {
  ForestTruth truth;
  truth.trees = truth.understory =
      "type,x,y,z,height,diameter,crown_diameter,crown_base,species,stand,exposed\n";
  for (std::size_t i = 0; i < forest.trees.size(); ++i) {
    const testbed::StandingTree& t = forest.trees[i];
    const int stand = testbed::stand_index_at(forest.stands, t.foot.head<2>());
    (t.dbh >= testbed::kMinDbh ? truth.trees : truth.understory) +=
        fmt::format("tree,{:.3f},{:.3f},{:.3f},{:.2f},{:.4f},{:.2f},{:.2f},{},{},{:.2f}\n", t.foot.x() / unit,
                    t.foot.y() / unit, t.foot.z(), t.height, t.dbh, t.crown_diameter, t.crown_base,
                    law.species().at(static_cast<std::size_t>(t.species)).name,
                    stand < 0 ? "" : forest.stands[static_cast<std::size_t>(stand)].name, exposed.at(i));
  }
  return truth;
}

// Returns the stands as GeoJSON polygons with the columns stand and density (nominal). The CRS is named as
// in older GeoJSON; a local CRS is omitted.
std::string stands_geojson(const testbed::SyntheticForest& forest, const Crs& crs, double unit) {
  Json file{{"type", "FeatureCollection"}, {"name", "stands"}};
  if (!crs.code().empty())
    file["crs"] = {
        {"type", "name"},
        {"properties", {{"name", fmt::format("urn:ogc:def:crs:{}::{}", crs.authority(), crs.code())}}}};
  Json& features = file["features"] = Json::array();
  for (const testbed::SyntheticStand& stand : forest.stands) {
    Json ring = Json::array();
    for (std::size_t i = 0; i <= stand.outline.size(); ++i) {
      const Eigen::Vector2d corner = stand.outline[i % stand.outline.size()] / unit;
      ring.push_back({corner.x(), corner.y()});
    }
    Json feature{{"type", "Feature"}, {"properties", {{"stand", stand.name}, {"density", stand.density}}}};
    feature["geometry"] = {{"type", "Polygon"}, {"coordinates", Json::array({ring})}};
    features.push_back(std::move(feature));
  }
  return file.dump(1) + "\n";
}

// Returns the job that maps the trees of chm.tif in the same folder.
std::string forest_job(const std::string& name, const testbed::ForestModel& law, const std::string& crs) {
  Json canopy{{"stage", "load_canopy"}, {"chm", {"chm.tif"}}};
  if (crs == "local") canopy["crs"] = "local";
  const char* preset = law.conifers > 0.8 ? "conifer" : law.conifers < 0.2 ? "broadleaf" : "mixed";
  Json stages = Json::array();
  stages.push_back(canopy);
  stages.push_back({{"stage", "trees_from_canopy"}, {"preset", preset}});
  stages.push_back({{"stage", "trees_of_survey"}});
  return Json{{"name", name}, {"stages", stages}}.dump(2) + "\n";
}

}  // namespace

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
  const ForestTruth truth =
      forest_truth(law, forest, testbed::visible_crown_fraction(law, forest, seed), unit);
  write_file(folder / "truth/landmarks.csv", truth.trees);
  write_file(folder / "truth/understory.csv", truth.understory);
  write_file(folder / "stands.geojson", stands_geojson(forest, crs, unit));
  write_file(folder / "job.json", forest_job(scenario.name, law, scenario.crs));
  std::string summary = fmt::format("{:.0f} x {:.0f} m of forest, {} stands, {} trees, {} laser returns",
                                    law.width, law.height, law.stands, forest.trees.size(), returns);
  return {std::move(forest.trees), std::move(summary)};
}

}  // namespace waymark::workflows
