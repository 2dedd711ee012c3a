// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <vector>
#include "core/units.hpp"
#include "geo/image_source.hpp"
#include "pipeline/craters/crater_candidate.hpp"
namespace waymark::pipeline {

inline constexpr int kPatchSide = 20;              ///< samples
inline constexpr double kPatchReach = 1.6;         ///< radii from the middle to the edge
inline constexpr int kHogCells = 5, kHogBins = 8;  ///< cells per side, directions per turn
inline constexpr int kThumbSide = 10;              ///< the patch, 2 x 2 means
inline constexpr int kCraterFeatures = kThumbSide * kThumbSide + kHogCells * kHogCells * kHogBins + 3;

/// Inputs of the dense part of the model for one candidate, from a patch turned so that the sun is towards
/// +x:
/// - thumbnail of brightness with zero mean and unit deviation,
/// - histogram of oriented gradients (Dalal & Triggs 2005),
/// - correlation, contrast over noise, and size.
using CraterFeatures = std::array<float, kCraterFeatures>;

inline constexpr int kWidePatchSide = 24;       ///< samples
inline constexpr double kWidePatchReach = 2.2;  ///< radii from the middle to the edge
inline constexpr int kScalarInputs = 3;

/// Inputs of the convolutional part of the model: a wider patch, and correlation, contrast over noise and
/// size. Brightness has zero mean and unit deviation over 1.6 radii and is clipped to 3.
struct WidePatch {
  std::array<float, kWidePatchSide * kWidePatchSide> patch{};
  std::array<float, kScalarInputs> scalars{};
};

/// Scales to zero mean and unit deviation over the inner 1.6 radii, clips to 3, and returns the original
/// deviation.
double normalise(std::array<float, kWidePatchSide * kWidePatchSide>& patch);

/// Samples patches of any size from an image pyramid of octaves, so that samples are about one pixel apart.
/// Cheap to copy.
class PatchSource {
 public:
  /// `image` has no NaN.
  PatchSource(const Pixels& image, Radians sun_angle);

  /// Takes about 10 us. `mirrored`: reflected about the direction of the light, which leaves the
  /// probability unchanged.
  CraterFeatures features(const CraterCandidate& candidate, double correlation, bool mirrored = false) const;
  /// Returns brightness at kPatchSide x kPatchSide samples, +x towards the sun, row by row; not normalised.
  std::array<float, kPatchSide * kPatchSide> patch(const CraterCandidate& candidate,
                                                   bool mirrored = false) const;
  WidePatch wide_patch(const CraterCandidate& candidate, double correlation) const;
  /// Returns the correlation of the patch with a bowl lit by slope (BowlLight::slope), [-1, 1].
  double slope_correlation(const CraterCandidate& candidate) const;
  /// Returns the best correlation of the patch with a bowl lit by slope and, from 20 px on, with the filled
  /// ones (BowlLight::flat_floor, rim_only), [-1, 1].
  double bowl_correlation(const CraterCandidate& candidate) const;
  Radians sun_angle() const { return sun_angle_; }

 private:
  struct Level {
    Pixels pixels;
    double shrink_x = 1, shrink_y = 1;
  };
  template <int kSide>
  void read(const CraterCandidate& candidate, double reach, bool mirrored, float* samples) const;
  std::array<float, 3> scalar_inputs(double correlation, double deviation, double diameter) const;
  std::shared_ptr<const std::vector<Level>> levels_;
  Radians sun_angle_;
  double noise_ = 1;
};

}  // namespace waymark::pipeline
