// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "pipeline/engine/codec.hpp"
namespace waymark::test {

/// Artifact unknown to the engine: the summits with a station.
struct Stations {
  std::vector<std::string> uids;
};

}  // namespace waymark::test

namespace waymark::pipeline {

/// Encodes one uid per line.
template <>
struct Codec<test::Stations> {
  static std::string encode(const test::Stations& stations) {
    std::string lines;
    for (const auto& uid : stations.uids) lines += uid + '\n';
    return lines;
  }
  static test::Stations decode(std::string_view lines) {
    test::Stations stations;
    for (std::size_t end; (end = lines.find('\n')) != lines.npos; lines.remove_prefix(end + 1))
      stations.uids.emplace_back(lines.substr(0, end));
    return stations;
  }
};

}  // namespace waymark::pipeline
