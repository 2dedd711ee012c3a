// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
namespace waymark::test {

/// Writes a cone of 100 x 100 cells, 1000 m high at its middle, with one cell of no data in the north-west
/// corner. `west`, `north`: outer corner; `cell`: degrees; EPSG:4326.
void write_small_dem(const std::filesystem::path& path, double west, double north, double cell);

}  // namespace waymark::test
