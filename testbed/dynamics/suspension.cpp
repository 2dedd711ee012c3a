// SPDX-License-Identifier: Apache-2.0
#include "testbed/dynamics/suspension.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/error.hpp"

namespace waymark::testbed {
namespace {

constexpr double kDampingRatio = 0.5;
constexpr double kMaxLinkAngle = 0.6;    // rad: stops of rockers and bogies
constexpr double kMaxDampingLoad = 1.5;  // of the load at rest: an edge is no hammer
constexpr int kMaxRounds = 8;            // of the search for the wheels that touch

/// Returns the wheels of one side, from the front to the rear.
std::vector<Eigen::Index> wheels_of_side(std::span<const Eigen::Vector2d> wheels, bool left) {
  std::vector<Eigen::Index> side;
  for (std::size_t i = 0; i < wheels.size(); ++i)
    if ((wheels[i].y() > 0) == left) side.push_back(static_cast<Eigen::Index>(i));
  std::ranges::sort(side, [&](Eigen::Index a, Eigen::Index b) {
    return wheels[static_cast<std::size_t>(a)].x() > wheels[static_cast<std::size_t>(b)].x();
  });
  return side;
}

[[noreturn]] void refuse(const std::string& kind, const std::string& needs) {
  throw Error(ErrorCode::usage, "the suspension " + kind + " needs " + needs, "vehicle",
              "set \"suspension\": \"rigid\", or list other wheels");
}

Eigen::MatrixXd lift_of_links(std::span<const Eigen::Vector2d> wheels, const std::string& kind) {
  const auto count = static_cast<Eigen::Index>(wheels.size());
  const auto x = [&](Eigen::Index wheel) { return wheels[static_cast<std::size_t>(wheel)].x(); };
  std::vector<Eigen::VectorXd> links;
  const auto bogie = [&](Eigen::Index front, Eigen::Index rear) {
    Eigen::VectorXd lift = Eigen::VectorXd::Zero(count);
    lift[front] = (x(front) - x(rear)) / 2, lift[rear] = -lift[front];
    links.push_back(lift);
  };
  if (kind == "rocker_bogie") {
    Eigen::VectorXd differential = Eigen::VectorXd::Zero(count);
    for (const bool left : {true, false}) {
      const auto side = wheels_of_side(wheels, left);
      if (side.size() != 3) refuse(kind, "three wheels on each side");
      bogie(side[1], side[2]);
      // The pivot of the rocker lies where all three wheels bear equal loads.
      const double pivot = (x(side[0]) + x(side[1]) + x(side[2])) / 3,
                   carrier = (x(side[1]) + x(side[2])) / 2;
      const double turn = left ? 1 : -1;
      differential[side[0]] = turn * (x(side[0]) - pivot);
      differential[side[1]] = differential[side[2]] = turn * (carrier - pivot);
    }
    links.push_back(differential);
  } else if (kind == "bogie") {
    for (const bool left : {true, false}) {
      const auto side = wheels_of_side(wheels, left);
      if (side.size() < 3) refuse(kind, "three wheels or more on each side");
      bogie(side[0], side[1]);
      if (side.size() == 4) bogie(side[2], side[3]);
    }
  }
  Eigen::MatrixXd lift(count, static_cast<Eigen::Index>(links.size()));
  for (std::size_t link = 0; link < links.size(); ++link)
    lift.col(static_cast<Eigen::Index>(link)) = links[link];
  return lift;
}

/// Returns the least loads, in the square, that carry the weight above the origin without a moment and keep
/// the links in balance.
Eigen::VectorXd loads_at_rest(std::span<const Eigen::Vector2d> wheels, const Eigen::MatrixXd& lift,
                              double weight) {
  const auto count = static_cast<Eigen::Index>(wheels.size());
  Eigen::MatrixXd balance(3 + lift.cols(), count);
  for (Eigen::Index i = 0; i < count; ++i) balance.col(i).head<3>() << 1, wheels[static_cast<std::size_t>(i)];
  balance.bottomRows(lift.cols()) = lift.transpose();
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(balance.rows());
  sums[0] = weight;
  return balance.completeOrthogonalDecomposition().solve(sums);
}

}  // namespace

Suspension::Suspension(std::span<const Eigen::Vector2d> wheels, const std::string& kind, double mass,
                       double gravity, double sag)
    : lift_per_angle_(lift_of_links(wheels, kind)) {
  rest_loads_ = loads_at_rest(wheels, lift_per_angle_, mass * gravity);
  if (!(rest_loads_.minCoeff() > 0))
    throw Error(ErrorCode::usage, "the centre of mass is not between the wheels", "vehicle",
                "the origin of the supports is below the centre of mass");
  angles_ = Eigen::VectorXd::Zero(lift_per_angle_.cols());
  const double carried = mass / static_cast<double>(wheels.size());
  stiffness_ = carried * gravity / sag;
  damping_ = 2 * kDampingRatio * std::sqrt(stiffness_ * carried);
}

std::vector<double> Suspension::forces(std::span<const Contact> contacts, double dt) {
  const Eigen::Index wheels = rest_loads_.size(), links = angles_.size();
  const Eigen::VectorXd before = angles_;
  Eigen::VectorXd force(wheels);
  std::vector<bool> touches(static_cast<std::size_t>(wheels), true);
  const auto damped = [&](Eigen::Index i, double speed) {
    return std::clamp(damping_ * speed, -kMaxDampingLoad * rest_loads_[i], kMaxDampingLoad * rest_loads_[i]);
  };
  for (int round = 0; round < kMaxRounds; ++round) {
    // Newton's step of the balance of moments, in which wheels in the air take no part.
    Eigen::MatrixXd slope = Eigen::MatrixXd::Identity(links, links) * 1e-6 * stiffness_;
    Eigen::VectorXd moment = Eigen::VectorXd::Zero(links);
    bool changed = false;
    const Eigen::VectorXd lift = lift_per_angle_ * angles_;
    const Eigen::VectorXd turned = lift_per_angle_ * (angles_ - before) / dt;
    for (Eigen::Index i = 0; i < wheels; ++i) {
      const Contact& contact = contacts[static_cast<std::size_t>(i)];
      const double spring = rest_loads_[i] + stiffness_ * (contact.lift - lift[i]);
      force[i] = spring > 0 ? std::max(0.0, spring + damped(i, contact.speed - turned[i])) : 0;
      const bool on_ground = force[i] > 0;
      changed |= on_ground != touches[static_cast<std::size_t>(i)];
      touches[static_cast<std::size_t>(i)] = on_ground;
      if (!on_ground) continue;
      const Eigen::VectorXd arm = lift_per_angle_.row(i).transpose();
      moment += arm * force[i];
      slope += arm * arm.transpose() * (stiffness_ + damping_ / dt);
    }
    if (links == 0) break;
    const Eigen::VectorXd turn = slope.ldlt().solve(moment);
    angles_ = (angles_ + turn).cwiseMax(-kMaxLinkAngle).cwiseMin(kMaxLinkAngle);
    if (!changed && turn.cwiseAbs().maxCoeff() < 1e-9) break;
  }
  return {force.data(), force.data() + force.size()};
}

}  // namespace waymark::testbed
