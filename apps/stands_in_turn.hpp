// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>
#include "apps/tree_reader.hpp"
#include "geodb/shape_layer.hpp"
#include "pipeline/forest/stand_polygon.hpp"
namespace waymark {

/// A stand to be counted: ground in metres.
struct NamedStand {
  std::string name, species;
  StandPolygon ground;
  std::vector<ShapePart> outline;  ///< map CRS
};

/// Stands one by one, each with the trees near it, so that of a map larger than memory few trees are held:
/// those of stands that follow each other and together are about as large as `trees_at_once` trees need, or
/// of one stand that is larger.
class StandsInTurn {
 public:
  using Take = std::function<void(const MapTrees& trees, const NamedStand& stand)>;

  /// `reader` must outlive it.
  StandsInTurn(const TreeReader& reader, std::vector<NamedStand> stands, std::int64_t trees_at_once);

  /// In their order. `trees` holds those within reach of the stand, and others.
  void visit(const Take& take) const;

 private:
  struct Group {
    std::size_t begin = 0, end = 0;  ///< stands
    Eigen::AlignedBox2d box;         ///< metres, with the reach of the trees
  };
  void divide(std::int64_t trees_at_once);
  MapTrees trees_of(const Group& group) const;

  const TreeReader* reader_;
  std::vector<NamedStand> stands_;
  std::vector<Group> groups_;
  mutable std::optional<MapTrees> kept_;  ///< where there is one group
};

}  // namespace waymark
