// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include "core/options.hpp"
namespace waymark::inline core {

/// The option `memory` of every stage and command that has one: data held at a time, which is read again when
/// it is needed. No result depends on it.
struct MemoryOption {
  std::int64_t megabytes = 512;

  std::int64_t bytes() const { return megabytes << 20; }

  void describe(OptionVisitor& option) {
    option("memory", megabytes,
           {.help = "Memory for decoded rasters, points or trees, megabytes",
            .min = 16,
            .max = 1e7,
            .affects_result = false});
  }
};

}  // namespace waymark::inline core
