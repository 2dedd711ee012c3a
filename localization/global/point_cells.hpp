// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>
#include "core/random.hpp"
namespace waymark::localization {

/// Points in hashed cubes, for maps around a body; a plane is the case z = 0. Immutable.
class PointCells {
 public:
  PointCells() = default;
  /// `cell` metres; 0: about two points in a cell, assuming they cover the faces of their box.
  explicit PointCells(std::span<const Eigen::Vector3d> points, double cell = 0);

  double cell() const { return cell_; }
  std::size_t occupied() const { return occupied_; }  ///< cells that hold a point
  std::size_t bytes() const {
    return entries_.size() * sizeof(Entry) + first_.size() * sizeof(std::uint32_t);
  }

  /// Calls visit(index, squared distance) for the points within `radius` of `centre`, each once.
  template <class Visit>
  void near(const Eigen::Vector3d& centre, double radius, Visit&& visit) const {
    if (entries_.empty()) return;
    const double square = radius * radius;
    const double cubes = std::pow(2 * radius / cell_ + 1, flat_ ? 2 : 3);
    if (cubes > static_cast<double>(2 * entries_.size())) {  // fewer points than cubes
      for (const Entry& e : entries_)
        if (const double d = (e.at - centre).squaredNorm(); d <= square) visit(e.index, d);
      return;
    }
    const Eigen::Vector3d low = ((centre.array() - radius) / cell_).floor();
    const Eigen::Vector3d high = ((centre.array() + radius) / cell_).floor();
    for (double x = low.x(); x <= high.x(); ++x)
      for (double y = low.y(); y <= high.y(); ++y)
        for (double z = flat_ ? 0 : low.z(); z <= (flat_ ? 0 : high.z()); ++z) {
          const std::uint64_t key = key_of(x, y, z);
          const std::size_t bucket = bucket_of(key);
          for (std::uint32_t k = first_[bucket]; k < first_[bucket + 1]; ++k) {
            if (entries_[k].key != key) continue;
            const double d = (entries_[k].at - centre).squaredNorm();
            if (d <= square) visit(entries_[k].index, d);
          }
        }
  }

 private:
  struct Entry {
    Eigen::Vector3d at;
    std::uint64_t key;
    std::uint32_t index;
  };
  static std::uint64_t key_of(double x, double y, double z) {
    const auto word = [](double v) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(v)); };
    return mix_bits(mix_bits(mix_bits(word(x)) ^ word(y)) ^ word(z));
  }
  std::size_t bucket_of(std::uint64_t key) const { return key & (first_.size() - 2); }

  std::vector<Entry> entries_;        // by bucket, then as given
  std::vector<std::uint32_t> first_;  // of each bucket; one more than buckets, which are a power of two
  double cell_ = 1;
  std::size_t occupied_ = 0;
  bool flat_ = true;
};

}  // namespace waymark::localization
