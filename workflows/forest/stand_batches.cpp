// SPDX-License-Identifier: Apache-2.0
#include "workflows/forest/stand_batches.hpp"

#include <algorithm>

namespace waymark::workflows {
namespace {

double area_of(const Eigen::AlignedBox2d& box) {
  return box.isEmpty() ? 0 : box.volume();
}

}  // namespace

StandBatches::StandBatches(const TreeReader& reader, std::vector<NamedStand> stands, std::int64_t max_trees)
    : reader_(&reader), stands_(std::move(stands)) {
  make_batches(max_trees);
}

void StandBatches::make_batches(std::int64_t max_trees) {
  const bool all = reader_->count() <= max_trees;
  const double fraction =
      static_cast<double>(max_trees) / static_cast<double>(std::max<std::int64_t>(1, reader_->count()));
  const double largest = fraction * area_of(reader_->extent());
  for (std::size_t i = 0; i < stands_.size(); ++i) {
    Eigen::AlignedBox2d box = pipeline::bounds(stands_[i].polygon);
    if (!box.isEmpty()) {
      const Eigen::Vector2d reach = Eigen::Vector2d::Constant(reader_->max_influence_radius());
      box = Eigen::AlignedBox2d(box.min() - reach, box.max() + reach);
    }
    const bool joins = !batches_.empty() && (all || area_of(batches_.back().box.merged(box)) <= largest);
    if (!joins) batches_.push_back({.begin = i, .end = i, .box = {}});
    batches_.back().end = i + 1;
    batches_.back().box.extend(box);
  }
}

MapTrees StandBatches::trees_of(const Batch& batch) const {
  return batch.box.contains(reader_->extent()) ? reader_->all() : reader_->read(batch.box);
}

void StandBatches::visit(const Visitor& visitor) const {
  if (batches_.size() == 1 && !cached_) cached_ = trees_of(batches_[0]);
  for (const Batch& batch : batches_) {
    const MapTrees read = cached_ ? MapTrees{} : trees_of(batch);
    for (std::size_t i = batch.begin; i < batch.end; ++i) visitor(cached_ ? *cached_ : read, stands_[i]);
  }
}

}  // namespace waymark::workflows
