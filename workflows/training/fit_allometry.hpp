// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>
#include "importers/tables/measured_trees.hpp"
#include "pipeline/forest/allometry.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// A table of measured trees that stem diameters are fitted to.
struct AllometryRequest {
  std::string input;                    ///< any table with heights and diameters
  std::string output = {};              ///< .csv to write; empty: none
  importers::TreeColumns columns = {};  ///< empty names: found by their usual names
  std::int64_t min_trees = 20;          ///< species with fewer trees get no row of their own
};

/// Fits stem diameters to heights (and crown diameters), for all trees and by species. Throws Error{usage}
/// for fewer than 5 `min_trees`, Error{input} for too few trees, Error{output}. Messages: the number of
/// trees, and each row with its errors.
std::vector<pipeline::Allometry> fit_allometry(const AllometryRequest& request,
                                               const Callbacks& callbacks = {});

}  // namespace waymark::workflows
