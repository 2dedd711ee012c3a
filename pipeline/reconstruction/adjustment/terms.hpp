// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
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
/// Makes the term of a point on a surface. Blocks: point. The surface must outlive the term.
std::unique_ptr<Term> surface_term(const Observed& what, std::size_t point, const ObservedSurface& surface,
                                   const Eigen::Vector3d& origin);

}  // namespace waymark::pipeline
