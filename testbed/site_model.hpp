// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/units.hpp"
namespace waymark::testbed {

/// Relief without landmarks: fractal noise (each octave half as long and 2^-hurst as high) and mountains.
struct ReliefModel {
  double rms = 5;        ///< metres, over `longest`
  double longest = 600;  ///< metres, longest wavelength
  double hurst = 0.85;   ///< 0.5 rough, 1 smooth
  double roughness = 1;  ///< of relief finer than a cell, visible only as shading; 1: continues the fractal
  double slope = 0;      ///< metres per metre, of the whole site, down towards `slope_azimuth`
  Degrees slope_azimuth{0};                            ///< clockwise from north
  int mountains = 0;                                   ///< number of hills
  double mountain_height = 60, mountain_radius = 150;  ///< metres; drawn from half to the full value
};

/// Crater population. Cumulative number per square metre of diameters above D metres: `density` x 0.08
/// D^-`slope`; slope 2 and density 1 is about the lunar equilibrium (Trask 1966).
struct CraterPopulation {
  double density = 0.3;
  double slope = 2.1;
  double min_diameter = 4, max_diameter = 150;  ///< metres, rim to rim
  double fresh = 0.15;         ///< fraction with depth / diameter near 0.2 and sharp, blocky rims
  double oldest_depth = 0.03;  ///< depth / diameter of the most degraded craters
  double infill = 0.3;         ///< fraction with flat, infilled floors
  int clusters = 2;            ///< clusters of secondary craters, shallow and elongated
  double elongation = 0.12;    ///< maximum of 1 - minor / major
};

/// Rock population. Cumulative fractional area covered by rocks wider than D metres: k exp(-(1.79 + 0.152 /
/// k) D) (Golombek & Rapp 1997). k = 0.01 smooth, 0.07 typical of landing sites, 0.3 very rocky.
struct RockPopulation {
  double k = 0.05;
  double min_diameter = 0.5, max_diameter = 6;  ///< metres
  double clustering = 0.6;                      ///< 0: uniform; 1: fields and bare ground
  double on_rims = 1;  ///< additional density about fresh craters, in units of the mean density
  double ellipsoids = 0.4, irregular = 0.5, cylinders = 0.1;  ///< fractions, normalised to sum 1
};

/// Ripples and dunes transverse to the wind.
struct DuneModel {
  double cover = 0.15;      ///< fraction of the area
  double wavelength = 12;   ///< metres, crest to crest
  double height = 0.8;      ///< metres, trough to crest
  Degrees wind{120};        ///< direction the wind blows to, clockwise from north
  double brightness = 0.1;  ///< albedo relative to the surroundings: +0.1 is a tenth brighter
};

/// Outcrops: bright, knobby rock with scarps above the regolith, which detectors must not report.
struct OutcropModel {
  double cover = 0;         ///< fraction of the area
  double height = 1.5;      ///< metres, of the scarp
  double longest = 80;      ///< metres, of the largest patches
  double brightness = 0.3;  ///< albedo relative to the surroundings
};

struct AlbedoModel {
  double mean = 0.25;      ///< normal albedo
  double variation = 0.1;  ///< standard deviation of log albedo, over `longest`
  double longest = 300;    ///< metres
  double rays = 0.15;      ///< relative brightness of the ejecta of the freshest craters
};

/// Parameters of a synthetic planetary site. Metres in a grid frame whose origin is the centre of the site.
struct SiteModel {
  double cell = 0.5;                   ///< metres, between nodes of the terrain
  double width = 600, height = 600;    ///< metres east-west, north-south
  double east = 0, north = 0, up = 0;  ///< of the centre, GridFrame
  ReliefModel relief;
  CraterPopulation craters;
  RockPopulation rocks;
  DuneModel dunes;
  OutcropModel outcrops;
  AlbedoModel albedo;
};

}  // namespace waymark::testbed
