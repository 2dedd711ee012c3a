// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/ground_match.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "pipeline/fusion/lit_relief.hpp"
#include "pipeline/fusion/place_covariance.hpp"

namespace waymark {
namespace {

constexpr int kParts = 3;  // what brightness is explained by: light, its square, height
constexpr int kUnknowns = 6 + kParts;
constexpr double kSettled = 0.25;  // of a squared step in standard deviations
constexpr double kCoarseSteps = 8;
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
using Vector6 = Eigen::Vector<double, 6>;
using Vector = Eigen::Vector<double, kUnknowns>;
using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Parts = Eigen::Vector<double, kParts>;

PosedCamera moved(PosedCamera view, const Vector6& by) {
  auto& pose = view.grid_from_camera.transform;
  const Eigen::Vector3d turn = by.head<3>();
  if (turn.norm() > 0) pose.linear() = pose.linear() * Eigen::AngleAxisd(turn.norm(), turn.normalized());
  pose.translation() += by.tail<3>();
  return view;
}

float between(const Pixels& pixels, double x, double y) {
  if (!(x >= 0 && y >= 0 && x <= double(pixels.columns() - 1) && y <= double(pixels.rows() - 1)))
    return kNothing;
  const auto i = std::min(static_cast<std::int64_t>(x), pixels.columns() - 2);
  const auto j = std::min(static_cast<std::int64_t>(y), pixels.rows() - 2);
  const auto u = static_cast<float>(x - double(i)), v = static_cast<float>(y - double(j));
  return std::lerp(std::lerp(pixels(i, j), pixels(i + 1, j), u),
                   std::lerp(pixels(i, j + 1), pixels(i + 1, j + 1), u), v);
}

// Scaled to a spread of 1 and cut at three of it: shadows of rocks are no slopes.
void level_out(Grid<float>& values) {
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

class Matching {
 public:
  Matching(const Pixels& pixels, const ImageView& image, const Terrain& terrain, const Eigen::Vector2d& low,
           const Eigen::Vector2d& high, int cells, const GroundMatchRules& rules)
      : image_(image), rules_(rules), relief_(lit_relief(terrain, low, high, cells, *image.sun)) {
    factor_ = std::max(1, static_cast<int>(std::min(relief_.step_x, relief_.step_y) / image.gsd / 2));
    pixels_ = reduced(pixels, factor_);
    if (pixels_.columns() < 8 || pixels_.rows() < 8 || relief_.height.columns() < 8 ||
        relief_.height.rows() < 8)
      pixels_ = {};
    Grid<float> squared = relief_.light;
    parts_[0] = fine_part(relief_.light, rules.fine_radius);
    for (std::size_t i = 0; i < squared.cells().size(); ++i)
      squared.cells()[i] = parts_[0].cells()[i] * parts_[0].cells()[i];
    parts_[1] = fine_part(squared, rules.fine_radius);
    parts_[2] = fine_part(relief_.height, rules.fine_radius);
    for (auto& part : parts_) level_out(part);
  }

  bool possible() const { return !pixels_.cells().empty(); }

  // Brightness of the cells from a pose; the fine part of it.
  void look(const Vector6& correction) {
    view_ = moved(*image_.view, correction);
    posed_.view = view_;
    Grid<float> seen(relief_.height.columns(), relief_.height.rows(), kNothing);
    tbb::parallel_for(std::int64_t{0}, seen.rows(), [&](std::int64_t r) {
      for (std::int64_t c = 0; c < seen.columns(); ++c) {
        const Eigen::Vector3d at = relief_.at(c, r);
        if (std::isnan(at.z())) continue;
        const auto pixel = project(view_, Point<GridFrame>{at});
        if (pixel)
          seen(c, r) =
              between(pixels_, (pixel->x() + 0.5) / factor_ - 0.5, (pixel->y() + 0.5) / factor_ - 0.5);
      }
    });
    brightness_ = fine_part(seen, rules_.fine_radius);
    level_out(brightness_);
  }

  // How brightness hangs on the parts, by least squares.
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
    return normal.ldlt().solve(right);
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

  // Per metre east and north.
  Eigen::RowVector2d gradient(const Grid<float>& g, std::int64_t c, std::int64_t r) const {
    return {double(g(c + 1, r) - g(c - 1, r)) / (2 * relief_.step_x),
            double(g(c, r - 1) - g(c, r + 1)) / (2 * relief_.step_y)};
  }

  void add(Sums& sums, std::int64_t c, std::int64_t r, const Parts& weight) const {
    const Parts parts(double(parts_[0](c, r)), double(parts_[1](c, r)), double(parts_[2](c, r)));
    const double b = double(brightness_(c, r)), predicted = weight.dot(parts);
    const Eigen::RowVector2d of_image = gradient(brightness_, c, r);
    Eigen::RowVector2d of_model = Eigen::RowVector2d::Zero();
    for (int k = 0; k < kParts; ++k)
      of_model += weight[k] * gradient(parts_[static_cast<std::size_t>(k)], c, r);
    if (std::isnan(b + predicted + of_image.sum() + of_model.sum())) return;
    const Eigen::Vector3d at = relief_.at(c, r), along = at - view_.centre().xyz;
    const Eigen::Matrix<double, 2, 6> per_pose = pose_jacobian(posed_, {view_.centre(), {along.normalized()}},
                                                               GroundPlane{at, Eigen::Vector2d::Zero()})
                                                     .topRows<2>();
    // A pose moved by x shows at a place what it showed at the place minus per_pose x.
    Vector instrument, row;
    instrument << (of_model * per_pose).transpose(), parts;
    row << (of_image * per_pose).transpose(), parts;
    const double left = b - predicted;
    sums.score += instrument * left;
    sums.slope += instrument * row.transpose();
    ++sums.count;
    sums.brightness += b * b, sums.predicted += predicted * predicted, sums.both += b * predicted;
  }

  const ImageView& image_;
  const GroundMatchRules& rules_;
  LitRelief relief_;
  std::array<Grid<float>, kParts> parts_;
  Pixels pixels_;
  int factor_ = 1;
  PosedCamera view_;
  ImageView posed_;  // nothing but the view
  Grid<float> brightness_;
};

struct Estimate {
  Vector6 correction = Vector6::Zero();
  PoseTie tie;
  bool sound = false;
};

Estimate refined(Matching& matching, Estimate from, const Eigen::Matrix<double, 6, 6>& prior,
                 const GroundMatchRules& rules) {
  Estimate to = from;
  to.sound = false;
  if (!matching.possible()) return to;
  for (int round = 0; round < rules.rounds; ++round) {
    matching.look(to.correction);
    const Parts weight = matching.weights();
    const std::vector<Sums> blocks = matching.blocks(weight);
    const auto n = static_cast<double>(blocks.size());
    if (!(n >= rules.least_blocks)) return to;
    Sums all;
    Matrix scatter = Matrix::Zero();
    for (const Sums& block : blocks) {
      all.score += block.score, all.slope += block.slope;
      all.brightness += block.brightness, all.predicted += block.predicted, all.both += block.both;
      scatter += block.score * block.score.transpose();
    }
    scatter *= n / (n - kUnknowns);
    const double correlation = all.both / std::sqrt(std::max(all.brightness * all.predicted, 1e-30));
    if (!(correlation >= rules.least_correlation) || !(weight[0] > 0)) return to;
    const Eigen::LDLT<Matrix> inverse(scatter);
    const Matrix carried = inverse.solve(all.slope);
    const Matrix information = all.slope.transpose() * carried;
    const Vector right = carried.transpose() * all.score;
    // The weights of the parts are of no interest.
    const auto cross = information.topRightCorner<6, kParts>();
    const Eigen::LDLT<Eigen::Matrix<double, kParts, kParts>> others(
        information.bottomRightCorner<kParts, kParts>());
    to.tie.information =
        information.topLeftCorner<6, 6>() - cross * others.solve(Eigen::MatrixXd(cross.transpose()));
    const Vector6 pull = right.head<6>() - cross * others.solve(Eigen::VectorXd(right.tail<kParts>()));
    to.tie.pull = to.tie.information * to.correction + pull;
    if (!to.tie.information.allFinite() || !to.tie.pull.allFinite()) return to;
    const Eigen::Matrix<double, 6, 6> both = to.tie.information + prior;
    const Vector6 next = both.ldlt().solve(to.tie.pull), step = next - to.correction;
    to.correction = next;
    if (step.dot(both * step) < kSettled) break;
  }
  const Vector6 apart = to.tie.information.ldlt().solve(to.tie.pull) - to.correction;
  const double distance = apart.dot(to.tie.information * apart) + to.correction.dot(prior * to.correction);
  to.sound = distance <= rules.gate;
  return to;
}

}  // namespace

std::optional<PoseTie> match_ground(const Pixels& pixels, const ImageView& image, const Terrain& terrain,
                                    double metres_per_unit, const GroundMatchRules& rules) {
  if (!image.view || !image.sun || !(image.gsd > 0) || !(image.view->covariance.trace() > 0))
    return std::nullopt;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& ring : image.footprint)
    for (const auto& corner : ring)
      low = low.cwiseMin(corner * metres_per_unit), high = high.cwiseMax(corner * metres_per_unit);
  if (!(low.array() < high.array()).all()) return std::nullopt;
  Eigen::Matrix<double, 6, 6> told = image.view->covariance;
  told.diagonal() += Eigen::Vector<double, 6>::Constant(1e-14);
  told.diagonal().tail<3>() += Eigen::Vector3d::Constant(1e-8);
  const Eigen::Matrix<double, 6, 6> prior = told.inverse();

  const double step = std::max(terrain.step_x(), terrain.step_y());
  const Eigen::Vector2d size = high - low;
  const double finest = std::max({1.0, 1.5 * image.gsd / step,
                                  std::sqrt(size.prod() / (terrain.step_x() * terrain.step_y()) /
                                            static_cast<double>(rules.most_cells))});
  const int cells = static_cast<int>(std::ceil(finest - 1e-9));
  // From cells far coarser than the pose is uncertain: most of the way at little cost.
  const Eigen::Vector3d centre = image.view->centre().xyz;
  const Eigen::Vector3d middle((low.x() + high.x()) / 2, (low.y() + high.y()) / 2,
                               (terrain.lowest() + terrain.highest()) / 2);
  const auto per_pose = pose_jacobian(image, {{centre}, {(middle - centre).normalized()}},
                                      GroundPlane{middle, Eigen::Vector2d::Zero()});
  const double sd = std::sqrt((per_pose * told * per_pose.transpose()).topLeftCorner<2, 2>().trace());
  int coarse = 1;
  while (coarse < 16 && coarse * cells * step < kCoarseSteps * sd) coarse *= 2;
  Estimate estimate;
  for (; coarse >= 1; coarse /= 2) {
    Matching matching(pixels, image, terrain, low, high, coarse * cells, rules);
    const Estimate next = refined(matching, estimate, prior, rules);
    if (coarse == 1 && !next.sound) return std::nullopt;
    if (next.sound) estimate = next;
  }
  return estimate.tie;
}

}  // namespace waymark
