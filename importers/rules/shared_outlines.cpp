// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/shared_outlines.hpp"

#include <algorithm>
#include <bit>
#include <set>

namespace waymark::importers {
namespace {

std::uint64_t mix(std::uint64_t x) {  // splitmix64
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

std::uint64_t hash_of(const Eigen::Vector3d& v) {
  return mix(mix(std::bit_cast<std::uint64_t>(v.x() + 0.0)) +  // -0 becomes 0
             std::bit_cast<std::uint64_t>(v.y() + 0.0));
}

// The same in both directions.
std::uint64_t hash_of(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return mix(hash_of(a) + hash_of(b));
}

/// Returns the first vertex of a line, from one of its ends, that is not at that end; `nullptr` if all are.
const Eigen::Vector3d* neighbour_of_end(const std::vector<Eigen::Vector3d>& line, bool last) {
  const std::size_t n = line.size();
  for (std::size_t i = 1; i < n; ++i) {
    const Eigen::Vector3d& vertex = line[last ? n - 1 - i : i];
    if (vertex.head<2>() != (last ? line.back() : line.front()).head<2>()) return &vertex;
  }
  return nullptr;
}

bool is_open_line(const GeometryPart& part) {
  return part.kind == GeometryPart::Kind::line && part.vertices.size() > 1 &&
         part.vertices.front().head<2>() != part.vertices.back().head<2>();
}

}  // namespace

void SharedOutlines::add(const MapElement& element) {
  std::set<std::uint64_t> vertices, walls;  // an outline counts once, though it may touch itself
  for (const GeometryPart& part : element.parts) {
    if (part.kind != GeometryPart::Kind::outline) continue;
    for (std::size_t i = 0; i < part.vertices.size(); ++i) {
      vertices.insert(hash_of(part.vertices[i]));
      walls.insert(hash_of(part.vertices[i], part.vertices[(i + 1) % part.vertices.size()]));
    }
  }
  for (const std::uint64_t v : vertices)
    if (std::uint8_t& count = vertices_[v]; count < 2) ++count;
  for (const std::uint64_t w : walls)
    if (std::uint8_t& count = walls_[w]; count < 2) ++count;
}

std::vector<std::vector<SharedVertex>> SharedOutlines::of(const MapElement& element) const {
  std::vector<std::vector<SharedVertex>> all;
  for (const GeometryPart& part : element.parts) {
    auto& flags = all.emplace_back(part.vertices.size());
    if (part.kind != GeometryPart::Kind::outline) continue;
    const auto several = [](const auto& counts, std::uint64_t key) {
      const auto found = counts.find(key);
      return found != counts.end() && found->second > 1;
    };
    for (std::size_t i = 0; i < part.vertices.size(); ++i)
      flags[i] = {several(vertices_, hash_of(part.vertices[i])),
                  several(walls_, hash_of(part.vertices[i], part.vertices[(i + 1) % part.vertices.size()]))};
  }
  return all;
}

void LineJoints::add_end(const Eigen::Vector3d& end, const Eigen::Vector3d& neighbour) {
  Joint& joint = joints_[hash_of(end)];
  for (std::size_t i = 0; i < std::min<std::size_t>(joint.ends, 2); ++i)
    if (joint.neighbours[i] == neighbour.head<2>()) return;
  if (joint.ends < 2) joint.neighbours[joint.ends] = neighbour.head<2>();
  if (joint.ends < 3) ++joint.ends;
}

void LineJoints::add(const MapElement& element) {
  for (const GeometryPart& part : element.parts) {
    if (part.kind != GeometryPart::Kind::line) continue;
    const bool open = is_open_line(part);
    for (std::size_t i = 0; i < part.vertices.size(); ++i)
      if (!open || part.vertices[i].head<2>() != part.vertices.front().head<2>())
        if (!open || part.vertices[i].head<2>() != part.vertices.back().head<2>())
          joints_[hash_of(part.vertices[i])].through = true;
    if (!open) continue;
    for (const bool last : {false, true})
      if (const auto* neighbour = neighbour_of_end(part.vertices, last))
        add_end(last ? part.vertices.back() : part.vertices.front(), *neighbour);
  }
}

void LineJoints::mark(const MapElement& element, std::vector<std::vector<SharedVertex>>& into) const {
  into.resize(element.parts.size());
  for (std::size_t p = 0; p < element.parts.size(); ++p) {
    const GeometryPart& part = element.parts[p];
    into[p].resize(part.vertices.size());
    if (!is_open_line(part)) continue;
    for (const bool last : {false, true}) {
      const auto found = joints_.find(hash_of(last ? part.vertices.back() : part.vertices.front()));
      const auto* neighbour = neighbour_of_end(part.vertices, last);
      if (found == joints_.end() || !neighbour) continue;
      const Joint& joint = found->second;
      SharedVertex& end = last ? into[p].back() : into[p].front();
      end.joined = joint.ends > 1 || joint.through;
      if (joint.ends == 2 && !joint.through && joint.neighbours[0] == neighbour->head<2>())
        end.next = joint.neighbours[1];
    }
  }
}

}  // namespace waymark::importers
