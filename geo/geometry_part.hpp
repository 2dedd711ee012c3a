// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>
namespace waymark::inline geo {

/// Piece of a geometry.
struct GeometryPart {
  enum class Kind { point, line, outline, hole };
  Kind kind = Kind::point;
  std::vector<Eigen::Vector3d> vertices;  ///< of an outline or a hole without a repetition of the first
};

}  // namespace waymark::inline geo
