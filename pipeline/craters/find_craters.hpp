// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <optional>
#include <vector>
#include "core/detection.hpp"
#include "core/units.hpp"
#include "geo/dem_source.hpp"
#include "geo/image_source.hpp"
namespace waymark::pipeline {

struct ReliefVerifier;

/// How craters are found.
enum class CraterMethod {
  bowl,   ///< correlation with shaded bowls, rim refinement, verification by a trained model
  edges,  ///< lit and shaded rim edges paired along the light (Cheng, Johnson, Matthies, Olson 2003)
};

/// Parameters of the crater search in one image.
struct CraterSearch {
  CraterMethod method = CraterMethod::bowl;
  TypeId type = 0;  ///< id of the landmark type `crater`, copied into the detections
  /// Towards the sun in the image, from x (right) towards y (down). Unset: estimated from the craters.
  std::optional<Radians> sun_angle = {};
  double min_diameter = 8;      ///< pixels, >= 6
  double max_diameter = 0;      ///< pixels; 0: 0.6 times the image's shorter side
  double min_confidence = 0.5;  ///< candidates below are discarded; 0 keeps all
  bool verify = true;           ///< false: use the correlation alone, without the trained model
  bool second_opinion = true;   ///< ask the verifier trained on measured relief, too, if `verify`
  const ReliefVerifier* verifier = nullptr;  ///< asked instead of the shipped one; null: the shipped one
};

/// Returns the craters of an image by descending confidence (ties by position), no two with the same rim.
/// - The outline is the ellipse of the rim crest.
/// - NaN pixels are no data; craters with more than a third of their square missing are not found.
/// - An image smaller than 16 px or without contrast has no craters.
/// Throws Error{usage} for diameters out of order or a sun angle that is not finite. Deterministic; about 2
/// Mpx/s on one core.
std::vector<Detection> find_craters(const Pixels& image, const CraterSearch& search);

/// Direction towards the sun under which craters (not domes) correlate best.
struct CraterSunAngle {
  Radians angle;  ///< in the image, from x towards y, (-pi, pi]
  Radians sd;     ///< spread of the directions of the strongest craters
  int craters;    ///< number that agree
  bool sure;  ///< these are of many sizes, as craters are; rocks resemble small ones under the opposite sun
};

/// `std::nullopt` if fewer than three clear bowls are visible. Relief in one image is ambiguous by half a
/// turn (domes and rocks under the opposite sun look the same): craters are assumed to outnumber domes among
/// the large ones.
std::optional<CraterSunAngle> estimate_crater_sun_angle(const Pixels& image);

/// Parameters of the crater search in a window of a DEM.
struct DemCraterSearch {
  double cell_width = 1, cell_height = 1;  ///< metres, > 0
  double min_diameter = 9;                 ///< in cells of the coarser direction, >= 6
  double max_diameter = 0;                 ///< in cells; 0: 0.6 times the window's shorter side
  double min_confidence = 0.5;
};

/// Crater of a DEM. Horizontal lengths are in metres.
struct DemCrater {
  double column = 0, row = 0;   ///< centre; (0, 0) is the centre of the window's first cell
  double major = 0, minor = 0;  ///< full axes of the rim crest, metres
  double angle = 0;             ///< of the major axis, radians from x (east) towards y (south), (-pi/2, pi/2]
  double centre_sd = 0;         ///< of either coordinate, metres
  double diameter_sd = 0;       ///< metres
  double rim_height = 0;        ///< median height of the rim crest, metres
  double depth = 0, depth_sd = 0;  ///< median rim to floor, metres
  double confidence = 1;           ///< calibrated probability, (0, 1]

  double diameter() const { return std::sqrt(major * minor); }
};

/// Returns the craters whose centres lie in the window, by descending confidence. Throws Error{usage} for
/// sizes out of order.
/// - Cells without height are no data.
/// - Bowls are correlated over scales, then the rim is compared with the floor along 24 azimuths.
/// - Craters with depth / diameter below 0.02 are not found; lunar maria have them down to 0.003.
std::vector<DemCrater> find_craters(const HeightWindow& heights, const DemCraterSearch& search);

}  // namespace waymark::pipeline
