// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/drawn_crowns.hpp"

#include <utility>

namespace waymark::pipeline {

DrawnCrowns::DrawnCrowns(std::vector<Reader> tables) : tables_(std::move(tables)) {
  for (const Reader& read : tables_) {
    const auto table = read();
    Eigen::AlignedBox2d& extent = extents_.emplace_back();
    for (std::size_t row = 0; row < table->size(); ++row) extent.extend(table->top(row));
  }
}

std::vector<CrownTable> DrawnCrowns::near(std::span<const Observation> observations) const {
  Eigen::AlignedBox2d wanted;
  for (const Observation& o : observations) wanted.extend(o.position.xyz.head<2>().eval());
  std::vector<CrownTable> tables;
  for (std::size_t i = 0; i < tables_.size(); ++i)
    if (extents_[i].intersects(wanted)) tables.push_back(*tables_[i]());
  return tables;
}

}  // namespace waymark::pipeline
