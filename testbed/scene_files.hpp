// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>
#include "testbed/landing/flight.hpp"
namespace waymark {

/// The camera file (docs/camera_file.md). `exact`: with the true poses and no standard deviations.
std::string camera_file(const Scenario& scenario, const std::vector<Shot>& shots, bool exact);

/// The job that makes a map of the files; names relative to its own place.
std::string job_file(const Scenario& scenario);

/// Truth lists as CSV. `landmarks`: every rock and every crater still to be seen. `ignored`: craters so worn
/// or overprinted that nobody is blamed for missing or praised for finding them. Columns: type, x, y, z, then
/// the features of both types (empty where the type has none), `images` (that show all of it), `pixels` (its
/// greatest diameter in any of them), then `shape` (rocks), `preserved` (craters).
struct TruthTables {
  std::string landmarks, ignored;
  std::string detections;  ///< image,type,x,y,diameter,major,minor,angle,landmark: as each image shows it
};
TruthTables truth_tables(const Scenario& scenario, const Scene& scene, const std::vector<Shot>& shots);

/// The DEM that is given away: the ground at its cells, with smooth errors.
struct GivenDem {
  Grid<float> heights;
  double x0 = 0, y0 = 0, cell = 1;  ///< GridFrame of the first cell's centre, metres
};
GivenDem given_dem(const Scenario& scenario, const Scene& scene);

}  // namespace waymark
