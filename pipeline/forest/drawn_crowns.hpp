// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <span>
#include <vector>
#include "core/observation.hpp"
#include "pipeline/forest/crown_table.hpp"
namespace waymark::pipeline {

/// Crown tables of tiles, which are read where they are needed.
class DrawnCrowns {
 public:
  using Reader = std::function<std::shared_ptr<const CrownTable>()>;

  /// Reads each table once, for its extent.
  explicit DrawnCrowns(std::vector<Reader> tables);

  /// Returns the tables that may have crowns of these observations.
  std::vector<CrownTable> near(std::span<const Observation> observations) const;

 private:
  std::vector<Reader> tables_;
  std::vector<Eigen::AlignedBox2d> extents_;  ///< of the tops of each table
};

}  // namespace waymark::pipeline
