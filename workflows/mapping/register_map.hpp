// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include "localization/registration/register_circles.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::workflows {

/// A map, and the catalogue of craters that places it.
struct RegisterRequest {
  std::string map = {};        ///< in metres: a projected or local CRS
  std::string catalogue = {};  ///< GeoPackage, CSV or any layer: positions and diameters of craters
  std::string result = {};     ///< map to write
  std::string columns = {};    ///< of the catalogue, as for an import
  std::string crs = {};        ///< of the new map; empty: the map's, else the catalogue's
  localization::CircleRules rules = {};
  std::string command_line = {};  ///< recorded in the new map
};

/// Registers a map by its craters and writes it with everything moved, and with all runs.
/// Throws Error{usage} for a request in conflict, Error{input} for a place that is not certain, Error{output}
/// before any work is done for a map that cannot be written.
/// Messages: the similarity with standard deviations, the probability of being wrong, what is left out.
localization::CircleRegistration register_map(const RegisterRequest& request,
                                              const Callbacks& callbacks = {});

}  // namespace waymark::workflows
