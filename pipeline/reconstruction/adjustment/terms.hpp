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

/// Mark of a point. Blocks: lens, pose, point.
std::unique_ptr<Term> mark_term(const Observed& what, const BlockIndices& blocks, const LensModel& model,
                                const Mark& mark);
/// Coordinates of a block observed with standard deviations, from component `first` of its change. Blocks:
/// the block and, if `biased`, the height bias. Infinite deviations and those of 0 give no rows; null if
/// none.
std::unique_ptr<Term> position_term(const Observed& what, const BlockIndices& blocks, bool pose,
                                    const Eigen::Vector3d& value, const Eigen::Vector3d& sd);
/// Blocks: pose. The deviations are positive and finite.
std::unique_ptr<Term> attitude_term(const Observed& what, std::size_t pose, const ObservedAttitude& seen);
/// Blocks: pose.
std::unique_ptr<Term> up_term(const Observed& what, std::size_t pose, const ObservedUp& seen);
/// Component of a block observed. Blocks: the block.
std::unique_ptr<Term> component_term(const Observed& what, std::size_t block, Eigen::Index component,
                                     Eigen::Index size, double value, double sd);
/// Point on a surface. Blocks: point. The surface must outlive the term.
std::unique_ptr<Term> surface_term(const Observed& what, std::size_t point, const ObservedSurface& surface,
                                   const Eigen::Vector3d& origin);

}  // namespace waymark::pipeline
