// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <limits>
#include <vector>
#include "core/landmark.hpp"
#include "geo/crs.hpp"
#include "geodb/landmark_layout.hpp"
#include "geodb/map_query.hpp"
#include "geodb/search_windows.hpp"
namespace waymark {

struct FoundLandmark {
  double rank = 0;  ///< smaller is better
  std::int64_t row = 0;
  Landmark landmark;

  bool operator<(const FoundLandmark& other) const {
    return rank != other.rank ? rank < other.rank : row < other.row;
  }
};

/// Keeps the best `limit` of any number of finds, rows deciding between equal ranks; memory is twice that.
class BestLandmarks {
 public:
  explicit BestLandmarks(std::int64_t limit);
  bool wants(double rank) const { return limit_ > 0 && rank <= worst_; }
  bool full() const { return found_.size() >= limit_; }
  void add(FoundLandmark found);
  std::vector<Landmark> take();

 private:
  void cut();

  std::size_t limit_;
  double worst_ = std::numeric_limits<double>::infinity();  ///< rank beyond which nothing is wanted
  std::vector<FoundLandmark> found_;
};

/// One query against one table: the conditions with their columns looked up. Refers to its arguments.
class LandmarkSearch {
 public:
  LandmarkSearch(const Crs& crs, const GroundRuler& ruler, const MapQuery& query, const LandmarkType& type);

  /// False where the type lacks a feature that is asked for.
  bool possible() const;
  /// Adds the row's landmark where it meets every condition; columns are read only as far as needed.
  void look_at(const LandmarkLayout& layout, const sqlite::Statement& row, BestLandmarks& best) const;

 private:
  std::size_t feature_column(const std::string& feature) const;
  bool meets_ranges(const LandmarkLayout& layout, const sqlite::Statement& row) const;

  const GroundRuler* ruler_;
  const MapQuery* query_;
  const LandmarkType* type_;
  SearchWindows box_;
  std::vector<std::size_t> ranges_;  ///< index of the feature of each range
  std::size_t largest_;
};

}  // namespace waymark
