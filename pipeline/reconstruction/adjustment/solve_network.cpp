// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/solve_network.hpp"

#include <ceres/ceres.h>

#include "pipeline/reconstruction/adjustment/frame_changes.hpp"

namespace waymark::pipeline {
namespace {

class TermCost final : public ceres::CostFunction {
 public:
  TermCost(const Network& network, const Term& term) : network_(network), term_(term) {
    set_num_residuals(term.rows);
    for (const std::size_t i : term.blocks)
      mutable_parameter_block_sizes()->push_back(static_cast<int>(network.blocks[i].value.size()));
  }

  // Derivatives are by changes, padded by zeros to the size of the block; FreeChanges takes them as they are.
  bool Evaluate(const double* const* values, double* residuals, double** jacobians) const override {
    Term::Linear linear;
    if (!term_.linearize(values, linear)) return false;
    for (int row = 0; row < term_.rows; ++row) residuals[row] = linear.residual[row];
    if (!jacobians) return true;
    for (std::size_t i = 0; i < term_.blocks.size(); ++i) {
      if (!jacobians[i]) continue;
      const Block& block = network_.blocks[term_.blocks[i]];
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> out(
          jacobians[i], term_.rows, block.value.size());
      out.setZero();
      out.leftCols(block.changes()) = linear.by_block[i];
    }
    return true;
  }

 private:
  const Network& network_;
  const Term& term_;
};

class FreeChanges final : public ceres::Manifold {
 public:
  explicit FreeChanges(const Block& block)
      : kind_(block.kind), size_(block.value.size()), changes_(block.changes()), free_(block.free) {}

  int AmbientSize() const override { return static_cast<int>(size_); }
  int TangentSize() const override { return static_cast<int>(free_.size()); }

  bool Plus(const double* value, const double* change, double* out) const override {
    std::array<double, Term::kMaxColumns> whole{};
    for (std::size_t i = 0; i < free_.size(); ++i) whole[static_cast<std::size_t>(free_[i])] = change[i];
    apply_change(kind_, value, whole.data(), size_, out);
    return true;
  }

  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> out(
        jacobian, size_, static_cast<Eigen::Index>(free_.size()));
    out.setZero();
    for (std::size_t i = 0; i < free_.size(); ++i) out(free_[i], static_cast<Eigen::Index>(i)) = 1;
    return true;
  }

  // Ceres calls these for covariances and line searches only, which are not used here.
  bool Minus(const double*, const double*, double*) const override { return false; }
  bool MinusJacobian(const double*, double*) const override { return false; }

 private:
  Block::Kind kind_;
  Eigen::Index size_, changes_;
  std::vector<int> free_;
};

ceres::Solver::Options solver_options(const SolveOptions& options, bool points, bool free_frame) {
  ceres::Solver::Options solver;
  solver.linear_solver_type = points ? ceres::DENSE_SCHUR : ceres::DENSE_QR;
  solver.dense_linear_algebra_library_type = ceres::EIGEN;  // no BLAS: the same bits everywhere
  solver.num_threads = 1;
  solver.max_num_iterations = options.max_iterations;
  solver.function_tolerance = options.function_tolerance;
  solver.parameter_tolerance = 1e-12;
  solver.gradient_tolerance = 1e-14;
  solver.initial_trust_region_radius = 1e6;
  // Damping of at least this fraction keeps the matrix regular where the frame is free.
  solver.max_trust_region_radius = free_frame ? 1e8 : 1e12;
  solver.logging_type = ceres::SILENT;
  return solver;
}

}  // namespace

SolveReport solve(Network& network, const SolveOptions& options) {
  // One array for all values: Ceres orders unknowns by their addresses.
  std::vector<double> storage;
  std::vector<std::size_t> first;
  for (const Block& block : network.blocks) {
    first.push_back(storage.size());
    storage.insert(storage.end(), block.value.begin(), block.value.end());
  }
  const auto values_of = [&](std::size_t block) { return storage.data() + first[block]; };
  ceres::Problem::Options ownership;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.disable_all_safety_checks = true;
  ceres::CauchyLoss cauchy(options.cauchy > 0 ? options.cauchy : 1);
  ceres::Problem problem(ownership);
  bool points = false;
  auto order = std::make_shared<ceres::ParameterBlockOrdering>();
  for (std::size_t i = 0; i < network.blocks.size(); ++i) {
    const Block& block = network.blocks[i];
    problem.AddParameterBlock(values_of(i), static_cast<int>(block.value.size()));
    if (block.free.empty()) {
      problem.SetParameterBlockConstant(values_of(i));
    } else if (block.kind == Block::Kind::pose ||
               block.free.size() < static_cast<std::size_t>(block.value.size())) {
      problem.SetManifold(values_of(i), new FreeChanges(block));
    }
    const bool point = block.kind == Block::Kind::point;
    points = points || (point && !block.free.empty());
    order->AddElementToGroup(values_of(i), point ? 0 : 1);
  }
  for (const auto& term : network.terms) {
    std::vector<double*> values;
    for (const std::size_t i : term->blocks) values.push_back(values_of(i));
    problem.AddResidualBlock(new TermCost(network, *term), options.cauchy > 0 ? &cauchy : nullptr, values);
  }
  ceres::Solver::Options solver = solver_options(options, points, free_frame_changes(network).cols() > 0);
  if (points) solver.linear_solver_ordering = order;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  for (std::size_t i = 0; i < network.blocks.size(); ++i)
    network.blocks[i].value = Eigen::Map<const Eigen::VectorXd>(values_of(i), network.blocks[i].value.size());
  return {summary.IsSolutionUsable(), summary.termination_type == ceres::CONVERGENCE,
          static_cast<int>(summary.iterations.size())};
}

}  // namespace waymark::pipeline
