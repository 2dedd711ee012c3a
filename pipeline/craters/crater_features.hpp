// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <vector>
#include "core/units.hpp"
#include "geo/image_source.hpp"
#include "pipeline/craters/crater_candidate.hpp"
namespace waymark {

inline constexpr int kPatchSide = 20;              ///< samples
inline constexpr double kPatchReach = 1.6;         ///< radii from the middle to the edge
inline constexpr int kHogCells = 5, kHogBins = 8;  ///< cells per side, directions per turn
inline constexpr int kThumbSide = 10;              ///< the patch, 2 x 2 means
inline constexpr int kCraterFeatures = kThumbSide * kThumbSide + kHogCells * kHogCells * kHogBins + 3;

/// What the model sees of a candidate: the patch about it turned so that the sun stands at +x, brightness
/// with zero mean and unit deviation, as a thumbnail; a histogram of oriented gradients (Dalal & Triggs 2005)
/// of it; correlation, contrast against noise, and size.
using CraterFeatures = std::array<float, kCraterFeatures>;

inline constexpr int kLookSide = 24;       ///< samples
inline constexpr double kLookReach = 2.2;  ///< radii from the middle to the edge
inline constexpr int kLookFacts = 3;

/// What the convolutional part of the model sees: more of the surroundings, brightness with zero mean and
/// unit deviation over 1.6 radii, clipped to 3; correlation, contrast against noise, and size.
struct CraterLook {
  std::array<float, kLookSide * kLookSide> patch{};
  std::array<float, kLookFacts> facts{};
};

/// Zero mean and unit deviation over the inner 1.6 radii, clipped to 3; returns the deviation before.
double normalise(std::array<float, kLookSide * kLookSide>& patch);

/// An image prepared for sampling patches of any size: octaves of half size, of which patches are read so
/// that a sample is never much finer or coarser than a pixel. Cheap to copy.
class PatchSource {
 public:
  /// `image` has no NaN.
  PatchSource(const Pixels& image, Radians sun_angle);

  /// About 10 us. `mirrored`: seen in a mirror along the light, as likely a crater as before.
  CraterFeatures features(const CraterCandidate& candidate, double correlation, bool mirrored = false) const;
  /// Brightness at kPatchSide x kPatchSide samples, +x towards the sun, row by row; not normalised.
  std::array<float, kPatchSide * kPatchSide> patch(const CraterCandidate& candidate,
                                                   bool mirrored = false) const;
  CraterLook look(const CraterCandidate& candidate, double correlation) const;
  /// Correlation of the patch with a bowl lit by slope (BowlLight::slope), [-1, 1].
  double slope_correlation(const CraterCandidate& candidate) const;
  Radians sun_angle() const { return sun_angle_; }

 private:
  struct Level {
    Pixels pixels;
    double shrink_x = 1, shrink_y = 1;
  };
  template <int kSide>
  void read(const CraterCandidate& candidate, double reach, bool mirrored, float* samples) const;
  std::array<float, 3> facts(double correlation, double deviation, double diameter) const;
  std::shared_ptr<const std::vector<Level>> levels_;
  Radians sun_angle_;
  double noise_ = 1;
};

}  // namespace waymark
