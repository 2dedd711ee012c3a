// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/common_geometry_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "core/median.hpp"
#include "pipeline/fusion/projection/viewing_ray.hpp"

namespace waymark::pipeline {
namespace {

using Kind = CommonGeometryError::Kind;

// Gates three ground sample distances wider find as much again with a third more focal length: steps are as
// fine as narrow gates need.
constexpr std::array<double, 3> kSteps{0.01, 0.0025, 0.00125};  // of the logarithm
// Added to the gates of each grid, ground sample distances.
constexpr std::array<double, 3> kBlur{1, 0.25, 0};

ImageView corrected(ImageView image, Kind kind, double amount) {
  if (!image.view) return image;
  Camera& camera = image.view->camera;
  Eigen::Isometry3d& pose = image.view->grid_from_camera.transform;
  switch (kind) {
    case Kind::focal_length:
      camera.fx /= amount, camera.fy /= amount, camera.skew /= amount;
      image.gsd *= amount;
      break;
    case Kind::ground_height:
      // Raised cameras see the same ground as over a lowered DEM.
      pose.translation().z() += amount;
      break;
    case Kind::transposed_rotations:
      pose.linear().transposeInPlace();
      break;
  }
  return image;
}

std::optional<Eigen::Vector3d> ground_of(const ImageView& image, const Eigen::Vector2d& pixel,
                                         const Terrain& terrain) {
  const auto line = viewing_ray(image, pixel);
  if (!line) return std::nullopt;
  const RayHit hit = terrain.cast(*line);
  if (hit.end != RayEnd::ground) return std::nullopt;
  return hit.point.xyz;
}

/// What the search knows of the images as they are given.
struct ImageScale {
  double distance = 0;  // median from camera to ground, metres
  double blur = 0;      // standard deviation of positions by the stated poses, ground sample distances
};

ImageScale image_scale(const std::vector<ImageView>& images) {
  std::vector<double> distances, blurs;
  for (const ImageView& image : images) {
    if (!image.view || !(image.gsd > 0)) continue;
    const auto& covariance = image.view->covariance;
    const double distance = image.gsd * image.view->camera.fx;
    const double turned = distance * distance * covariance.diagonal().head<3>().sum() / 3;
    const double moved = covariance.diagonal().tail<3>().sum() / 3;
    distances.push_back(distance);
    blurs.push_back(std::sqrt(turned + moved) / image.gsd);
  }
  return {median(std::move(distances)), median(std::move(blurs))};
}

class Search {
 public:
  Search(const std::vector<Observation>& observations, const std::vector<ImageView>& images,
         const Terrain& terrain, const TypeRegistry& types, const Crs& crs, const CommonErrorRules& rules)
      : observations_(observations),
        images_(images),
        terrain_(terrain),
        types_(types),
        crs_(crs),
        rules_(rules),
        scale_(image_scale(images)) {}

  bool possible() const { return scale_.distance > 0; }

  // Best value of ln(focal length given / right), or ln(right distance / distance given).
  CommonGeometryError best_of(Kind kind) const {
    double centre = 0;
    int reach = static_cast<int>(std::ceil(rules_.max_log_factor / kSteps.front()));
    for (std::size_t level = 0; level < kSteps.size(); ++level) {
      std::pair<double, double> best{-1, centre};  // found again, logarithm
      for (int k = -reach; k <= reach; ++k) {
        const double logarithm = centre + k * kSteps[level];
        const double found = found_again(kind, amount(kind, logarithm), kBlur[level]);
        // Of equal ones the smaller correction.
        if (found > best.first || (found == best.first && std::abs(logarithm) < std::abs(best.second)))
          best = {found, logarithm};
      }
      centre = best.second;
      reach = 5;
    }
    return aligned(kind, amount(kind, centre));
  }

  CommonGeometryError aligned(Kind kind, double amount) const {
    const CorrectedGeometry made = correct_geometry(observations_, images_, terrain_, crs_, kind, amount);
    const Alignment alignment =
        align_images(made.observations, made.images, terrain_, types_, crs_, rules_.alignment);
    return {kind, amount,
            measure_repetition(alignment.observations, alignment.images, types_, crs_, rules_.repetition)};
  }

 private:
  double amount(Kind kind, double logarithm) const {
    return kind == Kind::focal_length ? std::exp(logarithm) : scale_.distance * std::expm1(logarithm);
  }

  double found_again(Kind kind, double amount, double blur) const {
    RepetitionRules coarse = rules_.repetition;
    coarse.sd_of_gsd = std::hypot(coarse.sd_of_gsd, scale_.blur, blur);
    coarse.max_objects = rules_.searched_objects;
    const CorrectedGeometry made = correct_geometry(observations_, images_, terrain_, crs_, kind, amount);
    return measure_repetition(made.observations, made.images, types_, crs_, coarse).found();
  }

  const std::vector<Observation>& observations_;
  const std::vector<ImageView>& images_;
  const Terrain& terrain_;
  const TypeRegistry& types_;
  const Crs& crs_;
  const CommonErrorRules& rules_;
  ImageScale scale_;
};

}  // namespace

CorrectedGeometry correct_geometry(const std::vector<Observation>& observations,
                                   const std::vector<ImageView>& images, const Terrain& terrain,
                                   const Crs& crs, Kind kind, double amount) {
  CorrectedGeometry made;
  std::map<std::string_view, std::size_t> number;
  for (std::size_t i = 0; i < images.size(); ++i) {
    number.emplace(images[i].name, i);
    made.images.push_back(corrected(images[i], kind, amount));
  }
  const double metres_per_unit = crs.metres_per_unit();
  for (const Observation& o : observations) {
    const auto image = number.find(o.source);
    if (!o.rejected.empty() || !o.pixel || image == number.end()) continue;
    const auto given = ground_of(images[image->second], *o.pixel, terrain);
    const auto right = ground_of(made.images[image->second], *o.pixel, terrain);
    if (!given || !right) continue;
    // The difference: bowls do not lie where their line of sight meets the ground.
    const Eigen::Vector3d shift = *right - *given;
    Observation moved = o;
    moved.position.xyz +=
        Eigen::Vector3d(shift.x() / metres_per_unit, shift.y() / metres_per_unit, shift.z());
    made.observations.push_back(std::move(moved));
  }
  return made;
}

std::vector<CommonGeometryError> find_common_errors(const std::vector<Observation>& observations,
                                                    const std::vector<ImageView>& images,
                                                    const Terrain& terrain, const TypeRegistry& types,
                                                    const Crs& crs, const CommonErrorRules& rules) {
  const Search search(observations, images, terrain, types, crs, rules);
  std::vector<CommonGeometryError> made;
  if (!search.possible()) return made;
  made.push_back(search.best_of(Kind::focal_length));
  made.push_back(search.best_of(Kind::ground_height));
  made.push_back(search.aligned(Kind::transposed_rotations, 0));
  std::ranges::stable_sort(made,
                           [](const auto& a, const auto& b) { return a.found.found() > b.found.found(); });
  return made;
}

}  // namespace waymark::pipeline
