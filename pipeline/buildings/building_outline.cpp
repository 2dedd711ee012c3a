// SPDX-License-Identifier: Apache-2.0
#include "pipeline/buildings/building_outline.hpp"

#include "core/bytes.hpp"

namespace waymark::pipeline {

std::string Codec<std::vector<BuildingOutline>>::encode(const std::vector<BuildingOutline>& footprints) {
  ByteWriter out;
  out(static_cast<std::uint64_t>(footprints.size()));
  for (const BuildingOutline& f : footprints) {
    out(f.uid), out(f.source), out(f.roof), out(f.outline);
    out(static_cast<std::uint64_t>(f.rings.size()));
    for (const auto& ring : f.rings) {
      out(static_cast<std::uint64_t>(ring.size()));
      for (const Eigen::Vector2d& v : ring) out(v.x()), out(v.y());
    }
    out(f.height), out(f.area), out(f.slope), out(f.wall_sd), out(f.density), out(f.confidence);
  }
  return out.take();
}

std::vector<BuildingOutline> Codec<std::vector<BuildingOutline>>::decode(std::string_view bytes) {
  ByteReader in(bytes);
  std::vector<BuildingOutline> footprints(in.length(88));
  for (BuildingOutline& f : footprints) {
    in(f.uid), in(f.source), in(f.roof), in(f.outline);
    f.rings.resize(in.length(8));
    for (auto& ring : f.rings) {
      ring.resize(in.length(16));
      for (Eigen::Vector2d& v : ring) in(v.x()), in(v.y());
    }
    in(f.height), in(f.area), in(f.slope), in(f.wall_sd), in(f.density), in(f.confidence);
  }
  in.expect_end();
  return footprints;
}

}  // namespace waymark::pipeline
