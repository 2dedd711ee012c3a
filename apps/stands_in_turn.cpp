// SPDX-License-Identifier: Apache-2.0
#include "apps/stands_in_turn.hpp"

#include <algorithm>

namespace waymark {
namespace {

double area_of(const Eigen::AlignedBox2d& box) {
  return box.isEmpty() ? 0 : box.volume();
}

}  // namespace

StandsInTurn::StandsInTurn(const TreeReader& reader, std::vector<NamedStand> stands,
                           std::int64_t trees_at_once)
    : reader_(&reader), stands_(std::move(stands)) {
  divide(trees_at_once);
}

void StandsInTurn::divide(std::int64_t trees_at_once) {
  const bool all = reader_->count() <= trees_at_once;
  const double share =
      static_cast<double>(trees_at_once) / static_cast<double>(std::max<std::int64_t>(1, reader_->count()));
  const double largest = share * area_of(reader_->extent());
  for (std::size_t i = 0; i < stands_.size(); ++i) {
    Eigen::AlignedBox2d box = bounds(stands_[i].ground);
    if (!box.isEmpty()) {
      const Eigen::Vector2d reach = Eigen::Vector2d::Constant(reader_->widest_reach());
      box = Eigen::AlignedBox2d(box.min() - reach, box.max() + reach);
    }
    const bool joins = !groups_.empty() && (all || area_of(groups_.back().box.merged(box)) <= largest);
    if (!joins) groups_.push_back({.begin = i, .end = i, .box = {}});
    groups_.back().end = i + 1;
    groups_.back().box.extend(box);
  }
}

MapTrees StandsInTurn::trees_of(const Group& group) const {
  return group.box.contains(reader_->extent()) ? reader_->all() : reader_->in(group.box);
}

void StandsInTurn::visit(const Take& take) const {
  if (groups_.size() == 1 && !kept_) kept_ = trees_of(groups_[0]);
  for (const Group& group : groups_) {
    const MapTrees read = kept_ ? MapTrees{} : trees_of(group);
    for (std::size_t i = group.begin; i < group.end; ++i) take(kept_ ? *kept_ : read, stands_[i]);
  }
}

}  // namespace waymark
