// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// A scenario and where its files are written.
struct SimulateRequest {
  std::string scenario;                         ///< JSON file (docs/reference/scenario.md)
  std::string folder;                           ///< may exist
  std::optional<std::int64_t> seed = {};        ///< in place of the scenario's
  std::optional<std::int64_t> drive_seed = {};  ///< in place of that of the section drive
  bool drive_only = false;                      ///< write the drive and its truth, no DEM and no images
};

/// What was made.
struct SimulateResult {
  std::size_t images = 0, rocks = 0, craters = 0, trees = 0;
  std::size_t landmarks = 0;  ///< of a street or a hall
};

/// Makes a landing site, a forest, a street or a hall with its truth: DEM, images or laser points, cameras, a
/// job and tables. The same scenario and seed give the same bytes. Throws Error{usage} for a scenario that
/// lacks what is asked, Error{output} for a folder that cannot be written or holds images of another scene.
/// Messages: a summary of the drive, then of the site.
SimulateResult simulate(const SimulateRequest& request, const Callbacks& callbacks = {});

}  // namespace waymark::workflows
