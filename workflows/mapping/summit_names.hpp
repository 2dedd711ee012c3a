// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geodb/map_contents.hpp"
#include "importers/tables/place_names.hpp"
namespace waymark::workflows {

/// Sets the attribute `name` of mountain tops. A place names at most one top and a top has at most one name:
/// pairs within the largest distance are formed from the nearest one on, equal distances by prominence.
void name_summits(geodb::MapContents& contents, const importers::PlaceNames& names);

}  // namespace waymark::workflows
