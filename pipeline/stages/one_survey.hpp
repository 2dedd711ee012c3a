// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/error.hpp"
#include "geo/canopy_source.hpp"
namespace waymark::pipeline {

/// Throws Error{usage} if there are several surveys.
inline void require_one_survey(const Canopies& canopies, const char* stage) {
  if (canopies.size() != 1)
    throw Error(ErrorCode::usage, "buildings and poles of several surveys are not merged here", stage,
                "make a map of each survey, then `waymark merge` them");
}

}  // namespace waymark::pipeline
