// SPDX-License-Identifier: Apache-2.0
#include "testbed/scenario_sections.hpp"

namespace waymark::testbed {
namespace {

void describe_file(Scenario& s, OptionVisitor& field) {
  field("name", s.name, {.help = "Name of the site in the map"});
  field("crs", s.crs, {.help = "Coordinate reference system of the grid: local, or a projected one"});
  field("seed", s.seed, {.help = "Seed of the site", .min = 0});
}

void describe_ground(Scenario& s, OptionVisitor& field) {
  SiteModel& g = s.ground;
  field("cell", g.cell, {.help = "Cell size of the terrain, metres", .min = 0.01, .max = 1000});
  field("width", g.width,
        {.help = "Width east-west, metres; 0: the extent of the images", .min = 0, .max = 1e6});
  field("height", g.height,
        {.help = "Height north-south, metres; 0: the extent of the images", .min = 0, .max = 1e6});
  field("east", g.east, {.help = "Easting of the centre, metres"});
  field("north", g.north, {.help = "Northing of the centre, metres"});
  field("up", g.up, {.help = "Mean height, metres"});
}

void describe_relief(Scenario& s, OptionVisitor& field) {
  ReliefModel& r = s.ground.relief;
  field("rms", r.rms, {.help = "Standard deviation of the heights, metres", .min = 0, .max = 1e4});
  field("max_wavelength", r.longest,
        {.help = "Longest wavelength, metres", .min = 0.1, .max = 1e6, .formerly = "longest"});
  field("hurst", r.hurst, {.help = "Smoothness: 0.5 rough, 1 smooth", .min = 0.2, .max = 1.5});
  field("roughness", r.roughness,
        {.help = "Strength of the relief of a few cells and below; 1 continues the fractal",
         .min = 0,
         .max = 10});
  field("slope", r.slope, {.help = "Slope of the whole site, metres per metre", .min = 0, .max = 1});
  field("slope_azimuth", r.slope_azimuth, {.help = "Downhill direction of that slope, clockwise from north"});
  std::int64_t mountains = r.mountains;
  field("mountains", mountains, {.help = "Number of hills", .min = 0, .max = 1000});
  r.mountains = static_cast<int>(mountains);
  field("mountain_height", r.mountain_height,
        {.help = "Maximum height of a hill, metres", .min = 0, .max = 1e4});
  field("mountain_radius", r.mountain_radius,
        {.help = "Maximum radius of a hill, metres", .min = 1, .max = 1e5});
}

void describe_craters(Scenario& s, OptionVisitor& field) {
  CraterPopulation& c = s.ground.craters;
  field("density", c.density,
        {.help = "Density relative to the lunar equilibrium; 0: no craters", .min = 0, .max = 5});
  field("slope", c.slope,
        {.help = "Exponent of the cumulative size-frequency distribution", .min = 0.5, .max = 5});
  field("min_diameter", c.min_diameter, {.help = "Minimum crater diameter, metres", .min = 0.1, .max = 1e6});
  field("max_diameter", c.max_diameter, {.help = "Maximum crater diameter, metres", .min = 0.1, .max = 1e6});
  field("fresh", c.fresh, {.help = "Fraction of fresh craters", .min = 0, .max = 1});
  field("oldest_depth", c.oldest_depth,
        {.help = "Depth / diameter of the most degraded craters", .min = 0.005, .max = 0.19});
  field("infill", c.infill, {.help = "Fraction of craters with infilled floors", .min = 0, .max = 1});
  std::int64_t clusters = c.clusters;
  field("clusters", clusters, {.help = "Number of clusters of secondary craters", .min = 0, .max = 10000});
  c.clusters = static_cast<int>(clusters);
  field("elongation", c.elongation, {.help = "Maximum of 1 - minor / major axis", .min = 0, .max = 0.6});
}

void describe_rocks(Scenario& s, OptionVisitor& field) {
  RockPopulation& r = s.ground.rocks;
  field("k", r.k, {.help = "Fractional area covered by rocks (Golombek); 0: no rocks", .min = 0, .max = 0.5});
  field("min_diameter", r.min_diameter, {.help = "Minimum rock diameter, metres", .min = 0.01, .max = 100});
  field("max_diameter", r.max_diameter, {.help = "Maximum rock diameter, metres", .min = 0.01, .max = 100});
  field("clustering", r.clustering, {.help = "0: uniform, 1: fields and bare ground", .min = 0, .max = 1});
  field("on_rims", r.on_rims,
        {.help = "Additional rock density about fresh craters, in units of the mean", .min = 0, .max = 10});
  field("ellipsoids", r.ellipsoids, {.help = "Fraction of half ellipsoids", .min = 0, .max = 1});
  field("irregular", r.irregular, {.help = "Fraction of angular rocks", .min = 0, .max = 1});
  field("cylinders", r.cylinders, {.help = "Fraction of upright cylinders", .min = 0, .max = 1});
}

void describe_dunes(Scenario& s, OptionVisitor& field) {
  DuneModel& d = s.ground.dunes;
  field("cover", d.cover, {.help = "Fraction of the area covered by dunes", .min = 0, .max = 1});
  field("wavelength", d.wavelength, {.help = "Distance from crest to crest, metres", .min = 0.1, .max = 1e4});
  field("height", d.height, {.help = "Height from trough to crest, metres", .min = 0, .max = 1e3});
  field("wind", d.wind, {.help = "Direction the wind blows to, clockwise from north"});
  field("brightness", d.brightness,
        {.help = "Albedo relative to the surroundings: 0.1 is a tenth brighter", .min = -0.9, .max = 2});
}

void describe_outcrops(Scenario& s, OptionVisitor& field) {
  OutcropModel& o = s.ground.outcrops;
  field("cover", o.cover, {.help = "Fraction of the area that is bare rock", .min = 0, .max = 1});
  field("height", o.height, {.help = "Height of the scarps, metres", .min = 0, .max = 1e3});
  field("max_patch_size", o.longest,
        {.help = "Size of the largest patches, metres", .min = 0.1, .max = 1e5, .formerly = "longest"});
  field("brightness", o.brightness, {.help = "Albedo relative to the surroundings", .min = -0.9, .max = 3});
}

void describe_albedo(Scenario& s, OptionVisitor& field) {
  AlbedoModel& a = s.ground.albedo;
  field("mean", a.mean, {.help = "Normal albedo", .min = 0.01, .max = 1});
  field("variation", a.variation,
        {.help = "Standard deviation of the logarithm of the albedo", .min = 0, .max = 1});
  field("max_patch_size", a.longest,
        {.help = "Size of the largest patches, metres", .min = 0.1, .max = 1e6, .formerly = "longest"});
  field("rays", a.rays, {.help = "Relative brightness of fresh ejecta", .min = 0, .max = 2});
}

void describe_sun(Scenario& s, OptionVisitor& field) {
  Sun& sun = s.exposure.sun;
  field("azimuth", sun.azimuth, {.help = "Towards the sun, clockwise from north", .min = -360, .max = 360});
  field("elevation", sun.elevation, {.help = "Above the horizon", .min = 0.5, .max = 90});
  field("sd", sun.sd,
        {.help = "Standard deviation of the sun direction in the camera file", .min = 0, .max = 90});
}

void describe_picture(Scenario& s, OptionVisitor& field) {
  Exposure& e = s.exposure;
  const std::vector<std::string> names{"lambert", "lommel_seeliger", "lunar_lambert"};
  std::string photometry = names[static_cast<std::size_t>(e.photometry)];
  field("photometry", photometry, {.help = "Photometric function of the surface", .choices = names});
  for (std::size_t i = 0; i < names.size(); ++i)
    if (photometry == names[i]) e.photometry = static_cast<Photometry>(i);
  field("skylight", e.skylight, {.help = "Diffuse light relative to direct light", .min = 0, .max = 1});
  field("haze", e.haze, {.help = "Path radiance relative to sunlit ground", .min = 0, .max = 0.95});
  field("psf", e.psf_sd,
        {.help = "Standard deviation of the point spread function, pixels", .min = 0, .max = 10});
  field("read_noise", e.read_noise, {.help = "Read noise, fraction of full scale", .min = 0, .max = 1});
  field("shot_noise", e.shot_noise,
        {.help = "Shot noise at full scale, fraction of full scale", .min = 0, .max = 1});
  field("level", e.level, {.help = "Mean brightness, fraction of full scale", .min = 0.01, .max = 1});
  field("contrast", e.contrast, {.help = "Contrast stretch about the mean", .min = 0.1, .max = 20});
  field("exposure_time", e.exposure_time,
        {.help = "Seconds of exposure; the motion of a landing blurs its images", .min = 0, .max = 10});
  field("readout_time", e.readout_time,
        {.help = "Seconds from the first to the last row of a rolling shutter; 0: global shutter",
         .min = 0,
         .max = 10});
  std::int64_t samples = e.samples;
  field("samples", samples, {.help = "Rays per pixel and direction near rocks", .min = 1, .max = 8});
  e.samples = static_cast<int>(samples);
  field("bits", s.bits, {.help = "Bits per pixel: 8 or 16", .min = 8, .max = 16});
}

void describe_camera(Scenario& s, OptionVisitor& field) {
  Lens& l = s.lens;
  field("columns", l.columns, {.help = "Pixels across", .min = 1, .max = 20000});
  field("rows", l.rows, {.help = "Pixels down", .min = 1, .max = 20000});
  field("field_of_view", l.field_of_view,
        {.help = "Field of view across the columns", .min = 0.01, .max = 150});
  field("k1", l.k1, {.help = "Radial distortion, r^2"});
  field("k2", l.k2, {.help = "Radial distortion, r^4"});
  field("p1", l.p1, {.help = "Tangential distortion"});
  field("p2", l.p2, {.help = "Tangential distortion"});
  field("k3", l.k3, {.help = "Radial distortion, r^6"});
}

void describe_poses(Scenario& s, OptionVisitor& field) {
  field("position_sd", s.pose_errors.position_sd,
        {.help = "Position error of each coordinate, metres", .min = 0, .max = 1e3});
  field("attitude_sd", s.pose_errors.attitude_sd,
        {.help = "Attitude error about each camera axis", .min = 0, .max = 45});
}

void describe_heights(DemModel& dem, OptionVisitor& field) {
  field("height_sd", dem.height_sd, {.help = "Error of a height, metres", .min = 0, .max = 1e3});
  field("correlation", dem.correlation,
        {.help = "Correlation length of the errors, metres", .min = 0, .max = 1e5});
}

void describe_dem(Scenario& s, OptionVisitor& field) {
  field("cell", s.dem.cell, {.help = "Cell size, metres", .min = 0.01, .max = 1e4});
  describe_heights(s.dem, field);
}

void describe_orbital_dem(Scenario& s, OptionVisitor& field) {
  field("cell", s.orbital_dem.cell, {.help = "Cell size, metres; 0: no such DEM", .min = 0, .max = 1e4});
  describe_heights(s.orbital_dem, field);
}

}  // namespace

const std::vector<ScenarioSection>& scenario_sections() {
  static const std::vector<ScenarioSection> sections{
      {"", "The file", describe_file},
      {"ground", "Size and position of the site", describe_ground},
      {"relief", "Fractal relief and hills", describe_relief},
      {"craters", "Size-frequency distribution and degradation of craters", describe_craters},
      {"rocks", "Size-frequency distribution and shapes of rocks", describe_rocks},
      {"dunes", "Ripples and dunes", describe_dunes},
      {"outcrops", "Bare rock with scarps", describe_outcrops},
      {"albedo", "Albedo of the surface", describe_albedo},
      {"sun", "Direction of the sun", describe_sun},
      {"picture", "Illumination, atmosphere and sensor", describe_picture},
      {"camera", "Camera of all flights", describe_camera},
      {"pose_errors", "Errors of the poses in the camera file", describe_poses},
      {"forest", "A forest instead of a landing site", describe_forest},
      {"street", "A street of a town instead of a landing site", describe_street},
      {"hall", "A floor of a building instead of a landing site", describe_hall},
      {"dem", "DEM supplied with the images", describe_dem},
      {"orbital_dem", "Coarse DEM known before the landing", describe_orbital_dem},
  };
  return sections;
}

void describe_flight(Flight& f, OptionVisitor& field) {
  field("name", f.name, {.help = "Images are <name>_0001.png, ..."});
  field("path", f.path,
        {.help = "lines, or landing: a parachute, rockets and a sky crane, from the start to the end",
         .choices = {"lines", "landing"}});
  field("images", f.images,
        {.help = "Images on each line; of a landing, at equal times", .min = 1, .max = 100000});
  field("lines", f.lines, {.help = "Parallel lines", .min = 1, .max = 10000});
  field("line_spacing", f.line_spacing, {.help = "Spacing of lines, to the right, metres"});
  field("from_east", f.from_east, {.help = "Start of the first line, metres from the centre"});
  field("from_north", f.from_north, {.help = "Start of the first line, metres from the centre"});
  field("from_altitude", f.from_altitude, {.help = "Metres above the mean height", .min = 0.1, .max = 1e7});
  field("to_east", f.to_east, {.help = "End of the first line, metres from the centre"});
  field("to_north", f.to_north, {.help = "End of the first line, metres from the centre"});
  field("to_altitude", f.to_altitude, {.help = "Metres above the mean height", .min = 0.1, .max = 1e7});
  field("tilt", f.tilt, {.help = "Forward tilt of the view from nadir", .min = -80, .max = 80});
  field("attitude_sd", f.attitude_sd, {.help = "Standard deviation of the attitude", .min = 0, .max = 45});
  field("track_sd", f.track_sd, {.help = "Standard deviation of the path, metres", .min = 0, .max = 1e4});
  f.landing.describe(field);
  field("dust", f.dust,
        {.help = "Landing: optical depth of the dust that rockets raise, seen from the ground; 0: none",
         .min = 0,
         .max = 20});
  field("dust_altitude", f.dust_altitude,
        {.help = "Landing: metres above the mean height below which rockets raise dust",
         .min = 1,
         .max = 1000});
  field("heat_shield", f.heat_shield,
        {.help = "Landing: diameter of a heat shield that is released at the start, metres; 0: none",
         .min = 0,
         .max = 20});
  field("heat_shield_speed", f.heat_shield_speed,
        {.help = "Landing: metres per second by which the shield falls faster than the lander at its release",
         .min = 1,
         .max = 200});
}

}  // namespace waymark::testbed
