// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/terms.hpp"

#include <cmath>

#include "pipeline/reconstruction/adjustment/shutter_motion.hpp"

namespace waymark::pipeline {
namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// Derivatives of the residual of a mark: by the point, and by a turn about the axes of the camera.
struct MarkDerivatives {
  Eigen::Matrix<double, 2, 3> by_world, by_turn;
};

/// Mark of a point in an image of a lens, whatever moves the camera.
class MarkOfLens {
 public:
  MarkOfLens(const LensModel& model, const Mark& mark) : model_(model), pixel_(mark.pixel), sd_(mark.sd) {}

  /// Sets the residual and its derivative by block 0, the lens; `std::nullopt` behind the camera.
  std::optional<MarkDerivatives> see(const double* lens, const double* world, const Eigen::Isometry3d& pose,
                                     Term::Linear& out) const {
    const Eigen::Matrix3d camera_from_world = pose.linear().transpose();
    const Eigen::Vector3d point =
        camera_from_world * (Eigen::Map<const Eigen::Vector3d>(world) - pose.translation());
    const auto count = static_cast<Eigen::Index>(model_.names().size());
    LensModel::Residual seen;
    if (!model_.residual(Eigen::Map<const Eigen::VectorXd>(lens, count), point, pixel_, seen)) return {};
    out.residual = seen.value / sd_;
    out.by_block[0] = seen.by_lens / sd_;
    // A turn w about the camera's axes moves the point in the camera by point x w.
    return MarkDerivatives{seen.by_point * camera_from_world / sd_,
                           seen.by_point * cross_matrix(point) / sd_};
  }

 private:
  const LensModel& model_;
  Eigen::Vector2d pixel_;
  double sd_;
};

class MarkTerm final : public Term {
 public:
  MarkTerm(const Observed& what, const BlockIndices& of, const LensModel& model, const Mark& mark)
      : Term(what.kind, what.index, what.mark, of, 2), mark_(model, mark) {}

  bool linearize(const double* const* values, Linear& out) const override {
    const auto seen = mark_.see(values[0], values[2], pose_of(values[1]), out);
    if (!seen) return false;
    out.by_block[1].resize(2, 6);
    out.by_block[1].leftCols<3>() = seen->by_turn;
    out.by_block[1].rightCols<3>() = -seen->by_world;
    out.by_block[2] = seen->by_world;
    return true;
  }

 private:
  MarkOfLens mark_;
};

// Derivative of the turn vector of exp(v) exp(d) by d (Sola et al. 2018, eq. 143).
Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& v) {
  const double a = v.norm();
  const double first = a > 1e-4 ? (1 - std::cos(a)) / (a * a) : 0.5;
  const double second = a > 1e-4 ? (a - std::sin(a)) / (a * a * a) : 1.0 / 6;
  const Eigen::Matrix3d cross = cross_matrix(v);
  return Eigen::Matrix3d::Identity() - first * cross + second * cross * cross;
}

class MovingMarkTerm final : public Term {
 public:
  MovingMarkTerm(const Observed& what, const BlockIndices& of, const LensModel& model, const Mark& mark,
                 double readout_fraction)
      : Term(what.kind, what.index, what.mark, of, 2), mark_(model, mark), fraction_(readout_fraction) {}

  bool linearize(const double* const* values, Linear& out) const override {
    const Eigen::Isometry3d pose = pose_of(values[1]);
    const ShutterMotion motion{Eigen::Map<const Eigen::Vector3d>(values[2]),
                               Eigen::Map<const Eigen::Vector3d>(values[2] + 3)};
    const Eigen::Isometry3d moved = moved_pose(pose, motion, fraction_);
    const auto seen = mark_.see(values[0], values[3], moved, out);
    if (!seen) return false;
    out.by_block[1].resize(2, 6);
    out.by_block[1].leftCols<3>() = seen->by_turn * (moved.linear().transpose() * pose.linear());
    out.by_block[1].rightCols<3>() = -seen->by_world;
    out.by_block[2].resize(2, 6);
    out.by_block[2].leftCols<3>() = -fraction_ * seen->by_world;
    out.by_block[2].rightCols<3>() = fraction_ * seen->by_turn * right_jacobian(fraction_ * motion.turn);
    out.by_block[3] = seen->by_world;
    return true;
  }

 private:
  MarkOfLens mark_;
  double fraction_;
};

// The deviation is a fraction of the distance between the outer centres: it grows with the frame, or a
// smaller frame would fit better.
class ShiftTerm final : public Term {
 public:
  ShiftTerm(const Observed& what, const BlockIndices& of, std::vector<double> factors, double relative_sd)
      : Term(what.kind, what.index, 0, of, 3), factors_(std::move(factors)), relative_sd_(relative_sd) {}

  bool linearize(const double* const* values, Linear& out) const override {
    const auto centre = [&](std::size_t k) { return Eigen::Map<const Eigen::Vector3d>(values[k + 1] + 4); };
    const std::size_t last = factors_.size() - 1;
    const Eigen::Vector3d apart = centre(last) - centre(0);
    const double sd = relative_sd_ * apart.norm();
    if (!(sd > 0)) return false;
    Eigen::Vector3d residual = Eigen::Map<const Eigen::Vector3d>(values[0]);
    for (std::size_t k = 0; k <= last; ++k) residual -= factors_[k] * centre(k);
    out.residual = residual / sd;
    out.by_block[0].setZero(3, 6);
    out.by_block[0].leftCols<3>().diagonal().setConstant(1 / sd);
    for (std::size_t k = 0; k <= last; ++k) {
      out.by_block[k + 1].setZero(3, 6);
      out.by_block[k + 1].rightCols<3>().diagonal().setConstant(-factors_[k] / sd);
    }
    const Eigen::Matrix3d by_apart = residual / sd * apart.transpose() / apart.squaredNorm();
    out.by_block[1].rightCols<3>() += by_apart;
    out.by_block[last + 1].rightCols<3>() -= by_apart;
    return true;
  }

 private:
  std::vector<double> factors_;
  double relative_sd_;
};

class TurnTerm final : public Term {
 public:
  TurnTerm(const Observed& what, std::size_t motion, const Eigen::Vector3d& turn, double sd)
      : Term(what.kind, what.index, 0, {motion}, 3), turn_(turn), sd_(sd) {}

  bool linearize(const double* const* values, Linear& out) const override {
    out.residual = (Eigen::Map<const Eigen::Vector3d>(values[0] + 3) - turn_) / sd_;
    out.by_block[0].setZero(3, 6);
    out.by_block[0].rightCols<3>().diagonal().setConstant(1 / sd_);
    return true;
  }

 private:
  Eigen::Vector3d turn_;
  double sd_;
};

class PositionTerm final : public Term {
 public:
  PositionTerm(const Observed& what, const BlockIndices& of, std::vector<int> axes, bool pose,
               const Eigen::Vector3d& value, const Eigen::Vector3d& sd)
      : Term(what.kind, what.index, what.mark, of, static_cast<int>(axes.size())),
        axes_(std::move(axes)),
        pose_(pose),
        value_(value),
        sd_(sd) {}

  bool linearize(const double* const* values, Linear& out) const override {
    const double* at = values[0] + (pose_ ? 4 : 0);
    out.residual.resize(rows);
    out.by_block[0].setZero(rows, pose_ ? 6 : 3);
    if (blocks.size() > 1) out.by_block[1].setZero(rows, 1);
    for (int row = 0; row < rows; ++row) {
      const int axis = axes_[static_cast<std::size_t>(row)];
      const bool biased = blocks.size() > 1 && axis == 2;
      out.residual[row] = (at[axis] + (biased ? values[1][0] : 0) - value_[axis]) / sd_[axis];
      out.by_block[0](row, axis + (pose_ ? 3 : 0)) = 1 / sd_[axis];
      if (biased) out.by_block[1](row, 0) = 1 / sd_[axis];
    }
    return true;
  }

 private:
  std::vector<int> axes_;
  bool pose_;
  Eigen::Vector3d value_, sd_;
};

class AttitudeTerm final : public Term {
 public:
  AttitudeTerm(const Observed& what, std::size_t pose, const ObservedAttitude& seen)
      : Term(what.kind, what.index, 0, {pose}, 3), seen_(seen.world_from_camera.normalized()), sd_(seen.sd) {}

  bool linearize(const double* const* values, Linear& out) const override {
    const Eigen::AngleAxisd turn(seen_.conjugate() *
                                 Eigen::Map<const Eigen::Quaterniond>(values[0]).normalized());
    const Eigen::Vector3d error = turn.angle() * turn.axis();
    // Inverse of the right Jacobian of the rotation vector (Sola et al. 2018, eq. 144).
    const double a = turn.angle();
    const double factor = a > 1e-4 ? 1 / (a * a) - (1 + std::cos(a)) / (2 * a * std::sin(a)) : 1.0 / 12;
    const Eigen::Matrix3d cross = cross_matrix(error);
    const Eigen::Matrix3d by_turn = Eigen::Matrix3d::Identity() + cross / 2 + factor * cross * cross;
    out.residual = error.cwiseQuotient(sd_);
    out.by_block[0].setZero(3, 6);
    out.by_block[0].leftCols<3>() = sd_.cwiseInverse().asDiagonal() * by_turn;
    return std::isfinite(factor);
  }

 private:
  Eigen::Quaterniond seen_;
  Eigen::Vector3d sd_;
};

class UpTerm final : public Term {
 public:
  UpTerm(const Observed& what, std::size_t pose, const ObservedUp& seen)
      : Term(what.kind, what.index, 0, {pose}, 2) {
    const Eigen::Vector3d up = seen.up_in_camera.normalized();
    across_.row(0) = up.unitOrthogonal().transpose() / seen.sd;
    across_.row(1) = up.cross(up.unitOrthogonal()).transpose() / seen.sd;
    up_ = up;
  }

  bool linearize(const double* const* values, Linear& out) const override {
    const Eigen::Vector3d up = pose_of(values[0]).linear().transpose() * Eigen::Vector3d::UnitZ();
    out.residual = across_ * up;
    out.by_block[0].setZero(2, 6);
    out.by_block[0].leftCols<3>() = across_ * cross_matrix(up);
    return up.dot(up_) > 0;  // upside down has no residual
  }

 private:
  Eigen::Matrix<double, 2, 3> across_;
  Eigen::Vector3d up_;
};

class ComponentTerm final : public Term {
 public:
  ComponentTerm(const Observed& what, std::size_t block, Eigen::Index component, Eigen::Index size,
                double value, double sd)
      : Term(what.kind, what.index, what.mark, {block}, 1),
        component_(component),
        size_(size),
        value_(value),
        sd_(sd) {}

  bool linearize(const double* const* values, Linear& out) const override {
    out.residual.resize(1);
    out.residual[0] = (values[0][component_] - value_) / sd_;
    out.by_block[0].setZero(1, size_);
    out.by_block[0](0, component_) = 1 / sd_;
    return true;
  }

 private:
  Eigen::Index component_, size_;
  double value_, sd_;
};

class SurfaceTerm final : public Term {
 public:
  SurfaceTerm(const Observed& what, std::size_t point, const ObservedSurface& surface,
              const Eigen::Vector3d& origin)
      : Term(what.kind, what.index, 0, {point}, 1), surface_(surface), origin_(origin) {}

  bool linearize(const double* const* values, Linear& out) const override {
    const Eigen::Vector3d at = Eigen::Map<const Eigen::Vector3d>(values[0]) + origin_;
    const double d = surface_.step;
    const auto here = surface_.height(at.x(), at.y());
    const auto east = surface_.height(at.x() + d, at.y()), west = surface_.height(at.x() - d, at.y());
    const auto north = surface_.height(at.x(), at.y() + d), south = surface_.height(at.x(), at.y() - d);
    out.residual.setZero(1);
    out.by_block[0].setZero(1, 3);
    if (!here || !east || !west || !north || !south) return true;  // off the surface: says nothing
    out.residual[0] = (at.z() - *here) / surface_.sd;
    out.by_block[0] << (*west - *east) / (2 * d), (*south - *north) / (2 * d), 1;
    out.by_block[0] /= surface_.sd;
    return true;
  }

 private:
  const ObservedSurface& surface_;
  Eigen::Vector3d origin_;
};

class HeightAboveGroundTerm final : public Term {
 public:
  HeightAboveGroundTerm(const Observed& what, std::size_t pose, std::size_t point, double height, double sd)
      : Term(what.kind, what.index, 0, {pose, point}, 1), height_(height), sd_(sd) {}

  bool linearize(const double* const* values, Linear& out) const override {
    out.residual.setConstant(1, (values[0][6] - values[1][2] - height_) / sd_);
    out.by_block[0].setZero(1, 6);
    out.by_block[0](0, 5) = 1 / sd_;
    out.by_block[1].setZero(1, 3);
    out.by_block[1](0, 2) = -1 / sd_;
    return true;
  }

 private:
  double height_, sd_;
};

}  // namespace

std::unique_ptr<Term> height_above_ground_term(const Observed& what, std::size_t pose, std::size_t point,
                                               double offset, double height, double sd) {
  return std::make_unique<HeightAboveGroundTerm>(what, pose, point, height + offset, sd);
}

std::unique_ptr<Term> mark_term(const Observed& what, const BlockIndices& blocks, const LensModel& model,
                                const Mark& mark) {
  return std::make_unique<MarkTerm>(what, blocks, model, mark);
}

std::unique_ptr<Term> moving_mark_term(const Observed& what, const BlockIndices& blocks,
                                       const LensModel& model, const Mark& mark, double readout_fraction) {
  return std::make_unique<MovingMarkTerm>(what, blocks, model, mark, readout_fraction);
}

std::unique_ptr<Term> shift_term(const Observed& what, const BlockIndices& blocks,
                                 const std::vector<double>& factors, double relative_sd) {
  return std::make_unique<ShiftTerm>(what, blocks, factors, relative_sd);
}

std::unique_ptr<Term> turn_term(const Observed& what, std::size_t motion, const Eigen::Vector3d& turn,
                                double sd) {
  return std::make_unique<TurnTerm>(what, motion, turn, sd);
}

std::unique_ptr<Term> position_term(const Observed& what, const BlockIndices& blocks, bool pose,
                                    const Eigen::Vector3d& value, const Eigen::Vector3d& sd) {
  std::vector<int> axes;
  for (int axis = 0; axis < 3; ++axis)
    if (sd[axis] > 0 && std::isfinite(sd[axis])) axes.push_back(axis);
  if (axes.empty()) return nullptr;
  return std::make_unique<PositionTerm>(what, blocks, axes, pose, value, sd);
}

std::unique_ptr<Term> attitude_term(const Observed& what, std::size_t pose, const ObservedAttitude& seen) {
  return std::make_unique<AttitudeTerm>(what, pose, seen);
}

std::unique_ptr<Term> up_term(const Observed& what, std::size_t pose, const ObservedUp& seen) {
  return std::make_unique<UpTerm>(what, pose, seen);
}

std::unique_ptr<Term> component_term(const Observed& what, std::size_t block, Eigen::Index component,
                                     Eigen::Index size, double value, double sd) {
  return std::make_unique<ComponentTerm>(what, block, component, size, value, sd);
}

std::unique_ptr<Term> surface_term(const Observed& what, std::size_t point, const ObservedSurface& surface,
                                   const Eigen::Vector3d& origin) {
  return std::make_unique<SurfaceTerm>(what, point, surface, origin);
}

}  // namespace waymark::pipeline
