// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <cstdlib>
#include <string>
namespace waymark::test {

/// Returns what is added to the seeds of made scenes: WAYMARK_SEED_OFFSET, 0 without it. With it a test
/// repeats its measurement on scenes that nothing was chosen on.
inline std::uint64_t seed_offset() {
  const char* offset = std::getenv("WAYMARK_SEED_OFFSET");
  return offset != nullptr ? std::stoull(offset) : 0;
}

}  // namespace waymark::test
