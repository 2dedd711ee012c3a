// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/units.hpp"
namespace waymark {

/// Relief without landmarks: fractal noise (each octave an octave shorter and 2^-hurst lower) and mountains.
struct MadeRelief {
  double rms = 5;        ///< metres, over `longest`
  double longest = 600;  ///< metres, longest wavelength
  double hurst = 0.85;   ///< 0.5 rough, 1 smooth
  double roughness = 1;  ///< of the relief finer than a cell, seen only as shading; 1: continues the fractal
  double slope = 0;      ///< metres per metre, of the whole site, down towards `slope_azimuth`
  Degrees slope_azimuth{0};                            ///< clockwise from north
  int mountains = 0;                                   ///< hills of the height below
  double mountain_height = 60, mountain_radius = 150;  ///< metres; drawn between half and all of each
};

/// Impact craters. Cumulative number per square metre of diameters above D metres:
/// `density` x 0.08 D^-`slope`, which for slope 2 and density 1 is about the lunar equilibrium (Trask 1966).
struct CraterLaw {
  double density = 0.3;
  double slope = 2.1;
  double min_diameter = 4, max_diameter = 150;  ///< metres, rim to rim
  double fresh = 0.15;         ///< share with depth / diameter near 0.2 and blocky, sharp rims
  double oldest_depth = 0.03;  ///< depth / diameter of the most degraded
  double infill = 0.3;         ///< share with flat floors of sand
  int clusters = 2;            ///< swarms of secondary craters, shallow and drawn out
  double elongation = 0.12;    ///< 1 - minor / major, the greatest
};

/// Rocks. Cumulative fraction of area covered by rocks wider than D metres: k exp(-(1.79 + 0.152 / k) D)
/// (Golombek & Rapp 1997). k = 0.01 smooth, 0.07 typical of landers, 0.3 very rocky.
struct RockLaw {
  double k = 0.05;
  double min_diameter = 0.5, max_diameter = 6;  ///< metres
  double clustering = 0.6;                      ///< 0: everywhere alike; 1: fields and bare ground
  double on_rims = 1;  ///< extra density about fresh craters, in units of the mean density
  double ellipsoids = 0.4, irregular = 0.5, cylinders = 0.1;  ///< shares, made to sum to 1
};

/// Ripples and dunes across the wind.
struct DuneLaw {
  double cover = 0.15;      ///< share of the area
  double wavelength = 12;   ///< metres, crest to crest
  double height = 0.8;      ///< metres, trough to crest
  Degrees wind{120};        ///< blows towards, clockwise from north
  double brightness = 0.1;  ///< albedo against the ground's: +0.1 is a tenth brighter
};

/// Bright, knobby rock with scarps about it, standing above the regolith: what detectors should leave alone.
struct OutcropLaw {
  double cover = 0;         ///< share of the area
  double height = 1.5;      ///< metres, of the scarp
  double longest = 80;      ///< metres, of the largest patches
  double brightness = 0.3;  ///< albedo against the ground's
};

struct AlbedoLaw {
  double mean = 0.25;      ///< normal albedo
  double variation = 0.1;  ///< standard deviation of log albedo, over `longest`
  double longest = 300;    ///< metres
  double rays = 0.15;      ///< how much brighter the ejecta of the freshest craters are
};

/// A made piece of planet. Metres in a grid frame whose origin is the middle of the site.
struct MadeGround {
  double cell = 0.5;                   ///< metres, between nodes of the terrain
  double width = 600, height = 600;    ///< metres east-west, north-south
  double east = 0, north = 0, up = 0;  ///< of the middle, GridFrame
  MadeRelief relief;
  CraterLaw craters;
  RockLaw rocks;
  DuneLaw dunes;
  OutcropLaw outcrops;
  AlbedoLaw albedo;
};

}  // namespace waymark
