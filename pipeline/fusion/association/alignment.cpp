// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/alignment.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "core/principal_axes.hpp"
#include "core/solve.hpp"
#include "pipeline/fusion/association/body_radius.hpp"
#include "pipeline/fusion/association/clustering.hpp"
#include "pipeline/fusion/association/shared_footprints.hpp"
#include "pipeline/fusion/projection/local_ground_plane.hpp"
#include "pipeline/fusion/projection/position_covariance.hpp"

namespace waymark::pipeline {
namespace {

using Index = std::uint32_t;
using Matrix26 = Eigen::Matrix<double, 2, 6>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// Observation that can tie its image to others.
struct TiePoint {
  Index observation = 0;
  int image = 0;  // of the views
  Matrix26 per_pose = Matrix26::Zero();
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d own;    // covariance without the contribution of the pose
  ObservedObject object;  // position before alignment
};

Eigen::Matrix2d clamp_eigenvalues(const Eigen::Matrix2d& matrix, double min_sd) {
  const PrincipalAxes axes = principal_axes(matrix);
  const Eigen::Vector2d along = axes.major_direction(), across = axes.minor_direction();
  return std::max(axes.major, min_sd * min_sd) * along * along.transpose() +
         std::max(axes.minor, min_sd * min_sd) * across * across.transpose();
}

// Propagates the covariance of a pose to a horizontal shift. A single product of three matrices costs a
// second of compile time each.
Eigen::Matrix2d propagate(const Matrix26& per_pose, const Matrix6& covariance) {
  const Matrix26 half = per_pose * covariance;
  return half * per_pose.transpose();
}

class BundleAdjustment {
 public:
  BundleAdjustment(std::span<const Observation> observations, std::span<const ImageView> images,
                   const Terrain& terrain, const TypeRegistry& types, const Crs& crs,
                   const AlignmentRules& rules)
      : images_(images), plane_(crs), metres_per_unit_(crs.metres_per_unit()), rules_(rules) {
    const auto n = static_cast<Eigen::Index>(images.size());
    sharing_ = shared_footprints(images);
    correction_ = Eigen::VectorXd::Zero(6 * n);
    prior_ = Eigen::MatrixXd::Zero(6 * n, 6 * n);
    mean_jacobian_ = Eigen::MatrixXd::Zero(2, 6 * n);
    std::map<std::string_view, int> index;
    for (Eigen::Index i = 0; i < n; ++i) {
      const ImageView& image = images[static_cast<std::size_t>(i)];
      index.emplace(image.name, static_cast<int>(i));
      Matrix6 prior = Matrix6::Zero();
      if (image.view) prior = image.view->covariance;
      // Regularises exact poses, which must not move: 1e-7 rad and 0.1 mm.
      prior.diagonal() += Eigen::Vector<double, 6>::Constant(1e-14);
      prior.diagonal().tail<3>() += Eigen::Vector3d::Constant(1e-8);
      stated_.push_back(prior);
      if (image.view) {
        const Matrix6& given = image.view->covariance;
        const bool everywhere = !rules.added_where_unstated;
        if (everywhere || given.diagonal().head<3>().isZero(0))
          prior.diagonal().head<3>().array() += rules.added_rotation_sd * rules.added_rotation_sd;
        if (everywhere || given.diagonal().tail<3>().isZero(0))
          prior.diagonal().tail<3>().array() += rules.added_position_sd * rules.added_position_sd;
      }
      prior_.block<6, 6>(6 * i, 6 * i) = prior;
    }
    std::vector<std::optional<BodyIndex>> sizes;
    for (const LandmarkType& type : types) sizes.push_back(body_index(type));
    std::vector<int> count(images.size(), 0);
    for (Index o = 0; o < observations.size(); ++o) {
      const auto image = index.find(observations[o].source);
      if (!observations[o].rejected.empty() || image == index.end()) continue;
      add(observations[o], o, image->second,
          body_radius(sizes[observations[o].type], observations[o].features), terrain);
      mean_jacobian_.block<2, 6>(0, 6 * image->second) += tie_points_.back().per_pose;
      ++count[static_cast<std::size_t>(image->second)];
    }
    int images_with_ties = 0;
    for (const int c : count) images_with_ties += c > 0;
    for (Eigen::Index i = 0; i < n; ++i)
      mean_jacobian_.block<2, 6>(0, 6 * i) /=
          std::max(count[static_cast<std::size_t>(i)], 1) * std::max(images_with_ties, 1);
  }

  void solve() {
    iterate({});
    for (int round = 0; round < rules_.rounds; ++round) {
      const std::vector<IndexPair> pairs = unambiguous_pairs();
      pairs_ = static_cast<int>(pairs.size());
      if (pairs.empty()) return;
      iterate(pairs);
    }
  }

  int pairs() const { return pairs_; }
  std::span<const TiePoint> tie_points() const { return tie_points_; }
  Eigen::Vector<double, 6> correction(int image) const { return correction_.segment<6>(6 * image); }
  Matrix6 covariance(int image) const { return posterior_.block<6, 6>(6 * image, 6 * image); }
  /// Covariance of the mean shift of all images.
  Eigen::Matrix2d common() const { return mean_cross_covariance() * mean_jacobian_.transpose(); }
  Eigen::Vector2d shift(const TiePoint& tie) const { return tie.per_pose * correction(tie.image); }
  /// Covariance of a tie's position relative to the mean of all images.
  Eigen::Matrix2d relative_covariance(const TiePoint& tie, const Eigen::MatrixXd& mean_cross_covariance,
                                      const Eigen::Matrix2d& mean) const {
    const Matrix26 cross = mean_cross_covariance.block<2, 6>(0, 6 * tie.image);
    const Eigen::Matrix2d both = tie.per_pose * cross.transpose();
    return propagate(tie.per_pose, covariance(tie.image)) - both - both.transpose() + mean;
  }
  Eigen::MatrixXd mean_cross_covariance() const { return mean_jacobian_ * posterior_; }

 private:
  void add(const Observation& o, Index number, int image, const std::optional<BodyRadius>& body,
           const Terrain& terrain) {
    TiePoint tie;
    tie.observation = number, tie.image = image;
    const ImageView& view = images_[static_cast<std::size_t>(image)];
    const Eigen::Vector3d at(o.position.xyz.x() * metres_per_unit_, o.position.xyz.y() * metres_per_unit_,
                             o.position.xyz.z());
    const double cell = std::max(terrain.step_x(), terrain.step_y());
    if (const auto ground =
            local_ground_plane(terrain, at.x(), at.y(), std::max(cell, body ? body->metres : 0)))
      tie.gradient = ground->gradient;
    Matrix26 on_slope = Matrix26::Zero();
    if (view.view) {
      const Eigen::Vector3d along = at - view.view->centre().xyz;
      // Horizontal plane: with slopes, relief displacement between pairs would constrain the absolute
      // position, but errors of the DEM's slopes make that unreliable.
      const GroundPlane ground{at, Eigen::Vector2d::Zero()};
      const Ray<GridFrame> line{view.view->centre(), {along.normalized()}};
      tie.per_pose = pose_jacobian(view, line, ground).topRows<2>();
      on_slope = pose_jacobian(view, line, {at, tie.gradient}).topRows<2>();
    }
    const double min_sd = std::max(0.01, body ? 0.03 * body->metres : 0);
    const Eigen::Matrix2d given = o.covariance.topLeftCorner<2, 2>();
    // The same pose contribution as in position_covariance; the horizontal one leaves too much where poses
    // are uncertain.
    const Eigen::Matrix2d pose = propagate(on_slope, stated_[static_cast<std::size_t>(image)]);
    tie.own = given.allFinite() ? clamp_eigenvalues(given - pose, min_sd) : Eigen::Matrix2d::Identity();
    tie.object.at = o.position.xyz.head<2>();
    tie.object.type = o.type;
    tie.object.source = static_cast<Index>(image);
    if (body) tie.object.log_size = std::log(body->metres), tie.object.log_size_variance = body->log_variance;
    tie_points_.push_back(tie);
  }

  Eigen::Vector2d corrected_position(const TiePoint& tie) const {
    return plane_.translate(tie.object.at, shift(tie));
  }

  // Returns pairs without another candidate in either image.
  std::vector<IndexPair> unambiguous_pairs() const {
    const Eigen::MatrixXd cross = mean_cross_covariance();
    const Eigen::Matrix2d mean = common();
    std::vector<ObservedObject> seen;
    for (const TiePoint& tie : tie_points_) {
      seen.push_back(tie.object);
      seen.back().at = corrected_position(tie);
      seen.back().covariance = tie.own + clamp_eigenvalues(relative_covariance(tie, cross, mean), 0);
    }
    AssociationRules association = rules_.association;
    association.overlap = 0;
    std::vector<IndexPair> pairs = candidate_pairs(seen, plane_, association);
    std::map<std::pair<Index, Index>, int> candidates;  // of a tie in an image
    for (const IndexPair& p : pairs)
      ++candidates[{p.first, seen[p.second].source}], ++candidates[{p.second, seen[p.first].source}];
    std::erase_if(pairs, [&](const IndexPair& p) {
      return candidates[{p.first, seen[p.second].source}] > 1 ||
             candidates[{p.second, seen[p.first].source}] > 1;
    });
    return pairs;
  }

  void iterate(const std::vector<IndexPair>& pairs) {
    for (int k = 0; k < rules_.solutions; ++k) solve(pairs);
    posterior_ =
        Cholesky(normal_).solve(Eigen::MatrixXd(Eigen::MatrixXd::Identity(normal_.rows(), normal_.cols())));
  }

  void solve(const std::vector<IndexPair>& pairs) {
    std::vector<int> degree(tie_points_.size(), 0);
    std::vector<double> pairs_of_image(images_.size(), 0);
    for (const IndexPair& p : pairs) {
      ++degree[p.first], ++degree[p.second];
      ++pairs_of_image[static_cast<std::size_t>(tie_points_[p.first].image)];
      ++pairs_of_image[static_cast<std::size_t>(tie_points_[p.second].image)];
    }
    normal_ = Eigen::MatrixXd::Zero(prior_.rows(), prior_.cols());
    Eigen::VectorXd right = Eigen::VectorXd::Zero(prior_.rows());
    for (std::size_t image = 0; image < images_.size(); ++image) {
      const auto i = static_cast<Eigen::Index>(6 * image);
      normal_.block<6, 6>(i, i) = inverse_by_lu(prior_.block<6, 6>(i, i));
      if (const auto& tie = images_[image].dem_constraint) {
        normal_.block<6, 6>(i, i) += tie->information / sharing_[image];
        right.segment<6>(i) += tie->information_vector / sharing_[image];
      }
    }
    for (const IndexPair& p : pairs) {
      const TiePoint &a = tie_points_[p.first], &b = tie_points_[p.second];
      const Eigen::Vector2d apart = plane_.offset(b.object.at, a.object.at);  // a - b before alignment
      const Eigen::Vector2d left = apart + shift(a) - shift(b);
      const Eigen::Matrix2d information = (a.own + b.own).inverse();
      const double cauchy = 1 / (1 + left.dot(information * left) / 4);
      // A landmark with n observations has n (n - 1) / 2 pairs but n - 1 independent ones.
      const double crowd = std::max(pairs_of_image[static_cast<std::size_t>(a.image)],
                                    pairs_of_image[static_cast<std::size_t>(b.image)]);
      const double weight = cauchy * 2 / (1 + std::max(degree[p.first], degree[p.second])) *
                            std::min(1.0, rules_.independent_pairs / crowd);
      const Eigen::Index i = 6 * a.image, j = 6 * b.image;
      const Eigen::Matrix<double, 6, 2> wa = weight * a.per_pose.transpose() * information;
      const Eigen::Matrix<double, 6, 2> wb = weight * b.per_pose.transpose() * information;
      normal_.block<6, 6>(i, i) += wa * a.per_pose;
      normal_.block<6, 6>(j, j) += wb * b.per_pose;
      normal_.block<6, 6>(i, j) -= wa * b.per_pose;
      normal_.block<6, 6>(j, i) -= wb * a.per_pose;
      right.segment<6>(i) -= wa * apart;
      right.segment<6>(j) += wb * apart;
    }
    correction_ = Cholesky(normal_).solve(right);
  }

  std::span<const ImageView> images_;
  MapPlane plane_;
  double metres_per_unit_;
  const AlignmentRules& rules_;
  std::vector<TiePoint> tie_points_;
  std::vector<Matrix6> stated_;  // covariances that those of the observations contain
  std::vector<double> sharing_;  // number of images that share the DEM constraint
  Eigen::VectorXd correction_;
  Eigen::MatrixXd prior_, posterior_, normal_;
  Eigen::MatrixXd mean_jacobian_;  // 2 x 6 n: mean shift of the ties of all images per correction
  int pairs_ = 0;
};

// Replaces the horizontal part of a covariance. Height keeps its regression on position and its own residual
// variance.
void replace_horizontal_part(Eigen::Matrix3d& covariance, const Eigen::Matrix2d& level) {
  const Eigen::Matrix2d before =
      clamp_eigenvalues(covariance.topLeftCorner<2, 2>(), 1e-6) + 1e-12 * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d rise = before.inverse() * covariance.block<2, 1>(0, 2);
  const double alone = std::max(covariance(2, 2) - rise.dot(before * rise), 0.0);
  covariance.topLeftCorner<2, 2>() = level;
  covariance.block<2, 1>(0, 2) = level * rise;
  covariance.block<1, 2>(2, 0) = (level * rise).transpose();
  covariance(2, 2) = std::isfinite(covariance(2, 2)) ? alone + rise.dot(level * rise) : covariance(2, 2);
}

void correct(ImageView& image, const Eigen::Vector<double, 6>& by, const Matrix6& covariance) {
  if (!image.view) return;
  auto& pose = image.view->grid_from_camera.transform;
  const Eigen::Vector3d turn = by.head<3>();
  if (turn.norm() > 0) pose.linear() = pose.linear() * Eigen::AngleAxisd(turn.norm(), turn.normalized());
  pose.translation() += by.tail<3>();
  image.view->covariance = covariance;
}

}  // namespace

Alignment align_images(std::vector<Observation> observations, std::vector<ImageView> images,
                       const Terrain& terrain, const TypeRegistry& types, const Crs& crs,
                       const AlignmentRules& rules) {
  Alignment aligned{std::move(observations), std::move(images), {}, 0, false};
  aligned.shifts.assign(aligned.images.size(), 0);
  const bool added = rules.added_position_sd > 0 || rules.added_rotation_sd > 0;
  const bool movable = std::any_of(aligned.images.begin(), aligned.images.end(), [&](const ImageView& image) {
    return image.view && (added || image.view->covariance.trace() > 0);
  });
  aligned.too_many = static_cast<int>(aligned.images.size()) > rules.max_images;
  if (!movable || aligned.too_many) return aligned;
  const MapPlane plane(crs);
  BundleAdjustment bundle(aligned.observations, aligned.images, terrain, types, crs, rules);
  bundle.solve();
  aligned.pairs = bundle.pairs();
  const Eigen::Matrix2d common = clamp_eigenvalues(bundle.common(), 0);
  const Eigen::MatrixXd cross = bundle.mean_cross_covariance();
  std::vector<Eigen::Vector2d> mean(aligned.images.size(), Eigen::Vector2d::Zero());
  std::vector<int> count(aligned.images.size(), 0);
  for (const TiePoint& tie : bundle.tie_points()) {
    Observation& o = aligned.observations[tie.observation];
    const Eigen::Vector2d shift = bundle.shift(tie);
    mean[static_cast<std::size_t>(tie.image)] += shift, ++count[static_cast<std::size_t>(tie.image)];
    o.position.xyz.head<2>() = plane.translate(o.position.xyz.head<2>(), shift);
    o.position.xyz.z() += tie.gradient.dot(shift);
    replace_horizontal_part(o.covariance,
                            tie.own + clamp_eigenvalues(bundle.relative_covariance(tie, cross, common), 0));
  }
  for (std::size_t i = 0; i < aligned.images.size(); ++i) {
    if (count[i]) aligned.shifts[i] = (mean[i] / count[i]).norm();
    correct(aligned.images[i], bundle.correction(static_cast<int>(i)),
            bundle.covariance(static_cast<int>(i)));
    aligned.images[i].common_covariance = common;
  }
  return aligned;
}

}  // namespace waymark::pipeline
