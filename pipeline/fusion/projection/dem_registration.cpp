// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/projection/dem_registration.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/solve.hpp"
#include "pipeline/fusion/projection/position_covariance.hpp"
#include "pipeline/fusion/projection/shaded_relief.hpp"

namespace waymark::pipeline {
namespace {

constexpr int kParts = 3;  // regressors of brightness: light, its square, height
constexpr int kUnknowns = 6 + kParts;
constexpr double kConverged = 0.25;  // squared step in standard deviations
constexpr double kCoarseSteps = 8;
constexpr float kNoValue = std::numeric_limits<float>::quiet_NaN();
using Vector6 = Eigen::Vector<double, 6>;
using Vector = Eigen::Vector<double, kUnknowns>;
using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Parts = Eigen::Vector<double, kParts>;

PosedCamera apply_correction(PosedCamera view, const Vector6& by) {
  auto& pose = view.grid_from_camera.transform;
  const Eigen::Vector3d turn = by.head<3>();
  if (turn.norm() > 0) pose.linear() = pose.linear() * Eigen::AngleAxisd(turn.norm(), turn.normalized());
  pose.translation() += by.tail<3>();
  return view;
}

float interpolate(const Pixels& pixels, double x, double y) {
  if (!(x >= 0 && y >= 0 && x <= double(pixels.columns() - 1) && y <= double(pixels.rows() - 1)))
    return kNoValue;
  const auto i = std::min(static_cast<std::int64_t>(x), pixels.columns() - 2);
  const auto j = std::min(static_cast<std::int64_t>(y), pixels.rows() - 2);
  const auto u = static_cast<float>(x - double(i)), v = static_cast<float>(y - double(j));
  return std::lerp(std::lerp(pixels(i, j), pixels(i + 1, j), u),
                   std::lerp(pixels(i, j + 1), pixels(i + 1, j + 1), u), v);
}

// Scales to unit variance and clamps at 3, since shadows of rocks are not slopes.
void standardise(Grid<float>& values) {
  double squares = 0, n = 0;
  for (const float v : values.cells())
    if (!std::isnan(v)) squares += double(v) * double(v), ++n;
  if (!(squares > 0)) return;
  const auto scale = static_cast<float>(1 / std::sqrt(squares / n));
  for (float& v : values.cells()) v = std::isnan(v) ? v : std::clamp(v * scale, -3.0F, 3.0F);
}

struct Sums {
  Vector score = Vector::Zero();
  Matrix slope = Matrix::Zero();
  double count = 0, brightness = 0, predicted = 0, both = 0;
};

class ShadingRegistration {
 public:
  ShadingRegistration(const Pixels& pixels, const ImageView& image, const Terrain& terrain,
                      const Eigen::Vector2d& low, const Eigen::Vector2d& high, int cells,
                      const DemRegistrationRules& rules)
      : image_(image), rules_(rules), relief_(shaded_relief(terrain, low, high, cells, *image.sun)) {
    factor_ = std::max(1, static_cast<int>(std::min(relief_.step_x, relief_.step_y) / image.gsd / 2));
    pixels_ = downsample(pixels, factor_);
    if (pixels_.columns() < 8 || pixels_.rows() < 8 || relief_.height.columns() < 8 ||
        relief_.height.rows() < 8)
      pixels_ = {};
    Grid<float> squared = relief_.light;
    parts_[0] = high_pass(relief_.light, rules.fine_radius);
    for (std::size_t i = 0; i < squared.cells().size(); ++i)
      squared.cells()[i] = parts_[0].cells()[i] * parts_[0].cells()[i];
    parts_[1] = high_pass(squared, rules.fine_radius);
    parts_[2] = high_pass(relief_.height, rules.fine_radius);
    for (auto& part : parts_) standardise(part);
  }

  bool possible() const { return !pixels_.cells().empty(); }

  // Computes the high-pass filtered brightness of the cells for a pose.
  void look(const Vector6& correction) {
    view_ = apply_correction(*image_.view, correction);
    posed_.view = view_;
    Grid<float> seen(relief_.height.columns(), relief_.height.rows(), kNoValue);
    tbb::parallel_for(std::int64_t{0}, seen.rows(), [&](std::int64_t r) {
      for (std::int64_t c = 0; c < seen.columns(); ++c) {
        const Eigen::Vector3d at = relief_.at(c, r);
        if (std::isnan(at.z())) continue;
        const auto pixel = project(view_, Point<GridFrame>{at});
        if (pixel)
          seen(c, r) =
              interpolate(pixels_, (pixel->x() + 0.5) / factor_ - 0.5, (pixel->y() + 0.5) / factor_ - 0.5);
      }
    });
    brightness_ = high_pass(seen, rules_.fine_radius);
    standardise(brightness_);
  }

  // Regresses brightness on the parts by least squares.
  Parts weights() const {
    Eigen::Matrix<double, kParts, kParts> normal = Eigen::Matrix<double, kParts, kParts>::Identity() * 1e-9;
    Parts right = Parts::Zero();
    for (std::size_t i = 0; i < brightness_.cells().size(); ++i) {
      const Parts p = parts_at(i);
      const double b = double(brightness_.cells()[i]);
      if (std::isnan(b) || std::isnan(p.sum())) continue;
      normal += p * p.transpose();
      right += b * p;
    }
    return solve_symmetric(normal, right);
  }

  std::vector<Sums> blocks(const Parts& weight) const {
    const std::int64_t side = rules_.block, across = (brightness_.columns() + side - 1) / side,
                       down = (brightness_.rows() + side - 1) / side;
    std::vector<Sums> all(static_cast<std::size_t>(across * down));
    tbb::parallel_for(std::int64_t{0}, across * down, [&](std::int64_t b) {
      const std::int64_t left = b % across * side, top = b / across * side;
      Sums sums;
      for (std::int64_t r = std::max<std::int64_t>(top, 1); r < std::min(top + side, brightness_.rows() - 1);
           ++r)
        for (std::int64_t c = std::max<std::int64_t>(left, 1);
             c < std::min(left + side, brightness_.columns() - 1); ++c)
          add(sums, c, r, weight);
      all[static_cast<std::size_t>(b)] = sums;
    });
    std::erase_if(all, [](const Sums& sums) { return !(sums.count > 0); });
    return all;
  }

 private:
  Parts parts_at(std::size_t i) const {
    return {double(parts_[0].cells()[i]), double(parts_[1].cells()[i]), double(parts_[2].cells()[i])};
  }

  // Returns the gradient per metre east and north.
  Eigen::RowVector2d gradient(const Grid<float>& g, std::int64_t c, std::int64_t r) const {
    return {double(g(c + 1, r) - g(c - 1, r)) / (2 * relief_.step_x),
            double(g(c, r - 1) - g(c, r + 1)) / (2 * relief_.step_y)};
  }

  void add(Sums& sums, std::int64_t c, std::int64_t r, const Parts& weight) const {
    const Parts parts(double(parts_[0](c, r)), double(parts_[1](c, r)), double(parts_[2](c, r)));
    const double b = double(brightness_(c, r)), predicted = weight.dot(parts);
    const Eigen::RowVector2d image_gradient = gradient(brightness_, c, r);
    Eigen::RowVector2d model_gradient = Eigen::RowVector2d::Zero();
    for (int k = 0; k < kParts; ++k)
      model_gradient += weight[k] * gradient(parts_[static_cast<std::size_t>(k)], c, r);
    if (std::isnan(b + predicted + image_gradient.sum() + model_gradient.sum())) return;
    const Eigen::Vector3d at = relief_.at(c, r), along = at - view_.centre().xyz;
    const Eigen::Matrix<double, 2, 6> per_pose = pose_jacobian(posed_, {view_.centre(), {along.normalized()}},
                                                               GroundPlane{at, Eigen::Vector2d::Zero()})
                                                     .topRows<2>();
    // An image corrected by x shows at a point the value it had at that point minus per_pose x.
    Vector instrument, row;
    instrument << (model_gradient * per_pose).transpose(), parts;
    row << (image_gradient * per_pose).transpose(), parts;
    const double left = b - predicted;
    sums.score += instrument * left;
    sums.slope += instrument * row.transpose();
    ++sums.count;
    sums.brightness += b * b, sums.predicted += predicted * predicted, sums.both += b * predicted;
  }

  const ImageView& image_;
  const DemRegistrationRules& rules_;
  ShadedRelief relief_;
  std::array<Grid<float>, kParts> parts_;
  Pixels pixels_;
  int factor_ = 1;
  PosedCamera view_;
  ImageView posed_;  // holds only the view
  Grid<float> brightness_;
};

struct Estimate {
  Vector6 correction = Vector6::Zero();
  PoseConstraint tie;
  bool sound = false;
};

Estimate refine(ShadingRegistration& registration, Estimate from, const Eigen::Matrix<double, 6, 6>& prior,
                const DemRegistrationRules& rules) {
  Estimate to = from;
  to.sound = false;
  if (!registration.possible()) return to;
  for (int round = 0; round < rules.rounds; ++round) {
    registration.look(to.correction);
    const Parts weight = registration.weights();
    const std::vector<Sums> blocks = registration.blocks(weight);
    const auto n = static_cast<double>(blocks.size());
    if (!(n >= rules.min_blocks)) return to;
    Sums all;
    Matrix scatter = Matrix::Zero();
    for (const Sums& block : blocks) {
      all.score += block.score, all.slope += block.slope;
      all.brightness += block.brightness, all.predicted += block.predicted, all.both += block.both;
      scatter += block.score * block.score.transpose();
    }
    scatter *= n / (n - kUnknowns);
    const double correlation = all.both / std::sqrt(std::max(all.brightness * all.predicted, 1e-30));
    if (!(correlation >= rules.min_correlation) || !(weight[0] > 0)) return to;
    const Eigen::LDLT<Matrix> inverse(scatter);
    const Matrix carried = inverse.solve(all.slope);
    const Matrix information = all.slope.transpose() * carried;
    const Vector right = carried.transpose() * all.score;
    // Marginalises the weights of the parts.
    const auto cross = information.topRightCorner<6, kParts>();
    const Eigen::LDLT<Eigen::Matrix<double, kParts, kParts>> others(
        information.bottomRightCorner<kParts, kParts>());
    to.tie.information =
        information.topLeftCorner<6, 6>() - cross * others.solve(Eigen::MatrixXd(cross.transpose()));
    const Vector6 information_vector =
        right.head<6>() - cross * others.solve(Eigen::VectorXd(right.tail<kParts>()));
    to.tie.information_vector = to.tie.information * to.correction + information_vector;
    if (!to.tie.information.allFinite() || !to.tie.information_vector.allFinite()) return to;
    const Eigen::Matrix<double, 6, 6> both = to.tie.information + prior;
    const Vector6 next = solve_symmetric(both, to.tie.information_vector), step = next - to.correction;
    to.correction = next;
    if (step.dot(both * step) < kConverged) break;
  }
  const Vector6 apart = solve_symmetric(to.tie.information, to.tie.information_vector) - to.correction;
  const double distance = apart.dot(to.tie.information * apart) + to.correction.dot(prior * to.correction);
  to.sound = distance <= rules.gate;
  return to;
}

}  // namespace

std::optional<PoseConstraint> register_to_dem(const Pixels& pixels, const ImageView& image,
                                              const Terrain& terrain, double metres_per_unit,
                                              const DemRegistrationRules& rules) {
  if (!image.view || !image.sun || !(image.gsd > 0) || !(image.view->covariance.trace() > 0))
    return std::nullopt;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& ring : image.footprint)
    for (const auto& corner : ring)
      low = low.cwiseMin(corner * metres_per_unit), high = high.cwiseMax(corner * metres_per_unit);
  if (!(low.array() < high.array()).all()) return std::nullopt;
  Eigen::Matrix<double, 6, 6> given = image.view->covariance;
  given.diagonal() += Eigen::Vector<double, 6>::Constant(1e-14);
  given.diagonal().tail<3>() += Eigen::Vector3d::Constant(1e-8);
  const Eigen::Matrix<double, 6, 6> prior = inverse_by_lu(given);

  const double step = std::max(terrain.step_x(), terrain.step_y());
  const Eigen::Vector2d size = high - low;
  const double finest = std::max({1.0, 1.5 * image.gsd / step,
                                  std::sqrt(size.prod() / (terrain.step_x() * terrain.step_y()) /
                                            static_cast<double>(rules.max_cells))});
  const int cells = static_cast<int>(std::ceil(finest - 1e-9));
  // Coarse to fine: starts with cells larger than the uncertainty of the pose.
  const Eigen::Vector3d centre = image.view->centre().xyz;
  const Eigen::Vector3d middle((low.x() + high.x()) / 2, (low.y() + high.y()) / 2,
                               (terrain.min_height() + terrain.max_height()) / 2);
  const auto per_pose = pose_jacobian(image, {{centre}, {(middle - centre).normalized()}},
                                      GroundPlane{middle, Eigen::Vector2d::Zero()});
  const double sd = std::sqrt((per_pose * given * per_pose.transpose()).topLeftCorner<2, 2>().trace());
  int coarse = 1;
  while (coarse < 16 && coarse * cells * step < kCoarseSteps * sd) coarse *= 2;
  Estimate estimate;
  for (; coarse >= 1; coarse /= 2) {
    ShadingRegistration registration(pixels, image, terrain, low, high, coarse * cells, rules);
    const Estimate next = refine(registration, estimate, prior, rules);
    if (coarse == 1 && !next.sound) return std::nullopt;
    if (next.sound) estimate = next;
  }
  return estimate.tie;
}

}  // namespace waymark::pipeline
