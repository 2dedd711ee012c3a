// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/grid.hpp"
#include "core/random.hpp"
#include "pipeline/craters/shaded_scene.hpp"
namespace waymark::pipeline {

/// Height above the plain of craters degraded by topographic diffusion (Soderblom 1970, Fassett & Thomson
/// 2014), in radii of the fresh rim. `diffusion_length` is the diffusion length in radii: 0 fresh, 0.5 a
/// shallow dish.
class DegradedCraters {
 public:
  DegradedCraters();
  double height(double diffusion_length, double radii) const;  ///< 0 beyond kReach radii
  double crest(
      double diffusion_length) const;  ///< radius of the degraded rim crest, in radii of the fresh one
  static constexpr double kReach = 2.6, kMaxDiffusionLength = 0.5;

 private:
  std::vector<std::vector<float>> rows_;  // per diffusion_length, by radius
  std::vector<double> crests_;
};

/// Returns fractal noise with mean 0 and standard deviation 1; each octave has `persistence` times the
/// amplitude of the one twice as long.
Grid<float> fractal_field(Random& random, int side, double longest, double shortest, double persistence);

/// Adds valleys, ridges, hills, hollows and ripples, which a detector must not report as craters.
void add_distractors(Grid<float>& heights, Random& random, double strength);

/// Adds craters, old ones first, and returns their positions. `bright` increases where fresh craters
/// ejected bright material.
std::vector<LabelledCrater> add_craters(Grid<float>& heights, Grid<float>& bright, Random& random);

}  // namespace waymark::pipeline
