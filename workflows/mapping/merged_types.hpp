// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "workflows/mapping/loaded_map.hpp"
namespace waymark::workflows {

/// Returns the types of both maps: those of `a` in their order, then the others. A type of both has the
/// features and attributes of `a`, then those that only `b` has. Throws Error{input} with a hint if a feature
/// or attribute differs in unit, scale or kind, or a type in its evidence model or body.
TypeRegistry merge_types(const TypeRegistry& a, const TypeRegistry& b);

/// Gives the landmarks and observations of a map other types, which have all of its features and attributes.
void adopt_types(LoadedMap& map, const TypeRegistry& types);

}  // namespace waymark::workflows
