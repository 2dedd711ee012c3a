// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/observation.hpp"
namespace waymark::inline core {

/// Total order by content: type, source, position, then all other members. Equal only if all members are
/// equal.
bool comes_before(const Observation& a, const Observation& b);

}  // namespace waymark::inline core
