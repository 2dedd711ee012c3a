// SPDX-License-Identifier: Apache-2.0
#include "geodb/layers/landmark_rows.hpp"

#include <algorithm>

namespace waymark::geodb {
namespace {

constexpr std::size_t kMaxRows = 64;            // of a statement; more are no faster
constexpr std::size_t kMaxParameters = 32'766;  // SQLite's limit

}  // namespace

LandmarkRows::LandmarkRows(const sqlite::Database& database, const LandmarkLayout& layout,
                           std::int32_t srs_id)
    : database_(&database),
      layout_(&layout),
      srs_id_(srs_id),
      pending_(std::min(kMaxRows, kMaxParameters / layout.columns().size())),
      insert_(database.prepare(layout.insert(pending_.size()))) {}

void LandmarkRows::add(std::int64_t row, const Landmark& landmark) {
  pending_[count_] = {row, &landmark, point_blob(landmark.position.xyz, srs_id_)};
  bind(insert_, count_);
  if (++count_ < pending_.size()) return;
  insert_.run();
  count_ = 0;
}

void LandmarkRows::flush() {
  if (count_ == 0) return;
  sqlite::Statement rest = database_->prepare(layout_->insert(count_));
  for (std::size_t i = 0; i < count_; ++i) bind(rest, i);
  rest.run();
  count_ = 0;
}

void LandmarkRows::bind(sqlite::Statement& statement, std::size_t index) const {
  const auto& [row, landmark, geometry] = pending_[index];
  layout_->bind(statement, row, *landmark, geometry, index);
}

}  // namespace waymark::geodb
