// SPDX-License-Identifier: Apache-2.0
#include "testbed/scenario_sections.hpp"

namespace waymark {
namespace {

void describe_file(Scenario& s, OptionVisitor& field) {
  field("name", s.name, {.help = "What the site is called in the map"});
  field("crs", s.crs, {.help = "Coordinate reference system of the grid: local, or a projected one"});
  field("seed", s.seed, {.help = "Another seed, another site of the same kind", .min = 0});
}

void describe_ground(Scenario& s, OptionVisitor& field) {
  MadeGround& g = s.ground;
  field("cell", g.cell, {.help = "Metres between the heights of the ground", .min = 0.01, .max = 1000});
  field("width", g.width, {.help = "Metres east-west; 0: as much as the images see", .min = 0, .max = 1e6});
  field("height", g.height,
        {.help = "Metres north-south; 0: as much as the images see", .min = 0, .max = 1e6});
  field("east", g.east, {.help = "Easting of the middle, metres"});
  field("north", g.north, {.help = "Northing of the middle, metres"});
  field("up", g.up, {.help = "Mean height, metres"});
}

void describe_relief(Scenario& s, OptionVisitor& field) {
  MadeRelief& r = s.ground.relief;
  field("rms", r.rms, {.help = "Standard deviation of the heights, metres", .min = 0, .max = 1e4});
  field("longest", r.longest, {.help = "Longest wavelength, metres", .min = 0.1, .max = 1e6});
  field("hurst", r.hurst, {.help = "Smoothness: 0.5 rough, 1 smooth", .min = 0.2, .max = 1.5});
  field("roughness", r.roughness,
        {.help = "Strength of the relief of a few cells and below; 1 continues the fractal",
         .min = 0,
         .max = 10});
  field("slope", r.slope, {.help = "Fall of the whole site, metres per metre", .min = 0, .max = 1});
  field("slope_azimuth", r.slope_azimuth, {.help = "Direction of that fall, clockwise from north"});
  std::int64_t mountains = r.mountains;
  field("mountains", mountains, {.help = "Number of hills", .min = 0, .max = 1000});
  r.mountains = static_cast<int>(mountains);
  field("mountain_height", r.mountain_height, {.help = "Of the greatest hill, metres", .min = 0, .max = 1e4});
  field("mountain_radius", r.mountain_radius, {.help = "Of the widest hill, metres", .min = 1, .max = 1e5});
}

void describe_craters(Scenario& s, OptionVisitor& field) {
  CraterLaw& c = s.ground.craters;
  field("density", c.density, {.help = "Share of the lunar equilibrium; 0: no craters", .min = 0, .max = 5});
  field("slope", c.slope, {.help = "Exponent of the cumulative size law", .min = 0.5, .max = 5});
  field("min_diameter", c.min_diameter, {.help = "Smallest crater, metres", .min = 0.1, .max = 1e6});
  field("max_diameter", c.max_diameter, {.help = "Widest crater, metres", .min = 0.1, .max = 1e6});
  field("fresh", c.fresh, {.help = "Share of craters that are fresh", .min = 0, .max = 1});
  field("oldest_depth", c.oldest_depth,
        {.help = "Depth / diameter of the most worn", .min = 0.005, .max = 0.19});
  field("infill", c.infill, {.help = "Share of craters with floors of sand", .min = 0, .max = 1});
  std::int64_t clusters = c.clusters;
  field("clusters", clusters, {.help = "Swarms of secondary craters", .min = 0, .max = 10000});
  c.clusters = static_cast<int>(clusters);
  field("elongation", c.elongation, {.help = "1 - minor / major axis, the greatest", .min = 0, .max = 0.6});
}

void describe_rocks(Scenario& s, OptionVisitor& field) {
  RockLaw& r = s.ground.rocks;
  field("k", r.k, {.help = "Share of the ground under rocks (Golombek); 0: no rocks", .min = 0, .max = 0.5});
  field("min_diameter", r.min_diameter, {.help = "Smallest rock, metres", .min = 0.01, .max = 100});
  field("max_diameter", r.max_diameter, {.help = "Widest rock, metres", .min = 0.01, .max = 100});
  field("clustering", r.clustering,
        {.help = "0: everywhere alike, 1: fields and bare ground", .min = 0, .max = 1});
  field("on_rims", r.on_rims, {.help = "Extra rocks about fresh craters", .min = 0, .max = 10});
  field("ellipsoids", r.ellipsoids, {.help = "Share of half ellipsoids", .min = 0, .max = 1});
  field("irregular", r.irregular, {.help = "Share of angular stones", .min = 0, .max = 1});
  field("cylinders", r.cylinders, {.help = "Share of upright cylinders", .min = 0, .max = 1});
}

void describe_dunes(Scenario& s, OptionVisitor& field) {
  DuneLaw& d = s.ground.dunes;
  field("cover", d.cover, {.help = "Share of the ground under dunes", .min = 0, .max = 1});
  field("wavelength", d.wavelength, {.help = "From crest to crest, metres", .min = 0.1, .max = 1e4});
  field("height", d.height, {.help = "From trough to crest, metres", .min = 0, .max = 1e3});
  field("wind", d.wind, {.help = "Where the wind blows to, clockwise from north"});
  field("brightness", d.brightness,
        {.help = "Against the ground: 0.1 is a tenth brighter", .min = -0.9, .max = 2});
}

void describe_outcrops(Scenario& s, OptionVisitor& field) {
  OutcropLaw& o = s.ground.outcrops;
  field("cover", o.cover, {.help = "Share of the ground that is bare rock", .min = 0, .max = 1});
  field("height", o.height, {.help = "Of its scarps, metres", .min = 0, .max = 1e3});
  field("longest", o.longest, {.help = "Largest patches, metres", .min = 0.1, .max = 1e5});
  field("brightness", o.brightness, {.help = "Against the ground", .min = -0.9, .max = 3});
}

void describe_albedo(Scenario& s, OptionVisitor& field) {
  AlbedoLaw& a = s.ground.albedo;
  field("mean", a.mean, {.help = "Normal albedo", .min = 0.01, .max = 1});
  field("variation", a.variation, {.help = "Standard deviation of its logarithm", .min = 0, .max = 1});
  field("longest", a.longest, {.help = "Widest patches, metres", .min = 0.1, .max = 1e6});
  field("rays", a.rays, {.help = "How much brighter fresh ejecta are", .min = 0, .max = 2});
}

void describe_sun(Scenario& s, OptionVisitor& field) {
  Sun& sun = s.exposure.sun;
  field("azimuth", sun.azimuth, {.help = "Towards the sun, clockwise from north", .min = -360, .max = 360});
  field("elevation", sun.elevation, {.help = "Above the horizon", .min = 0.5, .max = 90});
  field("sd", sun.sd, {.help = "What the camera file says about its error", .min = 0, .max = 90});
}

void describe_picture(Scenario& s, OptionVisitor& field) {
  Exposure& e = s.exposure;
  const std::vector<std::string> names{"lambert", "lommel_seeliger", "lunar_lambert"};
  std::string photometry = names[static_cast<std::size_t>(e.photometry)];
  field("photometry", photometry, {.help = "How the ground scatters light", .choices = names});
  for (std::size_t i = 0; i < names.size(); ++i)
    if (photometry == names[i]) e.photometry = static_cast<Photometry>(i);
  field("skylight", e.skylight, {.help = "Diffuse light as a share of the sun's", .min = 0, .max = 1});
  field("haze", e.haze, {.help = "Share of the air's own light", .min = 0, .max = 0.95});
  field("psf", e.psf_sd, {.help = "Standard deviation of the point spread, pixels", .min = 0, .max = 10});
  field("read_noise", e.read_noise, {.help = "Share of the full scale", .min = 0, .max = 1});
  field("shot_noise", e.shot_noise, {.help = "At full scale, share of it", .min = 0, .max = 1});
  field("level", e.level, {.help = "Mean brightness, share of the full scale", .min = 0.01, .max = 1});
  field("contrast", e.contrast, {.help = "Stretch about the mean", .min = 0.1, .max = 20});
  std::int64_t samples = e.samples;
  field("samples", samples,
        {.help = "Rays per pixel and direction where rocks are near", .min = 1, .max = 8});
  e.samples = static_cast<int>(samples);
  field("bits", s.bits, {.help = "Of a pixel: 8 or 16", .min = 8, .max = 16});
}

void describe_camera(Scenario& s, OptionVisitor& field) {
  Lens& l = s.lens;
  field("columns", l.columns, {.help = "Pixels across", .min = 1, .max = 20000});
  field("rows", l.rows, {.help = "Pixels down", .min = 1, .max = 20000});
  field("field_of_view", l.field_of_view, {.help = "Across the columns", .min = 0.01, .max = 150});
  field("k1", l.k1, {.help = "Radial distortion, r^2"});
  field("k2", l.k2, {.help = "Radial distortion, r^4"});
  field("p1", l.p1, {.help = "Tangential distortion"});
  field("p2", l.p2, {.help = "Tangential distortion"});
  field("k3", l.k3, {.help = "Radial distortion, r^6"});
}

void describe_poses(Scenario& s, OptionVisitor& field) {
  field("position_sd", s.pose_errors.position_sd,
        {.help = "Error of each coordinate, metres", .min = 0, .max = 1e3});
  field("attitude_sd", s.pose_errors.attitude_sd,
        {.help = "Error about each camera axis", .min = 0, .max = 45});
}

void describe_dem(Scenario& s, OptionVisitor& field) {
  field("cell", s.dem.cell, {.help = "Metres between its heights", .min = 0.01, .max = 1e4});
  field("height_sd", s.dem.height_sd, {.help = "Error of a height, metres", .min = 0, .max = 1e3});
  field("correlation", s.dem.correlation, {.help = "Metres over which errors agree", .min = 0, .max = 1e5});
}

}  // namespace

const std::vector<ScenarioSection>& scenario_sections() {
  static const std::vector<ScenarioSection> sections{
      {"", "The file", describe_file},
      {"ground", "Size and place of the site", describe_ground},
      {"relief", "Fractal relief and hills", describe_relief},
      {"craters", "Size law and wear of the craters", describe_craters},
      {"rocks", "Size law and shapes of the rocks", describe_rocks},
      {"dunes", "Ripples and dunes", describe_dunes},
      {"outcrops", "Bare rock with scarps", describe_outcrops},
      {"albedo", "Brightness of the ground", describe_albedo},
      {"sun", "Where the light comes from", describe_sun},
      {"picture", "Light, air and sensor", describe_picture},
      {"camera", "The lens of every flight", describe_camera},
      {"pose_errors", "What the camera file gets wrong", describe_poses},
      {"forest", "A forest instead of a landing site", describe_forest},
      {"dem", "The elevation model given to the map maker", describe_dem},
  };
  return sections;
}

void describe_flight(Flight& f, OptionVisitor& field) {
  field("name", f.name, {.help = "Images are <name>_0001.png, ..."});
  field("images", f.images, {.help = "Images on each line", .min = 1, .max = 100000});
  field("lines", f.lines, {.help = "Parallel lines", .min = 1, .max = 10000});
  field("line_spacing", f.line_spacing, {.help = "Metres between lines, to the right"});
  field("from_east", f.from_east, {.help = "Start of the first line, metres from the middle"});
  field("from_north", f.from_north, {.help = "Start of the first line, metres from the middle"});
  field("from_altitude", f.from_altitude, {.help = "Metres above the mean height", .min = 0.1, .max = 1e7});
  field("to_east", f.to_east, {.help = "End of the first line, metres from the middle"});
  field("to_north", f.to_north, {.help = "End of the first line, metres from the middle"});
  field("to_altitude", f.to_altitude, {.help = "Metres above the mean height", .min = 0.1, .max = 1e7});
  field("tilt", f.tilt, {.help = "Of the view, from straight down forwards", .min = -80, .max = 80});
  field("attitude_sd", f.attitude_sd, {.help = "How much the attitude wavers", .min = 0, .max = 45});
  field("track_sd", f.track_sd, {.help = "How much the path wavers, metres", .min = 0, .max = 1e4});
}

}  // namespace waymark
