// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>
#include "geodb/map_store.hpp"
#include "pipeline/forest/stand_cover.hpp"
namespace waymark {

/// Trees of a map, metres, in the order of its rows; uids[i] names trees[i].
struct MapTrees {
  std::vector<std::string> uids;
  std::vector<StandTree> trees;
  std::vector<StandCrown> crowns;  ///< crowns[i] of trees[i]; no diameter where none is known
  double unit = 1;                 ///< metres per unit of the map's CRS
  bool from_air = false;           ///< found in a canopy model: those under others are missing
};

/// Where a tree's features are among those of its type.
struct TreeFeatures {
  std::size_t height = 0, diameter = 0, crown = 0;
};

/// How far from its stem a tree may matter, metres: as its place may err, or a crown that is no circle reach.
double reach_of(const StandTree& tree, const StandCrown& crown);

/// Reads a map's trees, all or those of a box, with the errors their observations tell and the outlines of
/// layer `crown` where the map has it, else circles. A tree takes 1 kB.
class TreeReader {
 public:
  /// Looks at every tree once; `map` must outlive it. Throws Error{input} where the map has no type `tree`,
  /// or its CRS is in degrees.
  explicit TreeReader(const MapStore& map);

  double unit() const { return unit_; }  ///< metres per unit of the map's CRS
  std::int64_t count() const { return count_; }
  const Eigen::AlignedBox2d& extent() const { return extent_; }  ///< of the stems, metres
  double widest_reach() const { return widest_reach_; }          ///< of all trees
  std::vector<Eigen::Vector2d> places() const;                   ///< metres

  MapTrees all() const;
  /// Those that stand in the box (metres). Outlines are sought within widest_reach() of it.
  MapTrees in(const Eigen::AlignedBox2d& box) const;

 private:
  void add(MapTrees& to, Landmark&& landmark) const;
  MapTrees none() const {
    return {.uids = {}, .trees = {}, .crowns = {}, .unit = unit_, .from_air = from_air_};
  }

  const MapStore* map_;
  double unit_ = 1;
  TreeFeatures features_;
  std::int64_t count_ = 0;
  Eigen::AlignedBox2d extent_;
  double widest_reach_ = 0;
  bool from_air_ = false;
};

}  // namespace waymark
