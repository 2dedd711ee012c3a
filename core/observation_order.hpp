// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/observation.hpp"
namespace waymark::inline core {

/// Orders observations totally by content: type, source, position, then all other members. They are equal
/// only if all members are.
bool comes_before(const Observation& a, const Observation& b);

}  // namespace waymark::inline core
