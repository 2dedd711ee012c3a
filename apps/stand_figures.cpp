// SPDX-License-Identifier: Apache-2.0
#include "apps/stand_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_map>

#include "core/error.hpp"
#include "pipeline/forest/air_recall.hpp"

namespace waymark {
namespace {

double known(const Landmark& landmark, std::size_t feature) {
  const FeatureValue& value = landmark.features[feature];
  return value.known() ? value.value : StandTree::kUnknown;
}

double deviation(const Landmark& landmark, std::size_t feature) {
  const FeatureValue& value = landmark.features[feature];
  return value.known() && value.variance > 0 ? std::sqrt(value.variance) : 0;
}

/// What the observations of a tree say about their errors; the map itself keeps the spread among them only.
struct ObservedErrors {
  double height = 0, diameter = 0, crown = 0;  ///< sums of variances
  int count = 0;
};

/// By the uid of a tree its place among all.
using Places = std::unordered_map<std::string_view, std::size_t>;

std::vector<ObservedErrors> observed_errors(const MapStore& map, const Places& places, std::size_t height,
                                            std::size_t diameter, std::size_t crown) {
  std::vector<ObservedErrors> of(places.size());
  map.visit_observations([&](Observation&& seen) {
    if (!seen.rejected.empty() || map.types()[seen.type].name != "tree") return;
    const auto place = places.find(seen.landmark_uid);
    if (place == places.end()) return;
    const auto variance = [&](std::size_t feature) {
      const double v = seen.features[feature].variance;
      return v > 0 ? v : 0;
    };
    ObservedErrors& errors = of[place->second];
    errors.height += variance(height);
    errors.diameter += variance(diameter);
    errors.crown += variance(crown);
    ++errors.count;
  });
  return of;
}

double place_deviation(const Landmark& landmark) {
  const double variance = (landmark.covariance(0, 0) + landmark.covariance(1, 1)) / 2;
  return variance > 0 ? std::sqrt(variance) : 0;
}

double metres_per_unit(const MapStore& map) {
  if (map.crs().kind() == CrsKind::geographic)
    throw Error(
        ErrorCode::input,
        fmt::format("the map is in degrees ({}): stands have no area in them", map.crs().id()),
        map.path().string(),
        "make it in a projected CRS: waymark export MAP.gpkg trees.csv --crs EPSG:..., then waymark import");
  return map.crs().kind() == CrsKind::local ? 1 : map.crs().metres_per_unit();
}

/// Outlines of layer `crown`; the first where several surveys drew one. Whether there is any.
bool read_outlines(const MapStore& map, const Places& places, MapTrees& all) {
  if (std::ranges::count(shape_layers(map.path()), "crown") == 0) return false;
  bool any = false;
  std::size_t uid = 0;
  visit_shape_layer(
      map.path(), "crown",
      [&](const ShapeLayer& layer) {
        uid = static_cast<std::size_t>(std::ranges::find(layer.columns, "uid", &AttributeSpec::name) -
                                       layer.columns.begin());
      },
      [&](Shape&& row) {
        any = true;
        if (uid >= row.values.size() || row.parts.empty()) return;
        const auto* name = std::get_if<std::string>(&row.values[uid]);
        const auto place = name ? places.find(*name) : places.end();
        if (place == places.end()) return;
        std::vector<Eigen::Vector2d>& ring = all.crowns[place->second].ring;
        if (!ring.empty()) return;
        ring = row.parts[0].outer;
        ring.shrink_to_fit();
        for (auto& corner : ring) corner *= all.unit;
      });
  return any;
}

/// Mean crown diameter over height of the trees that are tall in their stand: those whose crowns hide others.
/// NaN where none is known.
double crown_share(std::span<const StandTree> trees, std::span<const StandCrown> crowns, double dominant) {
  constexpr double kTall = 0.8;
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < trees.size(); ++i)
    if (trees[i].height > kTall * dominant && crowns[i].diameter > 0)
      sum += crowns[i].diameter / trees[i].height, ++count;
  return sum / count;
}

const Allometry& diameters_for(const StandTables& tables, const std::string& species) {
  const auto& table = tables.diameters.empty() ? built_in_allometry() : tables.diameters;
  if (const Allometry* row = allometry_of(table, species)) return *row;
  throw Error(ErrorCode::input,
              fmt::format("the allometry has no row for species '{}' and none for all", species),
              tables.diameters_file, "add a row with species all");
}

const VolumeRow& volumes_for(const StandTables& tables, const std::string& species) {
  if (const VolumeRow* row = volume_of(tables.volumes, species)) return *row;
  throw Error(ErrorCode::input,
              fmt::format("the volume table has no row for species '{}' and none for all", species),
              tables.volumes_file, "add a row with species all");
}

}  // namespace

MapTrees trees_of(const MapStore& map) {
  MapTrees all;
  all.unit = metres_per_unit(map);
  const LandmarkType* type = map.types().find("tree");
  if (type == nullptr)
    throw Error(
        ErrorCode::input, "the map has no trees", map.path().string(),
        "`waymark trees` makes a map of trees from a canopy model, `waymark import --type tree` one of a "
        "list");
  const std::size_t height = feature_index(*type, "height"), diameter = feature_index(*type, "diameter"),
                    crown = feature_index(*type, "crown_diameter");
  map.visit("tree", [&](Landmark&& landmark) {
    StandTree tree;
    tree.place = landmark.position.xyz.head<2>() * all.unit;
    tree.place_sd = place_deviation(landmark);
    tree.height = known(landmark, height);
    tree.height_sd = deviation(landmark, height);
    tree.diameter = known(landmark, diameter);
    tree.diameter_sd = deviation(landmark, diameter);
    tree.confidence = landmark.confidence;
    all.crowns.push_back({.place = tree.place,
                          .diameter = landmark.features[crown].known() ? known(landmark, crown) : 0,
                          .diameter_sd = deviation(landmark, crown),
                          .ring = {},
                          .confidence = landmark.confidence});
    all.trees.push_back(tree);
    all.uids.push_back(std::move(landmark.uid));
  });
  Places places;
  places.reserve(all.uids.size());
  for (std::size_t i = 0; i < all.uids.size(); ++i) places.emplace(all.uids[i], i);
  const std::vector<ObservedErrors> evidence = observed_errors(map, places, height, diameter, crown);
  for (std::size_t i = 0; i < all.trees.size(); ++i) {
    // Heights of several flights average. A tree that is thicker than its height tells stays so in each.
    const ObservedErrors& errors = evidence[i];
    if (errors.count == 0) continue;
    StandTree& tree = all.trees[i];
    double& crown_sd = all.crowns[i].diameter_sd;
    tree.height_sd =
        std::max(tree.height_sd / std::sqrt(errors.count), std::sqrt(errors.height) / errors.count);
    tree.diameter_sd = std::max(tree.diameter_sd, std::sqrt(errors.diameter / errors.count));
    crown_sd = std::max(crown_sd, std::sqrt(errors.crown / errors.count));
  }
  all.from_air = read_outlines(map, places, all);
  return all;
}

StandResult figures_of(const MapTrees& map, NamedStand stand, const StandTables& tables,
                       const InventoryOptions& options) {
  StandResult result;
  result.stand = std::move(stand);
  const Allometry& diameters = diameters_for(tables, result.stand.species);
  const VolumeRow& volumes = volumes_for(tables, result.stand.species);
  const Eigen::AlignedBox2d box = bounds(result.stand.ground);
  for (std::size_t i = 0; i < map.trees.size(); ++i) {
    // As far as a place may err, or a crown that is no circle may reach.
    const double reach = std::max({5 * map.trees[i].place_sd, 2 * map.crowns[i].diameter, 5.0});
    if (box.squaredExteriorDistance(map.trees[i].place) > reach * reach) continue;
    StandTree tree = map.trees[i];
    if (!tables.diameters.empty() || std::isnan(tree.diameter)) {
      const auto stem = stem_diameter(diameters, tree.height, tree.height_sd, map.crowns[i].diameter,
                                      map.crowns[i].diameter_sd);
      tree.diameter = stem ? stem->metres : StandTree::kUnknown;
      tree.diameter_sd = stem ? stem->sd : 0;
      const double bias = diameters.held_out_bias / 100;
      tree.diameter_bias = stem && !std::isnan(bias) ? std::abs(bias) : 0;
    }
    tree.volume = stem_volume(volumes, tree.diameter, tree.height);
    tree.mass = tree.volume * volumes.mass_per_volume;
    result.near.push_back(i);
    result.trees.push_back(tree);
  }
  const bool all_near = result.near.size() == map.trees.size();  // their outlines are not copied
  std::vector<StandCrown> crowns;
  for (std::size_t i = 0; !all_near && i < result.near.size(); ++i)
    crowns.push_back(map.crowns[result.near[i]]);
  const std::span<const StandCrown> shades = all_near ? map.crowns : crowns;
  InventoryOptions all = options;
  all.form_factor_error = volumes.form_factor_sd / volumes.form_factor;
  result.figures = result.complete = inventory(result.trees, result.stand.ground, all);
  if (map.from_air && all.recall.empty()) {
    const double dominant = result.figures.dominant_height.value;
    all.recall = air_recall(dominant, crown_share(result.trees, shades, dominant));
    all.recall_errs_alike = true;
    result.complete = inventory(result.trees, result.stand.ground, all);
  }
  result.members = trees_in(result.trees, result.stand.ground);
  result.cover = cover(shades, result.stand.ground);
  return result;
}

}  // namespace waymark
