// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <vector>
#include "pipeline/reconstruction/adjustment/lens_model.hpp"
#include "pipeline/reconstruction/adjustment/network.hpp"
#include "pipeline/reconstruction/adjustment/observations.hpp"
namespace waymark::pipeline {

/// Indices of the blocks that a term depends on.
using BlockIndices = std::vector<std::size_t>;
/// What a term observes, for reports.
struct Observed {
  Term::Kind kind = Term::Kind::tie_mark;
  std::size_t index = 0, mark = 0;
};

/// Makes the term of a mark of a point. Blocks: lens, pose, point.
std::unique_ptr<Term> mark_term(const Observed& what, const BlockIndices& blocks, const LensModel& model,
                                const Mark& mark);
/// Makes the term of a mark of a point in an image whose rows were read out one after the other. Blocks:
/// lens, pose, motion, point.
std::unique_ptr<Term> moving_mark_term(const Observed& what, const BlockIndices& blocks,
                                       const LensModel& model, const Mark& mark, double readout_fraction);
/// Makes the term of a shift that is expected to be the sum of camera centres times their factors. The
/// deviation is a fraction of the distance between the first and the last centre. Blocks: the motion and two
/// or three poses.
std::unique_ptr<Term> shift_term(const Observed& what, const BlockIndices& blocks,
                                 const std::vector<double>& factors, double relative_sd);
/// Makes the term of an expected turn. Blocks: the motion.
std::unique_ptr<Term> turn_term(const Observed& what, std::size_t motion, const Eigen::Vector3d& turn,
                                double sd);
/// Makes the term of coordinates observed with standard deviations, from component `first` of a block's
/// change. Blocks: the block and, if `biased`, the height bias. Infinite deviations and those of 0 give no
/// rows; null if none.
std::unique_ptr<Term> position_term(const Observed& what, const BlockIndices& blocks, bool pose,
                                    const Eigen::Vector3d& value, const Eigen::Vector3d& sd);
/// Makes the term of an observed attitude. Blocks: pose. The deviations are positive and finite.
std::unique_ptr<Term> attitude_term(const Observed& what, std::size_t pose, const ObservedAttitude& seen);
/// Blocks: pose.
std::unique_ptr<Term> up_term(const Observed& what, std::size_t pose, const ObservedUp& seen);
/// Makes the term of an observed component of a block. Blocks: the block.
std::unique_ptr<Term> component_term(const Observed& what, std::size_t block, Eigen::Index component,
                                     Eigen::Index size, double value, double sd);
/// Makes the term of a height above a point on the ground, which lies `offset` below the ground at the nadir.
/// Blocks: pose, point.
std::unique_ptr<Term> height_above_ground_term(const Observed& what, std::size_t pose, std::size_t point,
                                               double offset, double height, double sd);
/// Makes the term of a point on a surface. Blocks: point. The surface must outlive the term.
std::unique_ptr<Term> surface_term(const Observed& what, std::size_t point, const ObservedSurface& surface,
                                   const Eigen::Vector3d& origin);

}  // namespace waymark::pipeline
