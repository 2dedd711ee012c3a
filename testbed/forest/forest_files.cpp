// SPDX-License-Identifier: Apache-2.0
#include "testbed/forest/forest_files.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace waymark::testbed {

using Json = nlohmann::ordered_json;

ForestTruth forest_truth(const ForestModel& law, const SyntheticForest& forest,
                         const std::vector<double>& exposed, double unit) {
  ForestTruth truth;
  truth.trees = truth.understory =
      "type,x,y,z,height,diameter,crown_diameter,crown_base,species,stand,exposed\n";
  for (std::size_t i = 0; i < forest.trees.size(); ++i) {
    const StandingTree& t = forest.trees[i];
    const int stand = stand_index_at(forest.stands, t.foot.head<2>());
    (t.dbh >= kMinDbh ? truth.trees : truth.understory) +=
        fmt::format("tree,{:.3f},{:.3f},{:.3f},{:.2f},{:.4f},{:.2f},{:.2f},{},{},{:.2f}\n", t.foot.x() / unit,
                    t.foot.y() / unit, t.foot.z(), t.height, t.dbh, t.crown_diameter, t.crown_base,
                    law.species().at(static_cast<std::size_t>(t.species)).name,
                    stand < 0 ? "" : forest.stands[static_cast<std::size_t>(stand)].name, exposed.at(i));
  }
  return truth;
}

std::string stands_geojson(const SyntheticForest& forest, const Crs& crs, double unit) {
  Json file{{"type", "FeatureCollection"}, {"name", "stands"}};
  if (!crs.code().empty())
    file["crs"] = {
        {"type", "name"},
        {"properties", {{"name", fmt::format("urn:ogc:def:crs:{}::{}", crs.authority(), crs.code())}}}};
  Json& features = file["features"] = Json::array();
  for (const SyntheticStand& stand : forest.stands) {
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

std::string forest_job(const std::string& name, const ForestModel& law, const std::string& crs) {
  Json canopy{{"stage", "load_canopy"}, {"chm", {"chm.tif"}}};
  if (crs == "local") canopy["crs"] = "local";
  const char* preset = law.conifers > 0.8 ? "conifer" : law.conifers < 0.2 ? "broadleaf" : "mixed";
  Json stages = Json::array();
  stages.push_back(canopy);
  stages.push_back({{"stage", "trees_from_canopy"}, {"preset", preset}});
  stages.push_back({{"stage", "trees_of_survey"}});
  return Json{{"name", name}, {"stages", stages}}.dump(2) + "\n";
}

}  // namespace waymark::testbed
