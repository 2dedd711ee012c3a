// SPDX-License-Identifier: Apache-2.0
#include "localization/global/constellation.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <numeric>
#include <stdexcept>

#include "core/covariance.hpp"

namespace waymark::localization {
namespace {

constexpr std::size_t kSample = 400;  // landmarks to estimate how rare a feature is

// Returns the existence from which landmarks are searched. A doubtful one in the index takes the place of a
// true neighbour in triangles, and counts as one that may match by chance. Those that rather do not exist are
// left out, unless half of the landmarks that exist are expected among them.
double min_existence(const std::vector<MapLandmark>& landmarks, const IdentificationOptions& options) {
  double all = 0, likely = 0;
  for (const MapLandmark& l : landmarks) {
    const double exists = existence_prior(l, options);
    all += exists;
    if (exists >= kLikelyExistence) likely += exists;
  }
  return likely > all / 2 ? kLikelyExistence : 0;
}

std::vector<LandmarkPosition> planar_positions(const std::vector<MapLandmark>& landmarks) {
  std::vector<LandmarkPosition> positions;
  positions.reserve(landmarks.size());
  for (const MapLandmark& l : landmarks)
    positions.push_back({{l.at.x(), l.at.y(), 0}, Eigen::Vector3d::UnitZ()});
  return positions;
}

}  // namespace

void ConstellationOptions::describe(OptionVisitor& option) {
  option("neighbours", neighbours,
         {.help = "Nearest landmarks that make triangles with each one", .min = 2, .max = 30});
  option("constellation_sigmas", sigmas,
         {.help = "Standard deviations by which lengths and positions may differ", .min = 1, .max = 10});
  option("false_alarms", false_alarms,
         {.help = "Largest expected number of chance poses of the whole map for an accepted fix",
          .min = 1e-12,
          .max = 1});
  option("lead", lead,
         {.help = "Factor by which the best pose must be less probable by chance than the next", .min = 1});
  option("min_matches", min_matches,
         {.help = "Smallest number of matched sightings of a fix",
          .min = 3,
          .max = 100,
          .formerly = "least_matches"});
  option("max_tried", max_tried,
         {.help = "Largest number of poses to fit", .min = 1, .max = 1e5, .formerly = "most_tried"});
}

PoseEstimate ConstellationFix::pose() const {
  const Eigen::Vector3d at = plane.point(plane_pose.pose.at());
  return {{at.x(), at.y(), plane_pose.pose.yaw}, plane_pose.covariance};
}

ConstellationIndex::ConstellationIndex(std::vector<MapLandmark> landmarks, FeatureScales scales,
                                       ConstellationOptions options)
    : landmarks_(std::move(landmarks)), scales_(std::move(scales)), options_(options) {
  std::erase_if(landmarks_,
                [](const MapLandmark& l) { return l.is_line(); });  // a constellation is of points
  const double existence = min_existence(landmarks_, options_.identification);
  std::erase_if(landmarks_, [&](const MapLandmark& l) {
    return !l.at.allFinite() || existence_prior(l, options_.identification) < existence;
  });
  positions_ = planar_positions(landmarks_);
  build();
}

ConstellationIndex::ConstellationIndex(std::vector<MapLandmark> landmarks,
                                       std::vector<LandmarkPosition> positions, FeatureScales scales,
                                       ConstellationOptions options)
    : landmarks_(std::move(landmarks)),
      positions_(std::move(positions)),
      scales_(std::move(scales)),
      options_(options) {
  if (positions_.size() != landmarks_.size()) throw std::invalid_argument("each landmark needs one position");
  for (const LandmarkPosition& p : positions_)
    if (!p.at.allFinite() || !(std::abs(p.up.norm() - 1) < 1e-6))
      throw std::invalid_argument("a landmark's position must be finite and its up a unit vector");
  build();
}

std::uint64_t ConstellationIndex::key(std::array<TypeId, 3> types, double longest, double middle,
                                      bool left) const {
  std::uint64_t k = left;
  for (const TypeId type : types) k = mix_bits(k ^ type);
  k = mix_bits(k ^ static_cast<std::uint64_t>(longest));
  return mix_bits(k ^ static_cast<std::uint64_t>(middle));
}

bool ConstellationIndex::turns_left(const Corners& c) const {
  const auto at = [&](std::size_t i) -> const Eigen::Vector3d& { return positions_[c[i]].at; };
  return (at(1) - at(0)).cross(at(2) - at(0)).dot(positions_[c[0]].up) > 0;
}

std::optional<ConstellationIndex::Corners> ConstellationIndex::order_corners(Corners c) const {
  std::array<double, 3> opposite;
  for (std::size_t i = 0; i < 3; ++i)
    opposite[i] = (positions_[c[(i + 1) % 3]].at - positions_[c[(i + 2) % 3]].at).squaredNorm();
  std::array<std::size_t, 3> order{0, 1, 2};
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) { return opposite[a] > opposite[b]; });
  const Eigen::Vector3d &a = positions_[c[0]].at, &b = positions_[c[1]].at, &d = positions_[c[2]].at;
  const double longest = std::sqrt(opposite[order[0]]);
  if (!((b - a).cross(d - a).norm() > 0.02 * longest * longest)) return {};
  return Corners{c[order[0]], c[order[1]], c[order[2]]};
}

std::vector<ConstellationIndex::Corners> ConstellationIndex::neighbour_triangles() const {
  const auto wanted = static_cast<std::size_t>(options_.neighbours);
  std::vector<Corners> all;
  std::vector<std::pair<double, std::uint32_t>> found;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    // Grows discs until they hold enough landmarks, or the whole map.
    for (double radius = 1.5 * cells_.cell();; radius *= 1.6) {
      found.clear();
      cells_.near(positions_[i].at, radius, [&](std::uint32_t j, double d) {
        if (j != i && d > 0) found.emplace_back(d, j);
      });
      if (found.size() >= wanted || found.size() + 1 >= positions_.size() || radius > 64 * cells_.cell())
        break;
    }
    const std::size_t count = std::min(wanted, found.size());
    std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count), found.end());
    for (std::size_t a = 0; a < count; ++a)
      for (std::size_t b = a + 1; b < count; ++b) {
        Corners c{static_cast<std::uint32_t>(i), found[a].second, found[b].second};
        std::ranges::sort(c);
        all.push_back(c);
      }
  }
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

void ConstellationIndex::build() {
  if (landmarks_.empty()) return;
  std::vector<Eigen::Vector3d> points;
  points.reserve(positions_.size());
  for (const LandmarkPosition& p : positions_) points.push_back(p.at);
  cells_ = PointCells(points);
  area_ = static_cast<double>(cells_.occupied()) * cells_.cell() * cells_.cell();
  std::vector<double> sds;
  for (std::uint32_t i = 0; i < landmarks_.size(); ++i) {
    types_.push_back(landmarks_[i].type);
    sds.push_back(largest_sd(landmarks_[i].covariance));
    by_key_.emplace(landmarks_[i].key, i);
  }
  std::ranges::sort(types_);
  types_.erase(std::unique(types_.begin(), types_.end()), types_.end());
  std::ranges::nth_element(sds, sds.begin() + static_cast<std::ptrdiff_t>(sds.size() * 9 / 10));
  typical_sd_ = sds[sds.size() * 9 / 10];
  for (std::size_t k = 0; k < std::min(kSample, landmarks_.size()); ++k)
    sample_.push_back(
        static_cast<std::uint32_t>(k * landmarks_.size() / std::min(kSample, landmarks_.size())));

  std::vector<Corners> triangles = neighbour_triangles();
  std::vector<double> lengths;
  std::size_t kept = 0;
  for (const Corners& c : triangles)
    if (const auto in_order = order_corners(c)) {
      triangles[kept++] = *in_order;
      lengths.push_back((positions_[(*in_order)[1]].at - positions_[(*in_order)[2]].at).norm());
    }
  triangles.resize(kept);
  if (triangles.empty()) return;
  std::ranges::nth_element(lengths, lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2));
  length_cell_ = std::max(0.05 * lengths[lengths.size() / 2], 1e-9);

  first_.assign(std::bit_ceil(triangles.size()) + 1, 0);
  std::vector<std::uint32_t> buckets(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Corners& c = triangles[i];
    const double longest = (positions_[c[1]].at - positions_[c[2]].at).norm();
    const double middle = (positions_[c[0]].at - positions_[c[2]].at).norm();
    const std::array<TypeId, 3> types{landmarks_[c[0]].type, landmarks_[c[1]].type, landmarks_[c[2]].type};
    buckets[i] = static_cast<std::uint32_t>(bucket(
        key(types, std::floor(longest / length_cell_), std::floor(middle / length_cell_), turns_left(c))));
    ++first_[buckets[i] + 1];
  }
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  corners_.resize(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) corners_[next[buckets[i]]++] = triangles[i];
}

std::size_t ConstellationIndex::bytes() const {
  return corners_.size() * sizeof(Corners) + first_.size() * sizeof(std::uint32_t) + cells_.bytes() +
         landmarks_.size() * (sizeof(MapLandmark) + sizeof(LandmarkPosition) + 32);
}

}  // namespace waymark::localization
