// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/graph_marginals.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>

#include "core/error.hpp"

namespace waymark::localization {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Index = Eigen::Index;

/// Returns the weight of an error's square under a kernel: rho' of Ceres.
double weight(const std::string& kernel, double width, double square) {
  const double a = width * width;
  if (kernel == "huber") return square <= a ? 1 : width / std::sqrt(square);
  if (kernel == "cauchy") return 1 / (1 + square / a);
  return 1;
}

/// Information matrix, assembled block by block.
class Information {
 public:
  explicit Information(const PoseGraph& graph)
      : pose_row_(graph.poses.size()),
        landmark_row_(graph.landmarks.size()),
        deviation_row_(graph.deviations.size()) {
    const bool held = has_gauge(graph);
    for (std::size_t i = 0; i < pose_row_.size(); ++i) {
      const bool fixed = graph.poses[i].fixed || (i == 0 && !held);
      pose_row_[i] = fixed ? -1 : rows_;
      if (!fixed) rows_ += 3;
    }
    for (std::vector<Index>* all : {&landmark_row_, &deviation_row_})
      for (Index& row : *all) {
        row = rows_;
        rows_ += 2;
      }
  }

  Index pose(std::size_t i) const { return pose_row_[i]; }
  Index landmark(std::size_t i) const { return landmark_row_[i]; }
  Index deviation(std::size_t i) const { return deviation_row_[i]; }
  Index rows() const { return rows_; }

  /// Adds a'b at (row, column), rows from pose() or landmark(); does nothing if one is fixed.
  template <class A, class B>
  void add(Index row, Index column, const A& a, const B& b, double scale) {
    if (row < 0 || column < 0) return;
    for (Index i = 0; i < a.cols(); ++i)
      for (Index j = 0; j < b.cols(); ++j)
        entries_.emplace_back(static_cast<int>(row + i), static_cast<int>(column + j),
                              scale * a.col(i).dot(b.col(j)));
  }
  template <class A, class B>
  void tie(Index row_a, const A& a, Index row_b, const B& b, double scale) {
    add(row_a, row_a, a, a, scale);
    add(row_b, row_b, b, b, scale);
    link(row_a, a, row_b, b, scale);
  }
  template <class A, class B>
  void link(Index row_a, const A& a, Index row_b, const B& b, double scale) {
    add(row_a, row_b, a, b, scale);
    add(row_b, row_a, b, a, scale);
  }

  Sparse matrix() const {
    Sparse all(rows_, rows_);
    all.setFromTriplets(entries_.begin(), entries_.end());
    return all;
  }

 private:
  std::vector<Index> pose_row_, landmark_row_, deviation_row_;
  std::vector<Eigen::Triplet<double>> entries_;
  Index rows_ = 0;
};

/// Entries of the inverse of L D L' at the non-zeros of L; the diagonal apart.
struct SelectedInverse {
  Sparse below;
  Eigen::VectorXd diagonal;

  double operator()(Index i, Index j) const {
    if (i == j) return diagonal[i];
    return below.coeff(std::max(i, j), std::min(i, j));
  }
};

// Z = D^-1 L^-1 + (I - L') Z, column by column from the last. Entries of the pattern of L depend on entries
// of that pattern only.
SelectedInverse selected_inverse(const Sparse& l, const Eigen::VectorXd& d) {
  const Index n = l.cols();
  SelectedInverse z{l, d.cwiseInverse()};
  std::vector<int> rows;
  std::vector<double> values, found;
  for (Index j = n - 1; j >= 0; --j) {
    rows.clear(), values.clear();
    for (Sparse::InnerIterator it(l, j); it; ++it)
      if (it.row() > j) rows.push_back(static_cast<int>(it.row())), values.push_back(it.value());
    found.assign(rows.size(), 0);
    // z(i, j) = - sum_k L(k, j) z(i, k) over the rows k of column j.
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const Index column = rows[k];
      found[k] -= values[k] * z.diagonal[column];
      std::size_t at = k + 1;
      for (Sparse::InnerIterator it(z.below, column); it && at < rows.size(); ++it) {
        if (it.row() <= column) continue;
        while (at < rows.size() && rows[at] < it.row()) ++at;
        if (at == rows.size() || rows[at] != it.row()) continue;
        found[at] -= values[k] * it.value();
        found[k] -= values[at] * it.value();
      }
    }
    std::size_t k = 0;
    double sum = z.diagonal[j];
    for (Sparse::InnerIterator it(z.below, j); it; ++it) {
      if (it.row() <= j) continue;
      it.valueRef() = found[k];
      sum -= values[k] * found[k];
      ++k;
    }
    z.diagonal[j] = sum;
  }
  return z;
}

}  // namespace

GraphMarginals graph_marginals(const PoseGraph& graph, const std::string& kernel, double kernel_width) {
  Information information(graph);
  for (const StepEdge& e : graph.steps) {
    const StepError error = step_error(e, graph.poses[e.from].at, graph.poses[e.to].at);
    const bool loop = (e.from < e.to ? e.to - e.from : e.from - e.to) > 1;
    information.tie(information.pose(e.from), error.by_from, information.pose(e.to), error.by_to,
                    loop ? weight(kernel, kernel_width, error.value.squaredNorm()) : 1);
  }
  for (const SightingEdge& e : graph.sightings) {
    const SightingError error = sighting_error(graph, e);
    const double scale = weight(kernel, kernel_width, error.value.squaredNorm());
    const Index pose = information.pose(e.pose), landmark = information.landmark(e.landmark);
    information.tie(pose, error.by_pose, landmark, error.by_landmark, scale);
    if (!e.deviation) continue;
    const Index deviation = information.deviation(*e.deviation);
    information.add(deviation, deviation, error.by_deviation, error.by_deviation, scale);
    information.link(pose, error.by_pose, deviation, error.by_deviation, scale);
    information.link(landmark, error.by_landmark, deviation, error.by_deviation, scale);
  }
  for (std::size_t i = 0; i < graph.deviations.size(); ++i) {
    const Eigen::Matrix2d& root = graph.deviations[i].root;
    information.add(information.deviation(i), information.deviation(i), root, root, 1);
  }
  for (const PosePrior& p : graph.pose_priors)
    information.add(information.pose(p.pose), information.pose(p.pose), p.root, p.root, 1);
  for (const LandmarkPrior& p : graph.landmark_priors)
    information.add(information.landmark(p.landmark), information.landmark(p.landmark), p.root, p.root, 1);

  GraphMarginals marginals;
  marginals.poses.assign(graph.poses.size(), Eigen::Matrix3d::Zero());
  marginals.landmarks.assign(graph.landmarks.size(), Eigen::Matrix2d::Zero());
  if (information.rows() == 0) return marginals;
  Eigen::SimplicialLDLT<Sparse> factor(information.matrix());
  if (factor.info() != Eigen::Success || !(factor.vectorD().minCoeff() > 0))
    throw Error(ErrorCode::input, "the graph is not determined: it has no covariances", "",
                "check for a pose or landmark with fewer measurements than coordinates");
  Sparse l = factor.matrixL();
  const SelectedInverse inverse = selected_inverse(l, factor.vectorD());
  const auto place = [&](Index row) { return factor.permutationP().indices()[row]; };
  const auto read = [&](Index row, auto& block) {
    if (row < 0) return;
    for (Index i = 0; i < block.rows(); ++i)
      for (Index j = 0; j < block.cols(); ++j) block(i, j) = inverse(place(row + i), place(row + j));
  };
  for (std::size_t i = 0; i < graph.poses.size(); ++i) read(information.pose(i), marginals.poses[i]);
  for (std::size_t i = 0; i < graph.landmarks.size(); ++i)
    read(information.landmark(i), marginals.landmarks[i]);
  return marginals;
}

}  // namespace waymark::localization
