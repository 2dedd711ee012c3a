// SPDX-License-Identifier: Apache-2.0
#include "geodb/landmark_search.hpp"

#include <algorithm>
#include <cmath>

#include "geodb/geometry_blob.hpp"
#include "landmarks/sensor_profile.hpp"

namespace waymark {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);
constexpr std::size_t kFewest = 1000;  // finds worth cutting down

double falling(double value) {
  return std::isnan(value) ? std::numeric_limits<double>::infinity() : -value;
}

}  // namespace

BestLandmarks::BestLandmarks(std::int64_t limit)
    : limit_(static_cast<std::size_t>(std::max<std::int64_t>(0, limit))) {}

void BestLandmarks::add(FoundLandmark found) {
  found_.push_back(std::move(found));
  if (found_.size() >= kFewest && found_.size() / 2 >= limit_) cut();
}

std::vector<Landmark> BestLandmarks::take() {
  cut();
  std::vector<Landmark> landmarks;
  landmarks.reserve(found_.size());
  for (FoundLandmark& found : found_) landmarks.push_back(std::move(found.landmark));
  return landmarks;
}

void BestLandmarks::cut() {
  std::ranges::sort(found_, std::less{});
  if (found_.size() < limit_ || found_.empty()) return;
  found_.erase(found_.begin() + static_cast<std::ptrdiff_t>(limit_), found_.end());
  if (!found_.empty()) worst_ = found_.back().rank;
}

LandmarkSearch::LandmarkSearch(const Crs& crs, const GroundRuler& ruler, const MapQuery& query,
                               const LandmarkType& type)
    : ruler_(&ruler), query_(&query), type_(&type), largest_(feature_column(query.largest_first)) {
  if (query.box) box_ = windows_of(crs, *query.box);
  for (const auto& range : query.features) ranges_.push_back(feature_column(range.feature));
}

bool LandmarkSearch::possible() const {
  return std::ranges::count(ranges_, kNone) == 0;
}

void LandmarkSearch::look_at(const LandmarkLayout& layout, const sqlite::Statement& row,
                             BestLandmarks& best) const {
  const auto point = point_of(LandmarkLayout::geometry(row));
  if (!point || (query_->box && !inside(box_, point->x(), point->y()))) return;
  if (!meets_ranges(layout, row)) return;
  double rank = 0;
  if (query_->near) {
    rank = (*ruler_)(query_->near->x, query_->near->y, point->x(), point->y());
    if (!(rank <= query_->near->radius.value)) return;
  }
  if (largest_ != kNone) rank = falling(layout.feature(row, largest_));
  const bool by_quality = query_->largest_first == "quality";
  if (!by_quality && !best.wants(rank)) return;

  Landmark landmark = layout.read(row);
  if (by_quality || query_->min_quality > 0) {
    const auto quality =
        query_->sensor ? quality_for(*query_->sensor, *type_, landmark) : quality_of(*type_, landmark);
    if (query_->min_quality > 0 && !(quality.value_or(-1) >= query_->min_quality)) return;
    if (by_quality) rank = falling(quality.value_or(std::nan("")));
  }
  best.add({rank, LandmarkLayout::row_id(row), std::move(landmark)});
}

std::size_t LandmarkSearch::feature_column(const std::string& feature) const {
  const auto found = std::ranges::find(type_->features, feature, &FeatureSpec::name);
  return found == type_->features.end() ? kNone : static_cast<std::size_t>(found - type_->features.begin());
}

bool LandmarkSearch::meets_ranges(const LandmarkLayout& layout, const sqlite::Statement& row) const {
  for (std::size_t i = 0; i < ranges_.size(); ++i) {
    const double value = layout.feature(row, ranges_[i]);
    const auto& range = query_->features[i];
    if (!(range.lowest <= value && value <= range.highest)) return false;
  }
  return true;
}

}  // namespace waymark
