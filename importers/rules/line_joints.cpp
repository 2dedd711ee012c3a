// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/line_joints.hpp"

#include <algorithm>
#include <cmath>

#include "geo/spatial_index.hpp"
#include "importers/rules/vertex_hash.hpp"

namespace waymark::importers {
namespace {

constexpr double kTouch = 0.05;  // m: OpenStreetMap rounds to 1 cm, and drawings snap

/// The vertices of a line without repetitions, by their numbers; that where a closed line begins stands once.
struct Vertices {
  std::vector<std::size_t> numbers;
  bool closed = false;

  explicit Vertices(const GeometryPart& part) {
    if (part.kind != GeometryPart::Kind::line) return;
    const auto& v = part.vertices;
    for (std::size_t i = 0; i < v.size(); ++i)
      if (numbers.empty() || v[i].head<2>() != v[numbers.back()].head<2>()) numbers.push_back(i);
    closed = numbers.size() > 2 && v[numbers.front()].head<2>() == v[numbers.back()].head<2>();
    if (closed) numbers.pop_back();
    if (numbers.size() < 2) numbers.clear();
  }
  bool is_end(std::size_t k) const { return !closed && (k == 0 || k + 1 == numbers.size()); }
  /// Returns the number of the vertex before or after the k-th one; of an end, of the only one.
  std::size_t beside(std::size_t k, bool after) const {
    const std::size_t n = numbers.size();
    if (!closed && k == 0) return numbers[1];
    if (!closed && k + 1 == n) return numbers[n - 2];
    return numbers[(k + (after ? 1 : n - 1)) % n];
  }
};

}  // namespace

void LineJoints::Joint::add(const Branch& branch) {
  for (std::size_t i = 0; i < std::min<std::size_t>(count, branches.size()); ++i)
    if (branches[i].neighbour == branch.neighbour) return;
  if (count < branches.size()) branches[count] = branch;
  if (count <= branches.size()) ++count;
}

void LineJoints::add(const MapElement& element) {
  for (const GeometryPart& part : element.parts) {
    const Vertices line(part);
    for (std::size_t k = 0; k < line.numbers.size(); ++k) {
      const Eigen::Vector3d& at = part.vertices[line.numbers[k]];
      Joint& joint = joints_[hash_of(at)];
      const std::uint8_t before = joint.count;
      joint.add({part.vertices[line.beside(k, true)].head<2>()});
      if (line.is_end(k)) {
        if (joint.count == before) continue;  // an equal line
        if (joint.ends < 3) ++joint.ends;
        ends_.push_back(at);
      } else {
        joint.add({part.vertices[line.beside(k, false)].head<2>()});
        joint.through = true;
      }
      if (k > 0) pieces_.push_back({part.vertices[line.numbers[k - 1]].head<2>(), at.head<2>()});
    }
    if (line.closed)
      pieces_.push_back(
          {part.vertices[line.numbers.back()].head<2>(), part.vertices[line.numbers.front()].head<2>()});
  }
}

void LineJoints::find_touching_ends(const ToMetres& to_metres, double margin) {
  for (Eigen::Vector3d& end : ends_) end.z() = 0;
  const SpatialIndex index(ends_);
  const Eigen::Vector3d around(margin, margin, margin);
  for (const Piece& piece : pieces_) {
    Eigen::AlignedBox3d box(Eigen::Vector3d(piece.from.x(), piece.from.y(), 0) - around);
    box.extend(Eigen::Vector3d(piece.from.x(), piece.from.y(), 0) + around);
    box.extend(Eigen::Vector3d(piece.to.x(), piece.to.y(), 0) - around);
    box.extend(Eigen::Vector3d(piece.to.x(), piece.to.y(), 0) + around);
    for (const std::size_t i : index.in_box(box)) {
      const Eigen::Vector2d end = ends_[i].head<2>();
      if (end == piece.from || end == piece.to) continue;
      const Eigen::Vector2d at = to_metres(end, end), from = to_metres(end, piece.from),
                            to = to_metres(end, piece.to), run = to - from;
      const double length = run.norm(), along = (at - from).dot(run) / length;
      const double across = std::abs(run.x() * (at - from).y() - run.y() * (at - from).x()) / length;
      if (!(across <= kTouch && along > kTouch && along < length - kTouch)) continue;
      Joint& joint = joints_[hash_of(ends_[i])];
      joint.add({piece.from, false});
      joint.add({piece.to, false});
      joint.through = true;
    }
  }
  pieces_ = {};
  ends_ = {};
}

void LineJoints::mark(const MapElement& element, std::vector<std::vector<SharedVertex>>& into) const {
  into.resize(element.parts.size());
  for (std::size_t p = 0; p < element.parts.size(); ++p) {
    const GeometryPart& part = element.parts[p];
    into[p].resize(part.vertices.size());
    const Vertices line(part);
    for (std::size_t k = 0; k < line.numbers.size(); ++k) {
      const Eigen::Vector2d at = part.vertices[line.numbers[k]].head<2>();
      const auto found = joints_.find(hash_of(part.vertices[line.numbers[k]]));
      if (found == joints_.end()) continue;
      const Joint& joint = found->second;
      SharedVertex& vertex = into[p][line.numbers[k]];
      vertex.joined = line.is_end(k) && (joint.ends > 1 || joint.through);
      const Eigen::Vector2d after = part.vertices[line.beside(k, true)].head<2>(),
                            before = part.vertices[line.beside(k, false)].head<2>();
      if (joint.count == 2 && joint.ends == 2 && joint.branches[0].neighbour == after)
        vertex.next = joint.branches[1].neighbour;
      if (joint.count < 3 || joint.count > joint.branches.size()) continue;
      std::vector<Branch> around(joint.branches.begin(), joint.branches.begin() + joint.count);
      std::ranges::sort(around, {}, [&](const Branch& branch) {
        const Eigen::Vector2d away = branch.neighbour - at;
        return std::atan2(away.y(), away.x());
      });
      vertex.meeting = true;
      for (std::size_t i = 0; i < around.size(); ++i) {
        const Branch &right = around[i], &left = around[(i + 1) % around.size()];
        const Branch& owner = right.owned ? right : left;
        if (owner.owned && (owner.neighbour == after || owner.neighbour == before))
          vertex.wedges.push_back({right.neighbour, left.neighbour});
      }
    }
  }
}

}  // namespace waymark::importers
