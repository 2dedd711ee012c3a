// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "core/observation.hpp"
namespace waymark::pipeline {

/// Returns one observation as bytes; those of several may be put together.
std::string encode_observation(const Observation& observation);
/// Returns all observations of such bytes. Throws std::runtime_error on malformed bytes.
std::vector<Observation> decode_observations(std::string_view bytes);

}  // namespace waymark::pipeline
