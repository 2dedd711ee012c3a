// SPDX-License-Identifier: Apache-2.0
#include "localization/craters/crater_index.hpp"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <stdexcept>

#include "localization/craters/crater_search.hpp"

namespace waymark::localization {
namespace {

constexpr double kAsLarge = 0.8;      // radius of a neighbour over that of the crater, at least
constexpr double kLevelStep = 1.6;    // between the smallest radii of levels
constexpr double kMaxTriangle = 0.5;  // longest side, over the body's radius
constexpr double kMinHeight = 0.05;   // of a triangle, over its longest side
constexpr double kDensityStep = 0.25;
constexpr std::size_t kMinMembers = 30;  // craters of a level

}  // namespace

void CraterSearchOptions::describe(OptionVisitor& option) {
  option("neighbours", neighbours,
         {.help = "Nearest craters that make triangles with each one", .min = 3, .max = 15});
  option("position_sd", position_sd,
         {.help = "Error of the position of a detected crater, pixels", .min = 0.01, .max = 100});
  option("position_error", position_error,
         {.help = "Error of the position of a detected crater, as a fraction of its radius",
          .min = 0,
          .max = 1});
  option("radius_error", radius_error,
         {.help = "Relative error of a detected radius against the map's", .min = 0.01, .max = 1});
  option("mapped", mapped,
         {.help = "Fraction of the detections that the map is expected to have", .min = 0.05, .max = 0.99});
  option("tilt_sd", tilt_sd,
         {.help = "Degrees by which the camera may be off the vertical; needs the focal length",
          .min = 0.001,
          .max = 20});
  option("sigmas", sigmas,
         {.help = "Standard deviations by which sides and positions may differ", .min = 1, .max = 10});
  option("max_wrong", max_wrong,
         {.help = "Largest probability of a wrong position that is accepted", .min = 1e-12, .max = 1});
  option("min_matches", min_matches,
         {.help = "Smallest number of matched craters of a position", .min = 4, .max = 1000});
  option("max_tried", max_tried, {.help = "Largest number of positions to adjust", .min = 1, .max = 1e5});
  option("max_detections", max_detections,
         {.help = "Detections that are used, the largest", .min = 5, .max = 2000});
}

CraterIndex::CraterIndex(std::vector<BodyCrater> craters, const Body& body, CraterSearchOptions options)
    : surface_(body), craters_(std::move(craters)), options_(options) {
  points_.reserve(craters_.size());
  for (const BodyCrater& c : craters_) {
    if (!c.at.allFinite() || !(c.radius > 0) || !(c.sd >= 0))
      throw std::invalid_argument("a crater needs a position and a radius");
    points_.push_back(surface_.nearest(c.at));
  }
  if (craters_.empty()) return;
  make_levels();
  make_triangles();
}

void CraterIndex::make_levels() {
  std::vector<double> logs;
  for (const BodyCrater& c : craters_) logs.push_back(std::log(c.radius));
  const auto [low, high] = std::ranges::minmax(logs);
  min_log_radius_ = low;
  density_.assign(static_cast<std::size_t>((high - low) / kDensityStep) + 1, 0.5);
  for (const double l : logs) ++density_[static_cast<std::size_t>((l - low) / kDensityStep)];
  for (double& d : density_) d /= surface_.area() * kDensityStep;
  for (double radius = std::exp(low);; radius *= kLevelStep) {
    Level l{.min_radius = radius, .members = {}, .cells = {}};
    std::vector<Eigen::Vector3d> at;
    for (std::uint32_t i = 0; i < craters_.size(); ++i)
      if (levels_.empty() || craters_[i].radius >= radius) l.members.push_back(i), at.push_back(points_[i]);
    if (!levels_.empty() && at.size() < kMinMembers) break;
    l.cells = PointCells(at);
    levels_.push_back(std::move(l));
  }
}

const CraterIndex::Level& CraterIndex::level(double radius) const {
  std::size_t k = 0;
  while (k + 1 < levels_.size() && levels_[k + 1].min_radius <= radius) ++k;
  return levels_[k];
}

double CraterIndex::density(double log_radius) const {
  const double k = (log_radius - min_log_radius_) / kDensityStep;
  if (!(k >= 0 && k < static_cast<double>(density_.size()))) return 0.5 / (surface_.area() * kDensityStep);
  return density_[static_cast<std::size_t>(k)];
}

void CraterIndex::neighbour_triangles(std::uint32_t i, std::vector<Corners>& into) const {
  const auto wanted = static_cast<std::size_t>(options_.neighbours);
  const double min_radius = kAsLarge * craters_[i].radius;
  const double far = kMaxTriangle * surface_.radius();
  std::vector<std::pair<double, std::uint32_t>> found;
  for (double reach = std::min(far, 1.5 * level(min_radius).cells.cell());;
       reach = std::min(far, 1.6 * reach)) {
    found.clear();
    near(points_[i], reach, min_radius, [&](std::uint32_t j, double d) {
      if (j != i && d > 0 && craters_[j].radius >= min_radius) found.emplace_back(d, j);
    });
    if (found.size() >= wanted || !(reach < far)) break;
  }
  const std::size_t count = std::min(wanted, found.size());
  std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count), found.end());
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = a + 1; b < count; ++b)
      if (const auto c = order_corners({i, found[a].second, found[b].second})) into.push_back(*c);
}

std::optional<CraterIndex::Corners> CraterIndex::order_corners(Corners c) const {
  std::array<double, 3> opposite;
  for (std::size_t i = 0; i < 3; ++i)
    opposite[i] = (points_[c[(i + 1) % 3]] - points_[c[(i + 2) % 3]]).squaredNorm();
  std::array<std::size_t, 3> order{0, 1, 2};
  std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
    return opposite[a] != opposite[b] ? opposite[a] > opposite[b] : c[a] < c[b];
  });
  const Eigen::Vector3d ab = points_[c[1]] - points_[c[0]], ac = points_[c[2]] - points_[c[0]];
  const double square = opposite[order[0]];
  if (!(ab.cross(ac).norm() > kMinHeight * square) || square > std::pow(kMaxTriangle * surface_.radius(), 2))
    return {};
  return Corners{c[order[0]], c[order[1]], c[order[2]]};
}

bool CraterIndex::turns_left(const Corners& c) const {
  const Eigen::Vector3d ab = points_[c[1]] - points_[c[0]], ac = points_[c[2]] - points_[c[0]];
  return ab.cross(ac).dot(points_[c[0]]) > 0;
}

std::size_t CraterIndex::cell_of(const Corners& c) const {
  const auto side = [&](std::size_t i) { return (points_[c[(i + 1) % 3]] - points_[c[(i + 2) % 3]]).norm(); };
  const double longest = side(0);
  std::array<int, 3> size;
  for (std::size_t i = 0; i < 3; ++i)
    size[i] = crater_cells::size_cell(std::log(craters_[c[i]].radius / longest));
  return crater_cells::cell(turns_left(c), crater_cells::middle_cell(side(1) / longest),
                            crater_cells::short_cell(side(2) / longest), size);
}

void CraterIndex::make_triangles() {
  constexpr std::size_t kBlock = 4096;
  const std::size_t blocks = (craters_.size() + kBlock - 1) / kBlock;
  std::vector<std::vector<Corners>> some(blocks);
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
    const std::size_t end = std::min(craters_.size(), (b + 1) * kBlock);
    for (std::size_t i = b * kBlock; i < end; ++i)
      neighbour_triangles(static_cast<std::uint32_t>(i), some[b]);
  });
  std::vector<Corners> all;
  for (auto& block : some) {
    all.insert(all.end(), block.begin(), block.end());
    block = {};
  }
  tbb::parallel_sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  std::vector<std::uint32_t> cell(all.size());
  tbb::parallel_for(std::size_t{0}, all.size(),
                    [&](std::size_t i) { cell[i] = static_cast<std::uint32_t>(cell_of(all[i])); });
  first_.assign(crater_cells::kCells + 1, 0);
  for (const std::uint32_t c : cell) ++first_[c + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  corners_.resize(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) corners_[next[cell[i]]++] = all[i];
}

CraterAnswer CraterIndex::find(const CraterImage& image) const {
  return find(image, options_);
}

CraterAnswer CraterIndex::find(const CraterImage& image, const CraterSearchOptions& options) const {
  return CraterSearch(*this, image, options).find();
}

std::size_t CraterIndex::bytes() const {
  std::size_t sum = corners_.size() * sizeof(Corners) + first_.size() * sizeof(std::uint32_t) +
                    craters_.size() * (sizeof(BodyCrater) + sizeof(Eigen::Vector3d));
  for (const Level& l : levels_) sum += l.cells.bytes() + l.members.size() * sizeof(std::uint32_t);
  return sum;
}

}  // namespace waymark::localization
