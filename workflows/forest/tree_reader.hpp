// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>
#include "geodb/map_store.hpp"
#include "pipeline/forest/stand_cover.hpp"
namespace waymark::workflows {

/// Trees of a map, metres, in the order of its rows; uids[i] names trees[i].
struct MapTrees {
  std::vector<std::string> uids;
  std::vector<pipeline::StandTree> trees;
  std::vector<pipeline::StandCrown> crowns;  ///< crowns[i] of trees[i]; diameter 0 if unknown
  double unit = 1;                           ///< metres per unit of the map's CRS
  bool from_air = false;                     ///< found in a canopy model: suppressed trees are missing
};

/// Indices of a tree's features among those of its type.
struct TreeFeatures {
  std::size_t height = 0, diameter = 0, crown = 0;
};

/// Returns how far from its stem a tree may matter, metres: by position error or by an irregular crown.
double influence_radius(const pipeline::StandTree& tree, const pipeline::StandCrown& crown);

/// Reads a map's trees, all or those of a box, with errors from their observations and outlines of layer
/// `crown`, or circles without it. A tree takes 1 kB.
class TreeReader {
 public:
  /// Reads every tree once; `map` must outlive the reader. Throws Error{input} if the map has no type
  /// with a canopy and the features of a tree, or its CRS is in degrees.
  explicit TreeReader(const geodb::MapStore& map);

  double unit() const { return unit_; }  ///< metres per unit of the map's CRS
  std::int64_t count() const { return count_; }
  const Eigen::AlignedBox2d& extent() const { return extent_; }          ///< of the stems, metres
  double max_influence_radius() const { return max_influence_radius_; }  ///< of all trees
  std::vector<Eigen::Vector2d> positions() const;                        ///< metres

  MapTrees all() const;
  /// Reads the trees that stand in the box (metres), with outlines within max_influence_radius() of it.
  MapTrees read(const Eigen::AlignedBox2d& box) const;

 private:
  void add(MapTrees& to, Landmark&& landmark) const;
  MapTrees none() const {
    return {.uids = {}, .trees = {}, .crowns = {}, .unit = unit_, .from_air = from_air_};
  }

  const geodb::MapStore* map_;
  std::string type_;  ///< of the trees
  double unit_ = 1;
  TreeFeatures features_;
  std::int64_t count_ = 0;
  Eigen::AlignedBox2d extent_;
  double max_influence_radius_ = 0;
  bool from_air_ = false;
};

}  // namespace waymark::workflows
