// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>
#include "importers/points/las_header.hpp"
namespace waymark::importers {

/// A laser return, in the units of the file.
struct LasPoint {
  double x = 0, y = 0, z = 0;
  std::uint8_t classification = 0;  ///< 2 ground; 7 and 18 noise
  std::uint8_t return_number = 1;   ///< from 1; 0: not numbered
  bool withheld = false;
};

inline constexpr std::uint64_t kLasChunk = std::uint64_t{1} << 16;

/// Reads points `first` to `first + count` of a file, in its order. Throws Error{input} if the file ends
/// early. About 10 M points/s.
std::vector<LasPoint> read_las_points(const LasHeader& header, std::uint64_t first, std::uint64_t count);

/// A rectangle in the units of the files.
struct LasBox {
  double left = 0, low = 0, right = 0, high = 0;
  bool intersects(const LasBox& b) const {
    return left <= b.right && b.left <= right && low <= b.high && b.low <= high;
  }
};

/// Spatial index of the points of many LAS files. It knows the box of each run of 65,536 points, so a search
/// decodes only runs that intersect; decoded runs are cached within the memory limit. Safe for many threads.
class LasCatalogue {
 public:
  /// Reads every file once: about 10 M points/s. Throws Error{input}.
  LasCatalogue(const std::vector<std::string>& files, std::int64_t memory_bytes);

  const std::vector<LasHeader>& headers() const { return headers_; }
  const LasBox& box() const { return box_; }  ///< of all usable points
  std::uint64_t points() const { return points_; }
  std::uint64_t ground_points() const { return ground_; }
  std::uint64_t first_returns() const { return first_returns_; }
  std::uint64_t excluded() const { return excluded_; }  ///< noise and withheld

  /// Visits all usable points in the box, file by file in their order.
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
  std::uint64_t points_ = 0, ground_ = 0, first_returns_ = 0, excluded_ = 0;
  std::size_t kept_runs_;
  mutable std::mutex mutex_;
  mutable std::list<std::pair<std::size_t, Points>> kept_;  // most recently used first
  mutable std::unordered_map<std::size_t, std::list<std::pair<std::size_t, Points>>::iterator> at_;
};

/// Returns false for noise and withheld points.
inline bool is_usable(const LasPoint& p) {
  return !p.withheld && p.classification != 7 && p.classification != 18;
}

/// Returns true for a first return, and for all returns if the file does not number them.
inline bool is_first(const LasPoint& p) {
  return p.return_number <= 1;
}

}  // namespace waymark::importers
