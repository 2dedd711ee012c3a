// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <span>
#include <unordered_map>
#include <vector>
#include "importers/points/las_runs.hpp"
namespace waymark::importers {

/// Spatial index of the points of many LAS, LAZ and COPC files. It knows the box of each run, so a search
/// decodes only runs that intersect; decoded runs are cached within the memory limit. Safe for many threads.
class LasCatalogue {
 public:
  /// Reads every file once, its runs in parallel. Of COPC files it reads the hierarchy and as many levels as
  /// are needed to find ground points; their boxes and numbers of returns are those of the header.
  /// Throws Error{input}, that of the first run that has one.
  LasCatalogue(const std::vector<std::string>& files, std::int64_t memory_bytes);

  const std::vector<LasHeader>& headers() const { return headers_; }
  const LasBox& box() const { return box_; }  ///< of all usable points
  std::uint64_t points() const { return points_; }
  std::uint64_t ground_points() const { return ground_; }
  std::uint64_t first_returns() const { return first_returns_; }
  std::uint64_t excluded() const { return excluded_; }  ///< noise and withheld, among the points read so far
  bool all_read() const { return all_read_; }           ///< false if COPC nodes were left unread
  /// Returns how many runs have been decoded, those for the index included.
  std::uint64_t runs_decoded() const { return decoded_; }

  /// Visits all usable points in the box, file by file in their order.
  void visit(const LasBox& box, const std::function<void(const LasPoint&)>& use) const;

 private:
  struct Run {
    std::size_t file;
    LasRun part;
    LasBox box;
  };
  using Points = std::shared_ptr<const std::vector<LasPoint>>;
  void add_file(std::size_t file);
  void index(std::size_t file, std::span<const LasRun> runs);
  void index_copc(std::size_t file, std::span<const LasRun> runs);
  std::vector<LasPoint> read(const LasHeader& header, const LasRun& run) const;
  Points points_of(std::size_t run) const;

  std::vector<LasHeader> headers_;
  std::vector<Run> runs_;
  LasBox box_;
  std::uint64_t points_ = 0, ground_ = 0, first_returns_ = 0, excluded_ = 0;
  bool all_read_ = true;
  std::size_t max_kept_;  // points
  mutable std::atomic<std::uint64_t> decoded_ = 0;
  mutable std::size_t kept_points_ = 0;
  mutable std::mutex mutex_;
  mutable std::list<std::pair<std::size_t, Points>> kept_;  // most recently used first
  mutable std::unordered_map<std::size_t, std::list<std::pair<std::size_t, Points>>::iterator> at_;
};

}  // namespace waymark::importers
