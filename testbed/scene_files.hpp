// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "testbed/landing/flight.hpp"
namespace waymark::testbed {

/// Returns the camera file (docs/reference/camera_file.md). `exact`: with true poses and without standard
/// deviations.
std::string camera_file(const Scenario& scenario, const std::vector<Shot>& shots, bool exact);

/// Truth tables as CSV.
/// - `landmarks`: every rock and every crater still visible.
/// - `ignored`: craters too degraded or overprinted to count in evaluation.
/// - Columns: type, x, y, z, the features of both types (empty if the type has none), `images` (that show
///   all of it), `pixels` (maximum diameter in any of them), `shape` (rocks), `preserved` (craters).
struct TruthTables {
  std::string landmarks, ignored;
  std::string detections;  ///< image,type,x,y,diameter,major,minor,angle,landmark, per image
};
TruthTables truth_tables(const Scenario& scenario, const Scene& scene, const std::vector<Shot>& shots);

/// DEM of the site: the mean terrain of its cells, with correlated errors.
struct SimulatedDem {
  Grid<float> heights;
  double x0 = 0, y0 = 0, cell = 1;  ///< GridFrame of the centre of the first cell, metres
};
/// Draws the errors from the stream `errors` of the scene's seed.
SimulatedDem simulate_dem(const DemModel& model, const Scene& scene, std::string_view errors = "dem errors");

}  // namespace waymark::testbed
