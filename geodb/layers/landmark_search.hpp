// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>
#include "core/landmark.hpp"
#include "geo/crs.hpp"
#include "geodb/layers/landmark_layout.hpp"
#include "geodb/map_query.hpp"
#include "geodb/rtree/search_windows.hpp"
namespace waymark::geodb {

struct RankedLandmark {
  double rank = 0;  ///< smaller is better
  std::int64_t row = 0;
  Landmark landmark;

  bool operator<(const RankedLandmark& other) const {
    return rank != other.rank ? rank < other.rank : row < other.row;
  }
};

/// Collects the best `limit` landmarks, equal ranks by row; uses memory for twice as many.
class BestLandmarks {
 public:
  explicit BestLandmarks(std::int64_t limit);
  bool accepts(double rank) const { return limit_ > 0 && rank <= worst_; }
  bool full() const { return found_.size() >= limit_; }
  std::size_t limit() const { return limit_; }
  void add(RankedLandmark found);
  void join(BestLandmarks other) {
    for (RankedLandmark& found : other.found_) add(std::move(found));
  }
  std::vector<Landmark> take();

 private:
  void prune();

  std::size_t limit_;
  double worst_ = std::numeric_limits<double>::infinity();  ///< worst rank that is accepted
  std::vector<RankedLandmark> found_;
};

/// Query of one table, with the columns of its conditions. Refers to its arguments.
class LandmarkSearch {
 public:
  LandmarkSearch(const Crs& crs, const MapDistance& map_distance, const MapQuery& query,
                 const LandmarkLayout& layout);

  /// Returns false if the type lacks a column of the query's ranges.
  bool has_queried_columns() const;
  /// Adds the row's landmark if it meets every condition, and returns whether it did; reads only the columns
  /// that it needs.
  bool examine(const sqlite::Statement& row, BestLandmarks& best) const;

 private:
  /// Returns the value of a column; the quality is weighted for the query's sensor.
  double value(const sqlite::Statement& row, int column) const;
  bool meets_ranges(const sqlite::Statement& row) const;

  const MapDistance* map_distance_;
  const MapQuery* query_;
  const LandmarkLayout* layout_;
  SearchWindows box_;
  std::vector<std::optional<int>> ranges_;  ///< column of each range
  std::optional<int> largest_;
  int quality_, confidence_;  ///< columns
};

/// Returns the column of numbers with that name; `std::nullopt` if the table has none.
std::optional<int> number_column(const LandmarkLayout& layout, std::string_view name);

}  // namespace waymark::geodb
