// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include "localization/global/skyline_fit.hpp"
#include "localization/horizon_profile.hpp"
namespace waymark::localization {

/// Horizon seen by a robot, prepared for comparison with horizons of a DEM.
class SeenHorizon {
 public:
  explicit SeenHorizon(const HorizonProfile& profile);

  /// Direction of the horizon: bearing left of forward and elevation, rad.
  struct Ray {
    double bearing = 0, elevation = 0;
  };
  const std::vector<Ray>& rays() const { return rays_; }
  /// Returns the tangent of the highest elevation in each sector of equal width from forward to the left; NaN
  /// where none is known.
  const std::array<float, kHorizonSectors>& sectors() const { return sectors_; }
  double elevation_sd() const { return elevation_sd_; }
  double spacing() const { return spacing_; }  ///< rad, between rays
  double spread() const { return spread_; }    ///< rad, standard deviation of the elevations
  /// Returns the density, 1/rad, of a ray on an arbitrary horizon that is known up to the ray before it.
  double arbitrary(std::size_t ray) const { return arbitrary_[ray]; }
  /// Returns whether the horizon covers a third of a turn and has relief.
  bool is_usable() const;

 private:
  std::vector<Ray> rays_;
  std::array<float, kHorizonSectors> sectors_;
  std::vector<double> arbitrary_;  // of each ray
  double elevation_sd_ = 0, spacing_ = 0, mean_ = 0, spread_ = 0;
};

/// Returns the `max_count` best headings at each position as the function of the same name for tops does, by
/// comparing the horizon in all sectors. 40 us per position and thread.
std::vector<HorizonGuess> best_headings(std::span<const HorizonViewpoint> viewpoints, const SeenHorizon& seen,
                                        std::size_t max_count, const SkylineOptions& options);

/// Fits the pose near a guess that is off by about `place` metres to the whole horizon. `std::nullopt` if the
/// rays do not determine it.
/// - Least squares over rays through the DEM, with Cauchy's kernel.
/// - The variance of a ray is that of the sensor and of the heights at its horizon (height_sd).
/// - The error of the heights is height_sd or a part of it, whichever makes the horizon more probable.
/// - The chance of the fit compares each ray with an arbitrary horizon that goes on from the ray before it.
std::optional<SkylineFix> fit_profile(const SkylineScene& scene, const SeenHorizon& seen,
                                      const HorizonGuess& guess, double place);

}  // namespace waymark::localization
