// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "pipeline/fusion/association/alignment.hpp"
#include "pipeline/fusion/association/common_geometry_error.hpp"
#include "pipeline/fusion/association/repetition.hpp"
namespace waymark::pipeline {

struct CheckedAlignmentRules {
  AlignmentRules alignment = {};
  RepetitionRules repetition = {};
  std::size_t min_expected = 100;  ///< with fewer comparisons there is no verdict
  double certain = 0.9;            ///< found again: no other uncertainty of the poses is tried
  double sound = 0.6;              ///< found again at least where the geometry is right
  double wrong = 0.35;             ///< below, after every attempt: the geometry is not usable
  int widenings = 6;               ///< attempts, each with twice the standard deviation of the one before
  double step_gain = 0.02;         ///< of the fraction found again, to prefer a wider attempt
  double min_gain = 0.1;           ///< of the best attempt over the poses as stated, to be kept
  /// Fewer may be found again with one error common to all images corrected than with each pose free, since
  /// it has one unknown.
  double cause_loss = 0.05;
};

/// Alignment with a verdict on the geometry of the images.
struct CheckedAlignment {
  enum class Verdict {
    unknown,   ///< too few objects in common
    sound,     ///< objects are found again as the poses state
    widened,   ///< they are, with poses less certain than stated: `added_position_sd`
    doubtful,  ///< fewer than `sound`, more than `wrong`
    wrong,     ///< next to none, or only with one of `causes`: poses, lens or heights are wrong
  };
  Alignment alignment;
  Repetition stated;   ///< after alignment within the stated uncertainty
  Repetition aligned;  ///< of `alignment`
  Verdict verdict = Verdict::unknown;
  double added_position_sd = 0;             ///< metres
  double added_rotation_sd = 0;             ///< radians
  bool unstated = false;                    ///< they are added only where the poses state no uncertainty
  std::vector<CommonGeometryError> causes;  ///< errors that explain what is not found again, the best first
};

/// Returns whether the covariance of the centre or of the rotation of a posed image is 0, which means
/// unknown.
bool lacks_uncertainty(const ImageView& image);

/// Aligns images and tests the result by how many objects are found again in other images.
/// - A covariance of 0 of a centre or a rotation is unknown: corrections of poses left free show its size.
/// - Where too few are found again, the poses are taken to be less certain than stated: their standard
/// deviations
///   grow from one ground sample distance upwards. The attempt with the most objects found again is kept.
/// - Where one error common to all images explains as much, it is named; where fewer than `sound` are found
///   again without it, no correction of poses is trusted.
/// Deterministic.
CheckedAlignment align_and_check(const std::vector<Observation>& observations,
                                 const std::vector<ImageView>& images, const Terrain& terrain,
                                 const TypeRegistry& types, const Crs& crs,
                                 const CheckedAlignmentRules& rules = {});

}  // namespace waymark::pipeline
