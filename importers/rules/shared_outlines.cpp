// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/shared_outlines.hpp"

#include <set>

#include "importers/rules/vertex_hash.hpp"

namespace waymark::importers {
namespace {

// The same in both directions.
std::uint64_t hash_of_wall(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return mix_bits(hash_of(a) + hash_of(b));
}

}  // namespace

void SharedOutlines::add(const MapElement& element) {
  std::set<std::uint64_t> vertices, walls;  // an outline counts once, though it may touch itself
  for (const GeometryPart& part : element.parts) {
    if (part.kind != GeometryPart::Kind::outline) continue;
    for (std::size_t i = 0; i < part.vertices.size(); ++i) {
      vertices.insert(hash_of(part.vertices[i]));
      walls.insert(hash_of_wall(part.vertices[i], part.vertices[(i + 1) % part.vertices.size()]));
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
      flags[i] = {
          several(vertices_, hash_of(part.vertices[i])),
          several(walls_, hash_of_wall(part.vertices[i], part.vertices[(i + 1) % part.vertices.size()]))};
  }
  return all;
}

}  // namespace waymark::importers
