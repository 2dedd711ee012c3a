// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_facades.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing.h>
#include <CGAL/Shape_detection/Region_growing/Region_growing_on_point_set.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "localization/detectors/cloud_cells.hpp"

namespace waymark::localization {
namespace {

constexpr double kFacadeCell = 0.25;                  // m
constexpr double kFacadeFoot = 0.4, kFacadeTop = 12;  // m above the ground
constexpr int kFlatColumns = 2;                       // of cells about one, by which its surface is judged
constexpr double kFlatRise = 0.75;                    // m: rows of a scanner of 32 rows at 30 m
constexpr double kFlatThickness = 0.06;               // m
constexpr double kFlatWidth = 0.15;                   // m: poles are narrower
constexpr double kPlaneDistance = 0.1, kPlaneAngle = 20;  // m, degrees: of a cell in a growing plane
constexpr std::size_t kPlaneCells = 12;
constexpr double kJoinGap = 1, kJoinOffset = 0.1, kJoinAngle = 0.07;  // m, m, rad: pieces of one facade
constexpr double kBehind = 0.4;                                       // m, of points seen through a facade
constexpr double kFilledCell = 0.5;                                   // m
constexpr double kFacadeSd = 0.02, kFacadeAngleSd = 0.004;  // m, rad: of walls that are not perfectly flat

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using FlatCell = std::pair<Kernel::Point_3, Kernel::Vector_3>;
using FlatCells = std::vector<FlatCell>;
using PlaneRegion = CGAL::Shape_detection::Point_set::Least_squares_plane_fit_region<
    Kernel, FlatCells, CGAL::First_of_pair_property_map<FlatCell>,
    CGAL::Second_of_pair_property_map<FlatCell>>;

/// Neighbours of flat cells, the concept NeighborQuery of CGAL.
class FlatNeighbours {
 public:
  explicit FlatNeighbours(std::vector<std::vector<std::size_t>> of) : of_(std::move(of)) {}
  void operator()(std::size_t cell, std::vector<std::size_t>& neighbours) const { neighbours = of_[cell]; }

 private:
  std::vector<std::vector<std::size_t>> of_;
};

/// Scatter of points in the plane.
struct Scatter {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;

  void add(double px, double py) { ++n, x += px, y += py, xx += px * px, xy += px * py, yy += py * py; }
  Eigen::Vector2d mean() const { return {x / n, y / n}; }
  /// Returns the direction of the larger spread, and the variances along and across it.
  std::tuple<double, double, double> axes() const {
    const double a = xx / n - x * x / (n * n), b = xy / n - x * y / (n * n), c = yy / n - y * y / (n * n);
    const double half = std::hypot((a - c) / 2, b), middle = (a + c) / 2;
    return {std::atan2(2 * b, a - c) / 2, middle + half, std::max(0.0, middle - half)};
  }
};

/// Normals of the cells whose surroundings are upright and flat.
std::vector<std::optional<Eigen::Vector2d>> upright_normals(const CloudCells& cells,
                                                            std::vector<double>& thickness) {
  std::vector<std::optional<Eigen::Vector2d>> normals(cells.size());
  thickness.assign(cells.size(), 0);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    Scatter scatter;
    float low = cells[i].at.z(), high = low;
    const Eigen::Vector3f& at = cells[i].at;
    cells.near(i, kFlatColumns, kFlatRise, [&](std::size_t j) {
      const Eigen::Vector3f& p = cells[j].at;
      scatter.add(static_cast<double>(p.x() - at.x()), static_cast<double>(p.y() - at.y()));
      low = std::min(low, p.z()), high = std::max(high, p.z());
    });
    if (!(scatter.n >= 4 && high - low > 0.3F)) continue;
    const auto [angle, along, across] = scatter.axes();
    thickness[i] = std::sqrt(across);
    if (thickness[i] <= kFlatThickness && std::sqrt(along) >= kFlatWidth)
      normals[i] = Eigen::Vector2d(-std::sin(angle), std::cos(angle));
  }
  return normals;
}

/// Planes of flat cells as lists of cells.
std::vector<std::vector<std::size_t>> grow_planes(const CloudCells& cells) {
  std::vector<double> thickness;
  const auto normals = upright_normals(cells, thickness);
  std::vector<std::size_t> flat;  // the flattest first: they are the seeds
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (normals[i]) flat.push_back(i);
  if (flat.empty()) return {};
  std::ranges::sort(flat, {}, [&](std::size_t i) { return std::pair(thickness[i], i); });
  std::vector<std::size_t> place(cells.size(), flat.size());
  for (std::size_t k = 0; k < flat.size(); ++k) place[flat[k]] = k;
  FlatCells items;
  std::vector<std::vector<std::size_t>> neighbours(flat.size());
  for (std::size_t k = 0; k < flat.size(); ++k) {
    const Eigen::Vector3d at = cells[flat[k]].at.cast<double>();
    items.emplace_back(Kernel::Point_3(at.x(), at.y(), at.z()),
                       Kernel::Vector_3(normals[flat[k]]->x(), normals[flat[k]]->y(), 0));
    cells.near(flat[k], kFlatColumns, kFlatRise, [&](std::size_t j) {
      if (place[j] < flat.size() && j != flat[k]) neighbours[k].push_back(place[j]);
    });
  }
  FlatNeighbours query(std::move(neighbours));
  PlaneRegion region(items, kPlaneDistance, kPlaneAngle, kPlaneCells);
  CGAL::Shape_detection::Region_growing<FlatCells, FlatNeighbours, PlaneRegion> growing(items, query, region);
  std::vector<std::vector<std::size_t>> planes;
  growing.detect(std::back_inserter(planes));
  for (auto& plane : planes) {
    for (std::size_t& k : plane) k = flat[k];
    std::ranges::sort(plane);
  }
  std::ranges::sort(planes);
  return planes;
}

/// A vertical plane with its cells.
struct Plane {
  CloudFacade line;
  std::vector<std::size_t> cells;
  double rms = 0;
};

Plane fit_plane(const CloudCells& cells, std::vector<std::size_t> of) {
  Plane plane{.line = {}, .cells = std::move(of), .rms = 0};
  const Eigen::Vector2d origin = cells[plane.cells[0]].at.head<2>().cast<double>();
  Scatter scatter;
  for (const std::size_t i : plane.cells) {
    const Eigen::Vector2d p = cells[i].at.head<2>().cast<double>() - origin;
    scatter.add(p.x(), p.y());
  }
  const auto [angle, along, across] = scatter.axes();
  CloudFacade& line = plane.line;
  line.centre = origin + scatter.mean();
  line.normal = {-std::sin(angle), std::cos(angle)};
  if (line.normal.dot(line.centre) > 0) line.normal = -line.normal;
  line.begin = line.end = 0;
  line.base = 1e9, line.top = -1e9;
  for (const std::size_t i : plane.cells) {
    const double s = line.along().dot(cells[i].at.head<2>().cast<double>() - line.centre);
    line.begin = std::min(line.begin, s), line.end = std::max(line.end, s);
    line.base = std::min(line.base, static_cast<double>(cells[i].height));
    line.top = std::max(line.top, static_cast<double>(cells[i].height));
  }
  line.cells = static_cast<int>(plane.cells.size());
  plane.rms = std::sqrt(across);
  // Cells side by side share what makes a wall uneven: a quarter of them counts.
  const double variance = std::max(across, kFacadeSd * kFacadeSd), count = std::max(1.0, scatter.n / 4);
  line.centre_variance = variance / count + kFacadeSd * kFacadeSd;
  line.angle_variance = variance / (count * std::max(along, 1e-6)) + kFacadeAngleSd * kFacadeAngleSd;
  return plane;
}

bool are_one_facade(const CloudFacade& a, const CloudFacade& b) {
  if (!(a.normal.dot(b.normal) > std::cos(kJoinAngle))) return false;
  const double middle = a.along().dot(b.centre - a.centre);
  const double gap = std::max(middle + b.begin - a.end, a.begin - (middle + b.end));
  // The distance of either line from the near end of the other.
  const Eigen::Vector2d end_of_a = a.centre + (middle > 0 ? a.end : a.begin) * a.along(),
                        end_of_b = b.centre + (middle > 0 ? b.begin : b.end) * b.along();
  return gap <= kJoinGap && std::abs(b.normal.dot(end_of_a - b.centre)) <= kJoinOffset &&
         std::abs(a.normal.dot(end_of_b - a.centre)) <= kJoinOffset;
}

void join_planes(const CloudCells& cells, std::vector<Plane>& planes) {
  for (std::size_t i = 0; i < planes.size(); ++i)
    for (std::size_t j = i + 1; j < planes.size();) {
      if (!are_one_facade(planes[i].line, planes[j].line)) {
        ++j;
        continue;
      }
      std::vector<std::size_t> both = planes[i].cells;
      both.insert(both.end(), planes[j].cells.begin(), planes[j].cells.end());
      std::ranges::sort(both);
      planes[i] = fit_plane(cells, std::move(both));
      planes.erase(planes.begin() + static_cast<std::ptrdiff_t>(j));
      j = i + 1;
    }
}

/// The squares of a plane in which it has points.
class FilledSquares {
 public:
  FilledSquares(const CloudCells& cells, const Plane& plane) : line_(plane.line) {
    for (const std::size_t i : plane.cells) low_ = std::min(low_, cells[i].at.z());
    for (const std::size_t i : plane.cells)
      filled_.insert(square(line_.along().dot(cells[i].at.head<2>().cast<double>() - line_.centre),
                            static_cast<double>(cells[i].at.z())));
  }

  /// Returns their fraction of the rectangle around the plane.
  double fraction() const {
    const double all =
        std::ceil(line_.length() / kFilledCell) * std::ceil((line_.top - line_.base) / kFilledCell);
    return static_cast<double>(filled_.size()) / std::max(1.0, all);
  }

  /// Returns how many cells behind the plane are seen through them. Openings have no points and do not count.
  int seen_through(const CloudCells& cells) const {
    const double distance = -line_.normal.dot(line_.centre);  // of the scanner
    int behind = 0;
    for (const CloudCell& cell : cells.cells()) {
      const Eigen::Vector2d p = cell.at.head<2>().cast<double>();
      const double depth = -line_.normal.dot(p);
      if (!(depth > distance + kBehind)) continue;
      const double fraction = distance / depth, s = line_.along().dot(fraction * p - line_.centre);
      behind += s >= line_.begin && s <= line_.end &&
                filled_.contains(square(s, fraction * static_cast<double>(cell.at.z())));
    }
    return behind;
  }

 private:
  std::pair<int, int> square(double s, double z) const {
    return {static_cast<int>(std::floor((s - line_.begin) / kFilledCell)),
            static_cast<int>(std::floor((z - static_cast<double>(low_)) / kFilledCell))};
  }

  const CloudFacade& line_;
  float low_ = 1e9F;
  std::set<std::pair<int, int>> filled_;
};

}  // namespace

std::vector<CloudFacade> find_facades(const PointCloud& cloud, const CloudFacadeOptions& options) {
  const CloudCells cells(cloud, options.max_range, kFacadeCell, kFacadeFoot, kFacadeTop);
  std::vector<Plane> planes;
  for (auto& plane : grow_planes(cells)) planes.push_back(fit_plane(cells, std::move(plane)));
  join_planes(cells, planes);
  std::vector<CloudFacade> facades;
  for (const Plane& plane : planes) {
    const CloudFacade& line = plane.line;
    const double distance = -line.normal.dot(line.centre);
    if (!(line.length() >= options.min_length && line.top - line.base >= options.min_height &&
          plane.rms <= options.max_rms && distance > 0.5))
      continue;
    if (!(line.top >= options.min_top) &&
        !(line.top >= options.min_low_top && line.length() >= options.min_low_length))
      continue;
    const FilledSquares filled(cells, plane);
    if (filled.fraction() >= options.min_filled &&
        filled.seen_through(cells) <= options.max_through * static_cast<double>(plane.cells.size()))
      facades.push_back(line);
  }
  std::ranges::stable_sort(facades, std::ranges::greater{}, &CloudFacade::length);
  if (std::ssize(facades) > options.max_count) facades.resize(static_cast<std::size_t>(options.max_count));
  return facades;
}

}  // namespace waymark::localization
