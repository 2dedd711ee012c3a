// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include "geo/dem_source.hpp"
namespace waymark::inline geo {

/// DEM as passed between stages.
using DemHandle = std::shared_ptr<const DemSource>;

}  // namespace waymark::inline geo
