// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/crown_shape.hpp"

#include "core/bytes.hpp"

namespace waymark {

std::string Codec<std::vector<CrownShape>>::encode(const std::vector<CrownShape>& crowns) {
  ByteWriter out;
  out(static_cast<std::uint64_t>(crowns.size()));
  for (const CrownShape& crown : crowns) {
    out(crown.uid), out(crown.source);
    out(crown.top.x()), out(crown.top.y());
    out(crown.height), out(crown.area), out(crown.diameter);
    out(static_cast<std::uint64_t>(crown.ring.size()));
    for (const Eigen::Vector2d& point : crown.ring) out(point.x()), out(point.y());
  }
  return out.take();
}

std::vector<CrownShape> Codec<std::vector<CrownShape>>::decode(std::string_view bytes) {
  ByteReader in(bytes);
  std::vector<CrownShape> crowns(in.length(64));
  for (CrownShape& crown : crowns) {
    in(crown.uid), in(crown.source);
    in(crown.top.x()), in(crown.top.y());
    in(crown.height), in(crown.area), in(crown.diameter);
    crown.ring.resize(in.length(16));
    for (Eigen::Vector2d& point : crown.ring) in(point.x()), in(point.y());
  }
  in.expect_end();
  return crowns;
}

}  // namespace waymark
