// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/dem_handle.hpp"
#include "pipeline/engine/codec.hpp"
namespace waymark::importers {
std::string encode_dem(const DemHandle& dem);
DemHandle decode_dem(std::string_view bytes);
}  // namespace waymark::importers

namespace waymark::pipeline {

/// Stores a DEM as its recipe: files, policy, CRS. Decoding opens the headers again, so shards on other
/// machines read the rasters themselves. Only a result of import_dem, or level ground (PlaneDem), can be
/// encoded (std::logic_error).
template <>
struct Codec<DemHandle> {
  static std::string encode(const DemHandle& dem) { return importers::encode_dem(dem); }
  static DemHandle decode(std::string_view bytes) { return importers::decode_dem(bytes); }
};

}  // namespace waymark::pipeline
