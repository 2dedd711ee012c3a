// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geodb/map_store.hpp"
#include "workflows/mapping/register_map.hpp"
namespace waymark::workflows {

/// Returns the place of a map in a catalogue of craters (`localization::register_circles`).
/// Throws Error{input} for a place that is not certain, Error{usage} for a catalogue in degrees.
MapPlace register_by_craters(const RegisterRequest& request, const geodb::MapStore& map);

}  // namespace waymark::workflows
