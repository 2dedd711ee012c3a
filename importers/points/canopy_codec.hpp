// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/canopy_source.hpp"
#include "pipeline/engine/codec.hpp"
namespace waymark::importers {
std::string encode_canopies(const Canopies& canopies);
Canopies decode_canopies(std::string_view bytes);
}  // namespace waymark::importers

namespace waymark::pipeline {

/// Stores canopies as their recipes; decoding opens the files again. Only results of import_canopy and
/// import_points can be encoded (std::logic_error).
template <>
struct Codec<Canopies> {
  static std::string encode(const Canopies& canopies) { return importers::encode_canopies(canopies); }
  static Canopies decode(std::string_view bytes) { return importers::decode_canopies(bytes); }
};

}  // namespace waymark::pipeline
