// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "pipeline/reconstruction/adjustment/lens_model.hpp"
#include "pipeline/reconstruction/adjustment/observations.hpp"
#include "pipeline/reconstruction/reconstruction.hpp"
namespace waymark::pipeline {

struct AdjustmentOptions {
  /// Parameters of each lens to adjust, named as in lens_model(); lenses beyond the end stay as they are.
  std::vector<std::vector<std::string>> free_lens_parameters = {};
  std::vector<std::size_t> fixed_images = {};  ///< their poses stay as they are
  bool robust = true;        ///< Cauchy loss and removal of outliers before the last, plain solution
  double outlier_limit = 3;  ///< marks of larger residuals are removed, standard deviations
  double blunder_limit = 4;  ///< other observations of larger test statistics are removed (Baarda 1968)
  int max_iterations = 100;
  bool covariance = true;        ///< and, with `robust`, the blunder test, which needs it
  bool estimate_motions = true;  ///< of rolling shutters, with those expected of the poses of the neighbours
  /// Models that replace lens_model(), by lens; empty pointers do not.
  std::vector<std::shared_ptr<const LensModel>> lens_models = {};
};

/// Mark removed as an outlier, or because its point lies behind the camera.
struct RemovedMark {
  std::size_t point = 0;  ///< index into `Reconstruction::points`
  Mark mark = {};
  double residual = 0;  ///< pixels; NaN behind the camera
};

/// Outcome for a surveyed point.
struct ControlResult {
  std::string name = {};
  bool check = false, used = false;
  std::optional<Eigen::Vector3d> position = {};     ///< estimated; of a check point by its marks alone
  std::optional<Eigen::Matrix3d> covariance = {};   ///< of `position`
  Eigen::Vector3d error = Eigen::Vector3d::Zero();  ///< estimated - surveyed; NaN where nothing was surveyed
  double mark_rms = 0;                              ///< residuals of its marks, pixels
  double statistic = 0;                             ///< of the blunder test, standard deviations
  std::string note = {};                            ///< why it is not used, and what to do
};

/// Outcome for another observation, for example a GPS position.
struct ObservationResult {
  std::string kind = {};  ///< "position", "attitude", "up", "height", "height above ground"
  std::size_t image = 0;
  bool used = false;
  Eigen::VectorXd error = {};  ///< estimated - observed
  double statistic = 0;        ///< of the blunder test, standard deviations
};

/// Estimate of a lens parameter.
struct LensParameter {
  std::string name = {};
  double value = 0, sd = 0;
};

/// Covariance of all that the cameras share: the parameters of the lenses, the poses, the height bias.
struct JointCovariance {
  Eigen::MatrixXd matrix = {};
  std::vector<Eigen::Index> lens_offset = {};  ///< first row of each lens, -1: fixed
  std::vector<Eigen::Index> pose_offset = {};  ///< first row of each image, -1: fixed or without pose
};

struct AdjustmentResult {
  bool converged = false;
  int iterations = 0;
  double sigma0 = 0;  ///< standard deviation of unit weight; 1 if the standard deviations given are right
  std::size_t observations = 0;  ///< scalar ones, in the last solution
  std::size_t unknowns = 0;      ///< scalar ones
  /// Freedoms of the frame that no observation fixes, of 7; covariances then hold for inner constraints.
  int free_datum = 0;
  bool determined = true;  ///< false: more unknowns than the frame are undetermined; no covariance
  std::vector<RemovedMark> removed = {};
  std::vector<RemovedMark> removed_control = {};  ///< `point`: index into `Observations::control`
  std::vector<ControlResult> control = {};        ///< as `Observations::control`
  std::vector<ObservationResult> others = {};
  std::vector<std::vector<LensParameter>> lenses = {};  ///< adjusted parameters by lens
  double height_bias = 0, height_bias_sd = 0;           ///< metres
  JointCovariance joint = {};

  double redundancy() const {
    return static_cast<double>(observations) - static_cast<double>(unknowns) + free_datum;
  }
};

/// Adjusts poses, lenses and tie points to their marks and the observations by least squares (bundle
/// adjustment), in place. Images without a pose and points without a position are left out.
/// - Removed marks leave the tie points; points with fewer than 2 marks lose their position.
/// - Covariances are scaled by sigma0.
/// - The order of images, points and observations does not affect the result.
/// Throws Error{input} if an observation names an image or lens that is not there, or nothing is adjustable.
AdjustmentResult adjust(Reconstruction& scene, const Observations& observations,
                        const AdjustmentOptions& options = {});

}  // namespace waymark::pipeline
