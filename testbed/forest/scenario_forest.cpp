// SPDX-License-Identifier: Apache-2.0
#include "testbed/scenario_sections.hpp"

namespace waymark::testbed {

void describe_forest(Scenario& s, OptionVisitor& field) {
  ForestModel& f = s.forest;
  field("width", f.width, {.help = "Metres east-west", .min = 10, .max = 1e5});
  field("height", f.height, {.help = "Metres north-south", .min = 10, .max = 1e5});
  field("density", f.density, {.help = "Stems per hectare from 7 cm DBH, first stand", .min = 0, .max = 1e4});
  field("density_to", f.density_to,
        {.help = "Stems per hectare of the last stand, geometric in between; 0: as the first",
         .min = 0,
         .max = 1e4});
  field("stands", f.stands, {.help = "Number of stands, strips from west to east", .min = 1, .max = 1000});
  field("pattern", f.pattern,
        {.help = "Spatial pattern of the stems", .choices = {"poisson", "clustered", "rows"}});
  field("clearance", f.clearance, {.help = "Minimum stem distance, metres", .min = 0, .max = 20});
  field("cluster_radius", f.cluster_radius, {.help = "Radius of a cluster, metres", .min = 0.1, .max = 100});
  field("cluster_size", f.cluster_size, {.help = "Mean number of trees of a cluster", .min = 1, .max = 1000});
  field(
      "row_jitter", f.row_jitter,
      {.help = "Standard deviation of a planted tree about its lattice point, metres", .min = 0, .max = 10});
  field("conifers", f.conifers, {.help = "Fraction of conifers", .min = 0, .max = 1});
  field("mean_dbh", f.mean_dbh,
        {.help = "Mean stem diameter of the first stand, metres; denser stands have thinner stems",
         .min = 0.08,
         .max = 1});
  field("dbh_shape", f.dbh_shape,
        {.help = "Weibull shape of the diameters: 1 uneven-aged, 4 a plantation", .min = 0.8, .max = 20});
  field("understory", f.understory, {.help = "Trees per hectare below 7 cm DBH", .min = 0, .max = 1e5});
  field("cell", f.cell, {.help = "Cell size of the rasters, metres", .min = 0.1, .max = 5});
  field("pulses", f.pulses, {.help = "Laser pulses per square metre", .min = 0.1, .max = 500});
  field("range_sd", f.range_sd, {.help = "Error of a return's height, metres", .min = 0, .max = 5});
  field("position_sd", f.position_sd,
        {.help = "Error of a return's horizontal position, metres",
         .min = 0,
         .max = 5,
         .formerly = "place_sd"});
  field("dtm_sd", f.dtm_sd, {.help = "Correlated error of the terrain model, metres", .min = 0, .max = 5});
  field("points", f.points, {.help = "Write the point cloud"});
}

}  // namespace waymark::testbed
