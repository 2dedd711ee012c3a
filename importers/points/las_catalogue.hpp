// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>
#include "importers/points/las_points.hpp"
namespace waymark {

/// A rectangle in the units of the files.
struct LasBox {
  double left = 0, low = 0, right = 0, high = 0;
  bool meets(const LasBox& b) const {
    return left <= b.right && b.left <= right && low <= b.high && b.low <= high;
  }
};

/// The points of many LAS files, found by place. Each run of 65,536 points is known by its box, so a search
/// reads only the runs that may matter; decoded runs are kept while memory allows. Safe for many threads.
class LasCatalogue {
 public:
  /// Reads every file once: about 10 M points/s. Throws Error{input}.
  LasCatalogue(const std::vector<std::string>& files, std::int64_t memory_bytes);

  const std::vector<LasHeader>& headers() const { return headers_; }
  const LasBox& box() const { return box_; }  ///< of all points that count
  std::uint64_t points() const { return points_; }
  std::uint64_t ground_points() const { return ground_; }
  std::uint64_t first_returns() const { return first_returns_; }
  std::uint64_t left_out() const { return left_out_; }  ///< noise and withheld

  /// All points of the box that are no noise, file by file in their order.
  void visit(const LasBox& box, const std::function<void(const LasPoint&)>& use) const;

 private:
  struct Run {
    std::size_t file;
    std::uint64_t first, count;
    LasBox box;
  };
  using Points = std::shared_ptr<const std::vector<LasPoint>>;
  Points points_of(std::size_t run) const;

  std::vector<LasHeader> headers_;
  std::vector<Run> runs_;
  LasBox box_;
  std::uint64_t points_ = 0, ground_ = 0, first_returns_ = 0, left_out_ = 0;
  std::size_t kept_runs_;
  mutable std::mutex mutex_;
  mutable std::list<std::pair<std::size_t, Points>> kept_;  // used last first
  mutable std::unordered_map<std::size_t, std::list<std::pair<std::size_t, Points>>::iterator> at_;
};

/// Neither noise nor withheld.
inline bool counts(const LasPoint& p) {
  return !p.withheld && p.classification != 7 && p.classification != 18;
}

/// First returns; all, where the file does not number them.
inline bool is_first(const LasPoint& p) {
  return p.return_number <= 1;
}

}  // namespace waymark
