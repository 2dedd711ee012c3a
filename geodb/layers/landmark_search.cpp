// SPDX-License-Identifier: Apache-2.0
#include "geodb/layers/landmark_search.hpp"

#include <algorithm>
#include <cmath>

#include "geodb/geopackage/geometry_blob.hpp"
#include "landmarks/sensor_profile.hpp"

namespace waymark::geodb {
namespace {

constexpr std::size_t kMinToPrune = 1000;  // smaller lists are not pruned

double descending(double value) {
  return std::isnan(value) ? std::numeric_limits<double>::infinity() : -value;
}

}  // namespace

BestLandmarks::BestLandmarks(std::int64_t limit)
    : limit_(static_cast<std::size_t>(std::max<std::int64_t>(0, limit))) {}

void BestLandmarks::add(RankedLandmark found) {
  found_.push_back(std::move(found));
  if (found_.size() >= kMinToPrune && found_.size() / 2 >= limit_) prune();
}

std::vector<Landmark> BestLandmarks::take() {
  prune();
  std::vector<Landmark> landmarks;
  landmarks.reserve(found_.size());
  for (RankedLandmark& found : found_) landmarks.push_back(std::move(found.landmark));
  return landmarks;
}

void BestLandmarks::prune() {
  std::ranges::sort(found_, std::less{});
  if (found_.size() < limit_ || found_.empty()) return;
  found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(limit_), found_.end());
  if (!found_.empty()) worst_ = found_.back().rank;
}

LandmarkSearch::LandmarkSearch(const Crs& crs, const MapDistance& map_distance, const MapQuery& query,
                               const LandmarkLayout& layout)
    : map_distance_(&map_distance),
      query_(&query),
      layout_(&layout),
      largest_(number_column(layout, query.largest_first)),
      quality_(*number_column(layout, "quality")),
      confidence_(*number_column(layout, "confidence")) {
  if (query.box) box_ = search_windows(crs, *query.box);
  for (const auto& range : query.features) ranges_.push_back(number_column(layout, range.feature));
}

bool LandmarkSearch::has_queried_columns() const {
  return std::ranges::all_of(ranges_, [](const auto& column) { return column.has_value(); });
}

bool LandmarkSearch::examine(const sqlite::Statement& row, BestLandmarks& best) const {
  const auto point = point_of(LandmarkLayout::geometry(row));
  if (!point || (query_->box && !contains(box_, point->x(), point->y()))) return false;
  if (query_->min_confidence > 0 && !(row.real(confidence_) >= query_->min_confidence)) return false;
  if (!meets_ranges(row)) return false;
  double rank = 0;
  if (query_->near) {
    rank = (*map_distance_)(query_->near->x, query_->near->y, point->x(), point->y());
    if (!(rank <= query_->near->radius.value)) return false;
  }
  if (query_->min_quality > 0 && !(value(row, quality_) >= query_->min_quality)) return false;
  if (!query_->largest_first.empty()) rank = descending(largest_ ? value(row, *largest_) : std::nan(""));
  if (best.accepts(rank)) best.add({rank, LandmarkLayout::row_id(row), layout_->read(row)});
  return true;
}

double LandmarkSearch::value(const sqlite::Statement& row, int column) const {
  if (column != quality_) return row.real(column);
  const Landmark landmark = layout_->read(row);
  const auto quality = query_->sensor ? quality_for(*query_->sensor, layout_->type(), landmark)
                                      : quality_of(layout_->type(), landmark);
  return quality.value_or(std::nan(""));
}

bool LandmarkSearch::meets_ranges(const sqlite::Statement& row) const {
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    const double found = value(row, *ranges_[i]);
    const auto& range = query_->features[i];
    if (!(range.min_value <= found && found <= range.max_value)) return false;
  }
  return true;
}

std::optional<int> number_column(const LandmarkLayout& layout, std::string_view name) {
  const auto columns = layout.columns();
  const auto found = std::ranges::find(columns, name, &LandmarkColumn::name);
  const bool number = found != columns.end() && name != "id" &&
                      (found->sql_type.starts_with("DOUBLE") || found->sql_type.starts_with("INTEGER"));
  return number ? std::optional(static_cast<int>(found - columns.begin())) : std::nullopt;
}

}  // namespace waymark::geodb
