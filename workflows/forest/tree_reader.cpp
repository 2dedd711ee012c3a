// SPDX-License-Identifier: Apache-2.0
#include "workflows/forest/tree_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <unordered_map>

#include "core/error.hpp"
#include "geodb/shape_layer.hpp"

namespace waymark::workflows {
namespace {

double known(const FeatureValue& value) {
  return value.known() ? value.value : pipeline::StandTree::kUnknown;
}

double deviation(const FeatureValue& value) {
  return value.known() && value.variance > 0 ? std::sqrt(value.variance) : 0;
}

double position_sd(const Landmark& landmark) {
  const double variance = (landmark.covariance(0, 0) + landmark.covariance(1, 1)) / 2;
  return variance > 0 ? std::sqrt(variance) : 0;
}

double metres_per_unit(const geodb::MapStore& map) {
  if (map.crs().kind() == CrsKind::geographic)
    throw Error(
        ErrorCode::input,
        fmt::format("the map is in degrees ({}): stands have no area in them", map.crs().id()),
        map.path().string(),
        "make it in a projected CRS: waymark export MAP.gpkg trees.csv --crs EPSG:..., then waymark import");
  return map.crs().kind() == CrsKind::local ? 1 : map.crs().metres_per_unit();
}

/// Index of each tree by its uid.
using TreeIndex = std::unordered_map<std::string_view, std::size_t>;

TreeIndex index_trees(const MapTrees& trees) {
  TreeIndex places;
  places.reserve(trees.uids.size());
  for (std::size_t i = 0; i < trees.uids.size(); ++i) places.emplace(trees.uids[i], i);
  return places;
}

/// Errors of trees by their observations; the map itself keeps only the spread among them.
class ErrorSums {
 public:
  ErrorSums(const TreeIndex& places, const TreeFeatures& features)
      : places_(&places), of_(features), sums_(places.size()) {}

  void add(const Observation& seen) {
    const auto place = places_->find(seen.landmark_uid);
    if (place == places_->end()) return;
    const auto variance = [&](std::size_t feature) { return std::max(seen.features[feature].variance, 0.0); };
    Sum& sum = sums_[place->second];
    sum.height += variance(of_.height);
    sum.diameter += variance(of_.diameter);
    sum.crown += variance(of_.crown);
    ++sum.count;
  }

  /// Heights of several flights average. Errors of diameters repeat in each flight and do not.
  void apply(MapTrees& trees) const {
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      const Sum& sum = sums_[i];
      if (sum.count == 0) continue;
      pipeline::StandTree& tree = trees.trees[i];
      double& crown_sd = trees.crowns[i].diameter_sd;
      tree.height_sd = std::max(tree.height_sd / std::sqrt(sum.count), std::sqrt(sum.height) / sum.count);
      tree.diameter_sd = std::max(tree.diameter_sd, std::sqrt(sum.diameter / sum.count));
      crown_sd = std::max(crown_sd, std::sqrt(sum.crown / sum.count));
    }
  }

 private:
  struct Sum {
    double height = 0, diameter = 0, crown = 0;  ///< of variances
    int count = 0;
  };
  const TreeIndex* places_;
  TreeFeatures of_;
  std::vector<Sum> sums_;  ///< by tree
};

/// Outlines of layer `crown`; the first where several surveys drew one.
void read_outlines(const geodb::MapStore& map, const TreeIndex& places,
                   const std::optional<geodb::MapQuery::Box>& window, MapTrees& trees) {
  std::size_t uid = 0;
  geodb::visit_shape_layer(
      map.path(), "crown",
      [&](const geodb::ShapeLayer& layer) {
        uid = static_cast<std::size_t>(std::ranges::find(layer.columns, "uid", &AttributeSpec::name) -
                                       layer.columns.begin());
      },
      [&](geodb::Shape&& row) {
        if (uid >= row.values.size() || row.parts.empty()) return;
        const auto* name = std::get_if<std::string>(&row.values[uid]);
        const auto place = name ? places.find(*name) : places.end();
        if (place == places.end()) return;
        std::vector<Eigen::Vector2d>& ring = trees.crowns[place->second].ring;
        if (!ring.empty()) return;
        ring = row.parts[0].outer;
        ring.shrink_to_fit();
        for (auto& corner : ring) corner *= trees.unit;
      },
      window);
}

// Returns the first type with a canopy and the features of an inventory; null if there is none.
const LandmarkType* inventoried_type(const TypeRegistry& types) {
  const auto found = std::ranges::find_if(types, [](const LandmarkType& type) {
    return type.evidence == EvidenceModel::canopy &&
           std::ranges::all_of(std::array{"height", "diameter", "crown_diameter"}, [&](const char* name) {
             return std::ranges::find(type.features, name, &FeatureSpec::name) != type.features.end();
           });
  });
  return found == types.end() ? nullptr : &*found;
}

}  // namespace

double influence_radius(const pipeline::StandTree& tree, const pipeline::StandCrown& crown) {
  return std::max({5 * tree.position_sd, 2 * crown.diameter, 5.0});
}

TreeReader::TreeReader(const geodb::MapStore& map) : map_(&map), unit_(metres_per_unit(map)) {
  const LandmarkType* type = inventoried_type(map.types());
  if (type == nullptr)
    throw Error(
        ErrorCode::input, "the map has no trees", map.path().string(),
        "`waymark trees` makes a map of trees from a canopy model, `waymark import --type tree` one of a "
        "list");
  type_ = type->name;
  features_ = {.height = feature_index(*type, "height"),
               .diameter = feature_index(*type, "diameter"),
               .crown = feature_index(*type, "crown_diameter")};
  from_air_ = geodb::count_shapes(map.path(), "crown") > 0;
  map.visit(type_, [&](Landmark&& landmark) {
    MapTrees one = none();
    add(one, std::move(landmark));
    ++count_;
    extent_.extend(one.trees[0].position);
    max_influence_radius_ = std::max(max_influence_radius_, influence_radius(one.trees[0], one.crowns[0]));
  });
}

std::vector<Eigen::Vector2d> TreeReader::positions() const {
  std::vector<Eigen::Vector2d> positions;
  positions.reserve(static_cast<std::size_t>(count_));
  map_->visit(type_,
              [&](Landmark&& landmark) { positions.push_back(landmark.position.xyz.head<2>() * unit_); });
  return positions;
}

void TreeReader::add(MapTrees& to, Landmark&& landmark) const {
  const FeatureValue &height = landmark.features[features_.height],
                     &diameter = landmark.features[features_.diameter],
                     &crown = landmark.features[features_.crown];
  pipeline::StandTree tree;
  tree.position = landmark.position.xyz.head<2>() * unit_;
  tree.position_sd = position_sd(landmark);
  tree.height = known(height);
  tree.height_sd = deviation(height);
  tree.diameter = known(diameter);
  tree.diameter_sd = deviation(diameter);
  tree.confidence = landmark.confidence;
  to.crowns.push_back({.position = tree.position,
                       .diameter = crown.known() ? crown.value : 0,
                       .diameter_sd = deviation(crown),
                       .ring = {},
                       .confidence = landmark.confidence});
  to.trees.push_back(tree);
  to.uids.push_back(std::move(landmark.uid));
}

MapTrees TreeReader::all() const {
  MapTrees trees = none();
  map_->visit(type_, [&](Landmark&& landmark) { add(trees, std::move(landmark)); });
  const TreeIndex places = index_trees(trees);
  ErrorSums errors(places, features_);
  map_->visit_observations([&](Observation&& seen) {
    if (seen.rejected.empty() && map_->types()[seen.type].name == type_) errors.add(seen);
  });
  errors.apply(trees);
  if (from_air_) read_outlines(*map_, places, {}, trees);
  return trees;
}

MapTrees TreeReader::read(const Eigen::AlignedBox2d& box) const {
  MapTrees trees = none();
  if (box.isEmpty()) return trees;
  const auto window = [&](double margin) {
    const Eigen::Vector2d low = (box.min().array() - margin) / unit_,
                          high = (box.max().array() + margin) / unit_;
    return geodb::MapQuery::Box{low.x(), low.y(), high.x(), high.y()};
  };
  map_->visit(type_, window(0), [&](Landmark&& landmark) { add(trees, std::move(landmark)); });
  const TreeIndex places = index_trees(trees);
  ErrorSums errors(places, features_);
  map_->visit_observations(type_, window(0), [&](Observation&& seen) { errors.add(seen); });
  errors.apply(trees);
  if (from_air_) read_outlines(*map_, places, window(max_influence_radius_), trees);
  return trees;
}

}  // namespace waymark::workflows
