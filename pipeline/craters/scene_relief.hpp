// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/grid.hpp"
#include "core/random.hpp"
#include "pipeline/craters/shaded_scene.hpp"
namespace waymark {

/// Height above the plain, in radii of the fresh rim, of craters worn by diffusion. `wear` is the diffusion
/// length in radii: 0 fresh, 0.5 a shallow dish.
class WornCraters {
 public:
  WornCraters();
  double height(double wear, double radii) const;  ///< 0 beyond kReach radii
  double crest(double wear) const;                 ///< radius of the worn crest, in radii of the fresh one
  static constexpr double kReach = 2.6, kMostWear = 0.5;

 private:
  std::vector<std::vector<float>> rows_;  // per wear, by radius
  std::vector<double> crests_;
};

/// Fractal noise, mean 0, standard deviation 1: every octave `persistence` times the one twice as long.
Grid<float> fractal_field(Random& random, int side, double longest, double shortest, double persistence);

/// Adds valleys, ridges, hills, hollows and ripples: what a detector must not take for craters.
void add_distractions(Grid<float>& heights, Random& random, double strength);

/// Adds craters, old ones first; returns where they are. `bright` rises where fresh ones threw out rock.
std::vector<KnownCrater> add_craters(Grid<float>& heights, Grid<float>& bright, Random& random);

}  // namespace waymark
