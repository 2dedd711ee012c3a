// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/drive_settings.hpp"

namespace waymark::testbed {
namespace {

void describe_drive(DriveSettings& d, OptionVisitor& field) {
  field("vehicle", d.vehicle, {.help = "What drives", .choices = {"rover", "harvester"}});
  field(
      "route", d.route,
      {.help = "waypoints: those given; loop, lanes, wander: automatic; FILE.csv, .gpkg or .geojson: a route "
               "that `waymark route` planned, followed by the estimated pose"});
  field("length", d.length, {.help = "Length of an automatic route, metres", .min = 1, .max = 1e6});
  field("lane_spacing", d.lane_spacing, {.help = "Spacing of lanes, metres", .min = 2, .max = 1e4});
  field("margin", d.margin,
        {.help = "Minimum distance to the edge of the terrain, metres", .min = 2, .max = 1e5});
  field("speed", d.speed, {.help = "Speed, metres per second", .min = 0.01, .max = 20});
  field("clearance", d.clearance,
        {.help = "Minimum distance between the vehicle's centre and rocks, metres", .min = 0, .max = 50});
  field("max_slope", d.max_slope,
        {.help = "Maximum slope, metres per metre", .min = 0.01, .max = 2, .formerly = "steepest"});
  field("start_sd", d.start_sd,
        {.help = "Error of the start position in the log, metres", .min = 0, .max = 1e4});
  field("start_yaw_sd", d.start_yaw_sd,
        {.help = "Error of the start heading in the log", .min = 0, .max = 180});
  field("seed", d.seed,
        {.help = "Seed of the drive on the same site; -1: the seed of the scenario", .min = -1});
  field("truth_in_log", d.truth_in_log, {.help = "Write true poses to the log"});
  field("wheel_base", d.wheels.base,
        {.help = "Distance between front and rear axle, metres", .min = 0.1, .max = 20});
  field("wheel_track", d.wheels.track,
        {.help = "Distance between left and right wheels, metres", .min = 0.1, .max = 20});
  field("trees", d.trees,
        {.help = "CSV of real trees (x or x_coord, y or y_coord, dbh in cm or diameter in m, height) instead "
                 "of the scenario's forest"});
  field("stand", d.stand, {.help = "Use only rows of the table with this stand_id"});
  field("undergrowth", d.clutter.undergrowth, {.help = "Bushes per hectare of forest", .min = 0, .max = 1e5});
  field("branchy", d.clutter.branchy,
        {.help = "Fraction of trees with dead branches at scanner height", .min = 0, .max = 1});
}

void describe_odometry(DriveSettings& d, OptionVisitor& field) {
  OdometryModel& o = d.odometry;
  field("rate", o.rate, {.help = "Readings per second", .min = 2.5, .max = 200});
  field("slip", o.slip,
        {.help = "Fraction of the wheel distance lost on level ground", .min = 0, .max = 0.9});
  field("slip_per_slope", o.slip_per_slope,
        {.help = "Additional fraction lost per unit of slope", .min = 0, .max = 5});
  field(
      "slip_sd", o.slip_sd,
      {.help = "Standard deviation of the fraction lost, correlated over some metres", .min = 0, .max = 0.5});
  field("side_slip", o.side_slip,
        {.help = "Sideways speed per forward speed and sine of the roll", .min = 0, .max = 5});
  field("scale_sd", o.scale_sd,
        {.help = "Relative error of the wheel radius, per drive", .min = 0, .max = 0.5});
  field("speed_sd", o.speed_sd, {.help = "Relative noise of a speed", .min = 0, .max = 1});
  field("yaw_bias_sd", o.yaw_bias_sd, {.help = "Gyro bias per second, per drive", .min = 0, .max = 5});
  field("yaw_sd", o.yaw_sd, {.help = "Noise of the yaw per square root of a metre", .min = 0, .max = 20});
  field("perfect", o.perfect, {.help = "No slip and no noise"});
}

void describe_drive_laser(DriveSettings& d, OptionVisitor& field) {
  describe_laser(d.laser, field);
  field("height", d.laser_height,
        {.help = "Height above the ground, metres; 0: 0.35 for a rover, 2 for a harvester",
         .min = 0,
         .max = 50});
}

void describe_drive_scanner(DriveSettings& d, OptionVisitor& field) {
  describe_scanner(d.scanner, field);
}
void describe_drive_stereo(DriveSettings& d, OptionVisitor& field) {
  describe_stereo(d.stereo, field);
}
void describe_drive_camera(DriveSettings& d, OptionVisitor& field) {
  describe_bearing(d.camera, field);
}
void describe_drive_panorama(DriveSettings& d, OptionVisitor& field) {
  describe_panorama(d.panorama, field);
}

void describe_gnss(DriveSettings& d, OptionVisitor& field) {
  GnssModel& g = d.gnss;
  field("on", g.on, {.help = "Simulate GNSS positions"});
  field("every", g.every, {.help = "Seconds between fixes", .min = 0.01, .max = 1e4});
  field("sd", g.sd, {.help = "Noise of a coordinate, metres", .min = 0, .max = 1e3});
  field("bias_sd", g.bias_sd, {.help = "Correlated error, metres", .min = 0, .max = 1e3});
  field("bias_time", g.bias_time,
        {.help = "Correlation time of that error, seconds", .min = 0.1, .max = 1e6});
  field("dropouts", g.dropouts, {.help = "Fraction of fixes missing", .min = 0, .max = 1});
  field("perfect", g.perfect, {.help = "No error and no dropouts"});
}

void describe_crane(DriveSettings& d, OptionVisitor& field) {
  CraneModel& c = d.crane;
  field("reach", c.reach, {.help = "Metres", .min = 0, .max = 50});
  field("corridor", c.corridor,
        {.help = "Metres to each side of the route where all trees are felled", .min = 0, .max = 20});
  field("thinning", c.thinning,
        {.help = "Fraction of the other trees within reach that are felled", .min = 0, .max = 1});
  field("range_sd", c.range_sd, {.help = "Error of the crane range, metres", .min = 0, .max = 10});
  field("bearing_sd", c.bearing_sd, {.help = "Error of the crane bearing", .min = 0, .max = 45});
  field("diameter_sd", c.diameter_sd, {.help = "Error of the stem diameter, metres", .min = 0, .max = 1});
  field("height_sd", c.height_sd, {.help = "Error of the stem length, metres", .min = 0, .max = 10});
}

void describe_navigation(DriveSettings& d, OptionVisitor& field) {
  NavigationModel& n = d.navigation;
  field("map", n.map, {.help = "Map of landmarks by which the vehicle localizes, relative to the scenario"});
  field("method", n.method,
        {.help = "Method of `waymark localize`", .choices = {"ekf", "ukf", "pf", "odometry"}});
  field("sensor", n.sensor, {.help = "Sensor profile of the plan and the localizer"});
  field("hazards", n.hazards, {.help = "Hazard map (.tif) that new routes avoid, or none"});
  field("dem", n.dem,
        {.help = "Elevation model whose terrain hides landmarks when a route is planned again; empty: that "
                 "stored in the map"});
  field("vehicle", n.vehicle, {.help = "Vehicle that hazards are judged for: a name or a file"});
  field("limit_sigma", n.limit_sigma,
        {.help = "Largest standard deviation of the position, metres; 0: none", .min = 0, .max = 1e3});
  field("sd_factor", n.sd_factor,
        {.help = "Tolerated ratio of the estimated to the planned standard deviation", .min = 1, .max = 100});
  field("cell", n.cell, {.help = "Cells of the search for another route, metres", .min = 0.2, .max = 100});
  field("margin", n.margin, {.help = "Metres between the vehicle and an obstacle", .min = 0, .max = 20});
  field("replans", n.replans,
        {.help = "Most new routes before the vehicle gives up; 0: it keeps to its route",
         .min = 0,
         .max = 1e4});
  field("avoid", n.avoid, {.help = "Avoid obstacles that the vehicle's own sensors see"});
}

void describe_dynamics(DriveSettings& d, OptionVisitor& field) {
  DynamicsModel& m = d.dynamics;
  field("on", m.on,
        {.help = "Move a rigid body on wheels, with its suspension, over terrain and rocks: slip, sinking, "
                 "tipping over"});
  field("vehicle", m.vehicle,
        {.help = "Vehicle with a mass: a name of `waymark vehicles`, or a file; empty: that of the drive"});
  field("gravity", m.gravity, {.help = "Metres per second squared", .min = 0.01, .max = 30});
  m.soil.describe(field);
}

}  // namespace

const std::vector<DrivePart>& drive_parts() {
  static const std::vector<DrivePart> parts{
      {"", "A vehicle that drives over the site and measures", describe_drive},
      {"odometry", "Wheel slip and odometry errors", describe_odometry},
      {"laser", "Line scanner: one on a rover, two on a harvester", describe_drive_laser},
      {"scanner", "3-D scanner of a robot in a street or a hall", describe_drive_scanner},
      {"stereo", "Depth camera: a stereo pair or time of flight", describe_drive_stereo},
      {"camera", "Camera that measures bearings to landmarks", describe_drive_camera},
      {"panorama", "Skyline of the full circle", describe_drive_panorama},
      {"gnss", "GNSS positions", describe_gnss},
      {"crane", "Felling by a harvester", describe_crane},
      {"dynamics", "Rigid-body dynamics of the vehicle", describe_dynamics},
      {"navigation", "Driving a planned route by the estimated pose", describe_navigation},
  };
  return parts;
}

}  // namespace waymark::testbed
