// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/covariance.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "pipeline/reconstruction/adjustment/frame_changes.hpp"

namespace waymark::pipeline {
namespace {

// Derivatives of a term by the free components of one of its blocks.
Eigen::MatrixXd by_free(const Block& block, const Term::Jacobian& jacobian) {
  Eigen::MatrixXd out(jacobian.rows(), static_cast<Eigen::Index>(block.free.size()));
  for (std::size_t i = 0; i < block.free.size(); ++i)
    out.col(static_cast<Eigen::Index>(i)) = jacobian.col(block.free[i]);
  return out;
}

// Part of the normal matrix that couples a point to a block.
struct Coupling {
  std::size_t block = 0;
  Eigen::MatrixXd matrix;
};

struct PointNormals {
  Eigen::MatrixXd inverse;  // of the point's own normal matrix; empty: not determined
  std::vector<Coupling> couplings;
};

class Normals {
 public:
  explicit Normals(const Network& network)
      : network_(network),
        reduced_(Eigen::MatrixXd::Zero(network.camera_columns, network.camera_columns)),
        points_(network.blocks.size()) {
    std::vector<std::vector<const Term*>> of_point(network.blocks.size());
    for (const auto& term : network.terms) {
      const auto point = point_of(*term);
      if (point)
        of_point[*point].push_back(term.get());
      else
        add({term.get()}, std::nullopt);
    }
    for (std::size_t i = 0; i < of_point.size(); ++i)
      if (!of_point[i].empty()) add(of_point[i], i);
  }

  const Eigen::MatrixXd& reduced() const { return reduced_; }

  // Covariance of a point, given that of the cameras.
  std::optional<Eigen::Matrix3d> point(std::size_t block, const Eigen::MatrixXd& cameras) const {
    const PointNormals& own = points_[block];
    const Block& at = network_.blocks[block];
    if (at.kind != Block::Kind::point || own.inverse.size() == 0) return std::nullopt;
    Eigen::MatrixXd middle = Eigen::MatrixXd::Zero(own.inverse.rows(), own.inverse.rows());
    for (const Coupling& a : own.couplings)
      for (const Coupling& b : own.couplings)
        middle += a.matrix.transpose() *
                  cameras.block(column(a), column(b), a.matrix.rows(), b.matrix.rows()) * b.matrix;
    const Eigen::MatrixXd free = own.inverse + own.inverse * middle * own.inverse;
    Eigen::Matrix3d whole = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < at.free.size(); ++i)
      for (std::size_t j = 0; j < at.free.size(); ++j)
        whole(at.free[i], at.free[j]) = free(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    return whole;
  }

 private:
  std::optional<std::size_t> point_of(const Term& term) const {
    for (const std::size_t i : term.blocks)
      if (network_.blocks[i].kind == Block::Kind::point && !network_.blocks[i].free.empty()) return i;
    return std::nullopt;
  }

  Eigen::Index column(const Coupling& c) const { return network_.blocks[c.block].column; }

  // Adds all terms of a point, or one term without a point.
  void add(const std::vector<const Term*>& terms, std::optional<std::size_t> point) {
    const auto size =
        point ? static_cast<Eigen::Index>(network_.blocks[*point].free.size()) : Eigen::Index{0};
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(size, size);
    std::vector<std::vector<Coupling>> parts;  // derivatives of each term by blocks that are not points
    std::vector<Coupling> couplings;
    for (const Term* term : terms) {
      Term::Linear linear;
      if (!network_.linearize(*term, linear)) continue;
      Eigen::MatrixXd by_point = Eigen::MatrixXd::Zero(term->rows, size);
      parts.emplace_back();
      for (std::size_t i = 0; i < term->blocks.size(); ++i) {
        const Block& block = network_.blocks[term->blocks[i]];
        if (block.free.empty()) continue;
        if (point == term->blocks[i])
          by_point = by_free(block, linear.by_block[i]);
        else
          parts.back().push_back({term->blocks[i], by_free(block, linear.by_block[i])});
      }
      own += by_point.transpose() * by_point;
      for (const Coupling& part : parts.back())
        if (size > 0) couple(couplings, part.block, part.matrix.transpose() * by_point);
    }
    if (size > 0) {
      const Eigen::MatrixXd inverse = own.inverse();
      const double determinant = own.determinant(), scale = own.trace() / static_cast<double>(size);
      if (!(determinant > 1e-14 * std::pow(scale, size)) || !inverse.allFinite()) return;
      points_[*point] = {inverse, couplings};
    }
    for (const auto& term : parts)
      for (const Coupling& a : term)
        for (const Coupling& b : term) block(a, b) += a.matrix.transpose() * b.matrix;
    for (const Coupling& a : couplings) {
      const Eigen::MatrixXd weighted = a.matrix * points_[*point].inverse;
      for (const Coupling& b : couplings)
        reduced_.block(column(a), column(b), a.matrix.rows(), b.matrix.rows()) -=
            weighted * b.matrix.transpose();
    }
  }

  Eigen::Block<Eigen::MatrixXd> block(const Coupling& a, const Coupling& b) {
    return reduced_.block(column(a), column(b), a.matrix.cols(), b.matrix.cols());
  }

  static void couple(std::vector<Coupling>& all, std::size_t block, const Eigen::MatrixXd& matrix) {
    for (Coupling& c : all)
      if (c.block == block) {
        c.matrix += matrix;
        return;
      }
    all.push_back({block, matrix});
  }

  const Network& network_;
  Eigen::MatrixXd reduced_;
  std::vector<PointNormals> points_;
};

// Inverse of a symmetric matrix whose unknowns have units of their own; empty if it is singular.
Eigen::MatrixXd scaled_inverse(const Eigen::MatrixXd& m) {
  const Eigen::VectorXd scale = m.diagonal().cwiseMax(0).cwiseSqrt().cwiseInverse();
  if (!scale.allFinite()) return {};
  const Eigen::MatrixXd scaled = scale.asDiagonal() * m * scale.asDiagonal();
  const Eigen::LDLT<Eigen::MatrixXd> factors(scaled);
  constexpr double kSingular = 1e-13;  // rounding of the sum of some 1e4 terms
  if (factors.info() != Eigen::Success || !(factors.vectorD().minCoeff() > kSingular)) return {};
  const Eigen::MatrixXd inverse = factors.solve(Eigen::MatrixXd::Identity(m.rows(), m.cols()));
  return scale.asDiagonal() * ((inverse + inverse.transpose()) / 2) * scale.asDiagonal();
}

}  // namespace

std::optional<Eigen::Matrix3d> point_covariance(const Network& network, std::size_t block,
                                                const Eigen::MatrixXd& cameras) {
  return Normals(network).point(block, cameras);
}

NetworkCovariance covariance(const Network& network) {
  NetworkCovariance out;
  const Normals normals(network);
  const Eigen::MatrixXd free = free_frame_changes(network);
  out.free_datum = static_cast<int>(free.cols());
  Eigen::MatrixXd matrix = normals.reduced();
  Eigen::MatrixXd constraints = inner_constraint_weights(network).asDiagonal() * free;
  if (free.cols() > 0) {
    // Of the size of the normal matrix, so that neither drowns the other.
    constraints *= std::sqrt(matrix.trace() / (constraints.squaredNorm() + 1e-300));
    matrix += constraints * constraints.transpose();
  }
  if (network.camera_columns > 0) {
    out.cameras = scaled_inverse(matrix);
    if (out.cameras.size() == 0) return out;
  }
  if (free.cols() > 0) {
    const Eigen::MatrixXd along = constraints.transpose() * free;
    out.cameras -= free * (along.transpose() * along).inverse() * free.transpose();
  }
  out.determined = true;
  out.points.resize(network.blocks.size());
  for (std::size_t i = 0; i < network.blocks.size(); ++i) out.points[i] = normals.point(i, out.cameras);
  return out;
}

}  // namespace waymark::pipeline
