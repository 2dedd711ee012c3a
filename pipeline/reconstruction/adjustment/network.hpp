// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <memory>
#include <vector>
namespace waymark::pipeline {

/// Unknowns that are adjusted together.
struct Block {
  enum class Kind { lens, pose, bias, point, motion };
  Kind kind = Kind::point;
  /// Pose: quaternion (x, y, z, w) of world_from_camera, then centre. Motion: shift, then turn
  /// (ShutterMotion).
  Eigen::VectorXd value = {};
  std::vector<int> free = {};  ///< components of a change that are adjusted; none: the block is fixed
  Eigen::Index column = -1;    ///< of the first free component, among the points or among all others

  /// Returns the components of a change: 6 for a pose (rotation about the camera's axes, centre).
  Eigen::Index changes() const { return kind == Kind::pose ? 6 : value.size(); }
};

/// Observation as a function of at most four blocks, in units of its standard deviation.
class Term {
 public:
  static constexpr int kMaxRows = 3, kMaxColumns = 12;
  static constexpr std::size_t kMaxBlocks = 4;
  using Values = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxRows, 1>;
  using Jacobian =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMaxRows, kMaxColumns>;
  struct Linear {
    Values residual = {};
    std::array<Jacobian, kMaxBlocks> by_block = {};  ///< by the changes of each block
  };
  /// What is observed; indices into the input.
  enum class Kind {
    tie_mark,
    control_mark,
    control,
    position,
    attitude,
    up,
    height,
    lens,
    bias,
    surface,
    motion,  ///< expected of the poses of the neighbours
    height_above_ground,
  };

  Term(Kind observed, std::size_t first, std::size_t second, std::vector<std::size_t> of, int row_count)
      : kind(observed), index(first), mark_index(second), blocks(std::move(of)), rows(row_count) {}
  virtual ~Term() = default;
  /// Computes the residual and its derivatives at the values of its blocks. Returns false where it has none.
  virtual bool linearize(const double* const* values, Linear& out) const = 0;

  bool is_mark() const { return kind == Kind::tie_mark || kind == Kind::control_mark; }

  Kind kind;
  std::size_t index = 0, mark_index = 0;  ///< of the observation, and of the mark of its point
  std::vector<std::size_t> blocks;
  int rows;
};

/// Least squares problem. Blocks and terms stand in an order that does not depend on that of the input.
struct Network {
  std::vector<Block> blocks = {};
  std::vector<std::unique_ptr<Term>> terms = {};
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< subtracted from all positions
  Eigen::Index camera_columns = 0, point_columns = 0;

  /// Adds a block and returns its index.
  std::size_t add_block(Block::Kind kind, Eigen::VectorXd value, std::vector<int> free);
  /// Returns the residual of a term with its derivatives; false where it has none.
  bool linearize(const Term& term, Term::Linear& out) const;
  /// Numbers the free components.
  void number_columns();
};

/// Returns the pose of a block.
Eigen::Isometry3d pose_of(const double* block);
/// Applies a change to the value of a block.
void apply_change(Block::Kind kind, const double* value, const double* change, Eigen::Index size,
                  double* out);

}  // namespace waymark::pipeline
