// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/image_source.hpp"
namespace waymark::pipeline {

/// Returns the central `side` x `side` pixels of an image, or all of a smaller one.
Pixels middle_of(const Pixels& image, std::int64_t side);

}  // namespace waymark::pipeline
