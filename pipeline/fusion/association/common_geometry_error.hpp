// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>
#include "core/observation.hpp"
#include "geo/crs.hpp"
#include "geo/terrain.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/fusion/association/alignment.hpp"
#include "pipeline/fusion/association/repetition.hpp"
#include "pipeline/fusion/projection/image_view.hpp"
namespace waymark::pipeline {

/// Error of the geometry that all images have in common. Corrections of single poses can hide it, so that a
/// map agrees with itself and lies metres off.
struct CommonGeometryError {
  enum class Kind {
    focal_length,          ///< the given focal length is `amount` times the right one
    ground_height,         ///< the DEM is `amount` metres too high relative to the poses; < 0: too low
    transposed_rotations,  ///< the rotations turn the grid into the camera, instead of the camera into the
                           ///< grid
  };
  Kind kind = Kind::focal_length;
  double amount = 0;
  Repetition found;  ///< after alignment within the stated uncertainty of the poses, the error corrected
};

struct CommonErrorRules {
  AlignmentRules alignment = {};
  RepetitionRules repetition = {};
  double max_log_factor = 0.4;          ///< of the focal length, and of the distance to the ground
  std::size_t searched_objects = 1500;  ///< compared at each step of the search; with more, every n-th one
};

/// Images and observations with an error corrected: the lines of sight of the pixels intersect the
/// terrain again. Observations without pixel, and those whose line of sight misses the ground, are left out.
/// Positions change; covariances and features stay.
struct CorrectedGeometry {
  std::vector<ImageView> images;
  std::vector<Observation> observations;
};
CorrectedGeometry correct_geometry(const std::vector<Observation>& observations,
                                   const std::vector<ImageView>& images, const Terrain& terrain,
                                   const Crs& crs, CommonGeometryError::Kind kind, double amount);

/// Returns for each kind of error the amount with which most objects are found again in other images, the
/// best first. The logarithm of a focal length or distance is searched on three grids, with steps from 0.01
/// down to 0.00125; errors of single poses limit the amount to some percent. Images at one distance
/// from level ground do not separate a focal length from a height: with both as many are found again.
/// Deterministic.
std::vector<CommonGeometryError> find_common_errors(const std::vector<Observation>& observations,
                                                    const std::vector<ImageView>& images,
                                                    const Terrain& terrain, const TypeRegistry& types,
                                                    const Crs& crs, const CommonErrorRules& rules = {});

}  // namespace waymark::pipeline
