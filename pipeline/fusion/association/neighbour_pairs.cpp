// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/neighbour_pairs.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

namespace waymark::pipeline {
namespace {

struct CellKey {
  std::int64_t x = 0, y = 0, z = 0;
};

std::uint64_t hash(const CellKey& key) {
  std::uint64_t h = static_cast<std::uint64_t>(key.x) * 0x9e3779b97f4a7c15u ^
                    static_cast<std::uint64_t>(key.y) * 0xc2b2ae3d27d4eb4fu ^
                    static_cast<std::uint64_t>(key.z) * 0x165667b19e3779f9u;
  h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93u;
  return h ^ (h >> 32);
}

struct Entry {
  Eigen::Vector3d position;
  std::uint32_t item = 0;
  std::uint32_t tag = 0;  // of its cell
};

// Points with `reach` / 2 < their reach <= `reach`, by cell. Two points of a level, or one and a point of a
// finer level, can be a pair only if their cells touch.
class Level {
 public:
  Level(double reach, bool flat, std::span<const std::uint32_t> items,
        std::span<const Eigen::Vector3d> points)
      : cell_(std::max(2 * reach, 1e-9)), flat_(flat), entries_(items.size()) {
    std::size_t slots = 16;
    while (slots < 2 * items.size()) slots *= 2;
    mask_ = slots - 1;
    // Counting sort by slot: items of one slot are adjacent and ascending.
    starts_.assign(slots + 1, 0);
    std::vector<std::uint64_t> cell(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
      cell[i] = hash(key(points[items[i]]));
      ++starts_[(cell[i] & mask_) + 1];
    }
    for (std::size_t s = 0; s < slots; ++s) starts_[s + 1] += starts_[s];
    std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
    for (std::size_t i = 0; i < items.size(); ++i)
      entries_[next[cell[i] & mask_]++] = {points[items[i]], items[i], tag(cell[i])};
  }

  /// Calls visit(entry) for the entries of the neighbouring cells. Some may be farther away; entries may
  /// repeat after hash collisions.
  void around(const Eigen::Vector3d& position, const auto& visit) const {
    const CellKey centre = key(position);
    const std::int64_t dz_end = flat_ ? 0 : 1;
    for (std::int64_t dz = -dz_end; dz <= dz_end; ++dz)
      for (std::int64_t dy = -1; dy <= 1; ++dy)
        for (std::int64_t dx = -1; dx <= 1; ++dx) {
          const std::uint64_t cell = hash({centre.x + dx, centre.y + dy, centre.z + dz});
          const std::size_t s = cell & mask_;
          for (std::uint32_t i = starts_[s]; i < starts_[s + 1]; ++i)
            if (entries_[i].tag == tag(cell)) visit(entries_[i]);
        }
  }

 private:
  static std::uint32_t tag(std::uint64_t cell) { return static_cast<std::uint32_t>(cell >> 32); }
  CellKey key(const Eigen::Vector3d& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x() / cell_)),
            static_cast<std::int64_t>(std::floor(p.y() / cell_)),
            flat_ ? 0 : static_cast<std::int64_t>(std::floor(p.z() / cell_))};
  }

  double cell_;
  bool flat_;
  std::size_t mask_ = 0;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> starts_;
};

}  // namespace

std::vector<IndexPair> find_neighbour_pairs(std::span<const Eigen::Vector3d> points,
                                            std::span<const double> reach,
                                            const std::function<bool(std::uint32_t, std::uint32_t)>& wanted) {
  assert(points.size() == reach.size());
  std::map<int, std::vector<std::uint32_t>> by_exponent;
  std::vector<int> exponent(points.size());
  bool flat = true;
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::frexp(std::max(reach[i], 1e-9), &exponent[i]);
    by_exponent[exponent[i]].push_back(static_cast<std::uint32_t>(i));
    flat = flat && points[i].z() == 0;
  }
  std::map<int, Level> levels;
  for (const auto& [e, items] : by_exponent) levels.try_emplace(e, std::ldexp(1.0, e), flat, items, points);

  constexpr std::size_t kChunk = 4096;
  std::vector<std::vector<IndexPair>> found((points.size() + kChunk - 1) / kChunk);
  tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t chunk) {
    const std::size_t end = std::min(points.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i)
      for (auto level = levels.find(exponent[i]); level != levels.end(); ++level)
        level->second.around(points[i], [&](const Entry& entry) {
          const std::uint32_t j = entry.item;
          if (i == j || (exponent[j] == exponent[i] && j < i)) return;
          const double together = reach[i] + reach[j];
          if ((points[i] - entry.position).squaredNorm() > together * together) return;
          const auto a = static_cast<std::uint32_t>(i);
          const IndexPair pair{std::min(a, j), std::max(a, j)};
          if (wanted(pair.first, pair.second)) found[chunk].push_back(pair);
        });
  });
  std::vector<IndexPair> pairs;
  std::size_t total = 0;
  for (const auto& part : found) total += part.size();
  pairs.reserve(total);
  for (auto& part : found) {
    pairs.insert(pairs.end(), part.begin(), part.end());
    part = {};
  }
  tbb::parallel_sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace waymark::pipeline
