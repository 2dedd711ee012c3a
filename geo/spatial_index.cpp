// SPDX-License-Identifier: Apache-2.0
#include "geo/spatial_index.hpp"

#include <algorithm>
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <iterator>

namespace waymark::inline geo {
namespace {

namespace bg = boost::geometry;
using IndexPoint = bg::model::point<double, 3, bg::cs::cartesian>;
using Box = bg::model::box<IndexPoint>;
using Entry = std::pair<IndexPoint, std::size_t>;

IndexPoint to_index_point(const Eigen::Vector3d& point) {
  return {point.x(), point.y(), point.z()};
}

double squared_distance(const IndexPoint& a, const Eigen::Vector3d& b) {
  return (Eigen::Vector3d(bg::get<0>(a), bg::get<1>(a), bg::get<2>(a)) - b).squaredNorm();
}

std::vector<Entry> entries_of(std::span<const Eigen::Vector3d> points) {
  std::vector<Entry> entries;
  entries.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) entries.emplace_back(to_index_point(points[i]), i);
  return entries;
}

std::vector<std::size_t> sorted_indices(const std::vector<Entry>& entries) {
  std::vector<std::size_t> indices;
  indices.reserve(entries.size());
  for (const Entry& entry : entries) indices.push_back(entry.second);
  std::ranges::sort(indices);
  return indices;
}

}  // namespace

struct SpatialIndex::Tree {
  bg::index::rtree<Entry, bg::index::quadratic<16>> entries;  // packed by the constructor from a range

  std::vector<Entry> in(const Box& box) const {
    std::vector<Entry> found;
    entries.query(bg::index::intersects(box), std::back_inserter(found));
    return found;
  }

  std::vector<Entry> in_ball(const Eigen::Vector3d& centre, double radius) const {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(radius);
    std::vector<Entry> found = in({to_index_point(centre - reach), to_index_point(centre + reach)});
    std::erase_if(found, [&](const Entry& e) { return squared_distance(e.first, centre) > radius * radius; });
    return found;
  }
};

SpatialIndex::SpatialIndex(std::span<const Eigen::Vector3d> points)
    : tree_(new Tree{decltype(Tree::entries)(entries_of(points))}) {}
SpatialIndex::~SpatialIndex() = default;
SpatialIndex::SpatialIndex(SpatialIndex&&) noexcept = default;
SpatialIndex& SpatialIndex::operator=(SpatialIndex&&) noexcept = default;

std::size_t SpatialIndex::size() const {
  return tree_->entries.size();
}

std::vector<std::size_t> SpatialIndex::in_box(const Eigen::AlignedBox3d& box) const {
  if (box.isEmpty()) return {};
  return sorted_indices(tree_->in({to_index_point(box.min()), to_index_point(box.max())}));
}

std::vector<std::size_t> SpatialIndex::within(const Eigen::Vector3d& centre, double radius) const {
  if (!(radius >= 0)) return {};
  return sorted_indices(tree_->in_ball(centre, radius));
}

// The tree breaks ties arbitrarily, so all points up to the distance of the last one are sorted again.
std::vector<std::size_t> SpatialIndex::nearest(const Eigen::Vector3d& centre, std::size_t count) const {
  if (count == 0 || size() == 0) return {};
  std::vector<Entry> found;
  tree_->entries.query(
      bg::index::nearest(to_index_point(centre), static_cast<unsigned>(std::min(count, size()))),
      std::back_inserter(found));
  double furthest = 0;
  for (const Entry& entry : found) furthest = std::max(furthest, squared_distance(entry.first, centre));
  found = tree_->in_ball(centre, std::nextafter(std::sqrt(furthest), HUGE_VAL));
  std::ranges::sort(found, {}, [&](const Entry& entry) {
    return std::pair(squared_distance(entry.first, centre), entry.second);
  });
  if (found.size() > count) found.resize(count);
  std::vector<std::size_t> indices;
  for (const Entry& entry : found) indices.push_back(entry.second);
  return indices;
}

}  // namespace waymark::inline geo
