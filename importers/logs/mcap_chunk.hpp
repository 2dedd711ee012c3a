// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
namespace waymark::importers {

/// Returns the records of a compressed chunk of MCAP, `size` bytes. `compression` is "zstd" or "lz4" (the
/// frames of LZ4, not bare blocks). Throws std::runtime_error.
std::string unpacked_chunk(std::string_view compression, std::string_view bytes, std::uint64_t size);

}  // namespace waymark::importers
