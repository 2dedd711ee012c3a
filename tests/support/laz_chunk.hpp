// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include "tests/support/laz_writer.hpp"
namespace waymark::test {

/// Returns the compressed bytes of one chunk.
std::string laz_chunk(std::span<const RawPoint> points, int format, int extra_bytes);

/// Returns the table of chunks with these sizes and, if they vary, numbers of points.
std::string laz_table(const std::vector<std::uint32_t>& bytes, const std::vector<std::uint32_t>& points,
                      bool variable);

}  // namespace waymark::test
