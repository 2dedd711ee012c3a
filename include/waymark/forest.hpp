// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/forest/find_trees.hpp"
#include "pipeline/forest/stand_inventory.hpp"
#include "workflows/forest/inventory.hpp"
#include "workflows/training/fit_allometry.hpp"

/// \page forest_header waymark/forest.hpp
/// Trees in canopy models and figures of stands.
///
/// Count the stands of a map with inventory(), as `waymark inventory` does:
/// \snippet snippets/forest.cpp inventory
/// Count trees of your own with inventory():
/// \snippet snippets/forest.cpp stand
/// Find trees with find_trees():
/// \snippet snippets/forest.cpp trees
/// The canopy comes from a CanopySource:
/// \snippet snippets/forest.cpp canopy
/// Fit stem diameters to measured trees with fit_allometry():
/// \snippet snippets/forest.cpp allometry

/// \example snippets/forest.cpp
/// The excerpts of \ref forest_header as a program.
