// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/cloud_signs.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "localization/detectors/cloud_ground.hpp"

namespace waymark::localization {
namespace {

constexpr double kSignFoot = 1;     // m above the ground of what is looked at
constexpr double kSignCell = 0.25;  // m: points of adjacent cells are of one cluster
constexpr double kStrongPerMedian = 1.8, kStrongPerMax = 0.5;
constexpr double kSignPointSd = 0.03;                 // m
constexpr double kFootSd = 0.2, kPlateSize = 0.8;     // m
constexpr double kPlateAngleSd = 0.09;                // rad: plates are turned on their posts
constexpr double kSamePlane = 0.12, kPlaneReach = 1;  // m: a larger plane
constexpr double kNearer = 0.4;                       // m by which what hides the edge of a plate is nearer
constexpr double kPostWidth = 0.35;                   // m
constexpr double kMaxBeside = 0.2;                    // points beside a free plate, per point of it

struct PlatePoint {
  Eigen::Vector3d at;
  double height;  // above the ground
  bool operator<(const PlatePoint& b) const {
    return std::tuple(at.x(), at.y(), at.z()) < std::tuple(b.at.x(), b.at.y(), b.at.z());
  }
};
using PlateCell = std::tuple<int, int, int>;
using PlateCells = std::map<PlateCell, std::vector<PlatePoint>>;

PlateCell plate_cell(const Eigen::Vector3d& at) {
  const auto whole = [](double m) { return static_cast<int>(std::floor(m / kSignCell)); };
  return {whole(at.x()), whole(at.y()), whole(at.z())};
}

template <class Visit>
void visit_neighbours(const PlateCell& of, int reach, const Visit& visit) {
  const auto [x, y, z] = of;
  for (int u = x - reach; u <= x + reach; ++u)
    for (int v = y - reach; v <= y + reach; ++v)
      for (int w = z - reach; w <= z + reach; ++w) visit(PlateCell{u, v, w});
}

/// Returns the lowest ground about a point: behind parked cars the nearest ground that is seen is their
/// roofs.
float open_ground(const CloudGround& ground, const Eigen::Vector3f& p) {
  constexpr float kAbout = 3;  // m
  float lowest = ground.at(p.x(), p.y());
  for (const float dx : {-kAbout, 0.0F, kAbout})
    for (const float dy : {-kAbout, 0.0F, kAbout})
      if (const float height = ground.at(p.x() + dx, p.y() + dy);
          !(height >= lowest) && std::isfinite(height))
        lowest = height;
  return lowest;
}

/// Returns the points above 1 m in cells, sorted within each.
PlateCells raised_points(const PointCloud& cloud, const CloudSignOptions& options,
                         std::optional<float> strong) {
  const CloudGround ground(cloud.points, options.max_range);
  PlateCells cells;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    if (!p.allFinite() || !(p.head<2>().norm() < static_cast<float>(options.max_range))) continue;
    if (strong && !(cloud.intensities[i] >= *strong)) continue;
    const double height = static_cast<double>(p.z() - open_ground(ground, p));
    if (!(height > kSignFoot && height < options.max_top + options.max_size)) continue;
    cells[plate_cell(p.cast<double>())].push_back({p.cast<double>(), height});
  }
  for (auto& [cell, points] : cells) std::ranges::sort(points, std::less<>{});
  return cells;
}

/// Returns the intensity from which a return is strong.
float strong_intensity(const PointCloud& cloud, const CloudSignOptions& options) {
  const CloudGround ground(cloud.points, options.max_range);
  std::vector<float> raised;
  float largest = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    const float intensity = cloud.intensities[i];
    if (!p.allFinite() || !(intensity >= 0) || !std::isfinite(intensity)) continue;
    largest = std::max(largest, intensity);
    if (p.z() - ground.at(p.x(), p.y()) > static_cast<float>(kSignFoot)) raised.push_back(intensity);
  }
  if (raised.empty()) return largest;
  const auto middle = raised.begin() + std::ssize(raised) / 2;
  std::ranges::nth_element(raised, middle);
  return std::max(static_cast<float>(kStrongPerMedian) * *middle,
                  static_cast<float>(kStrongPerMax) * largest);
}

/// Returns the clusters of cells that touch each other.
std::vector<std::vector<PlatePoint>> clusters_of(PlateCells cells) {
  std::vector<std::vector<PlatePoint>> clusters;
  while (!cells.empty()) {
    std::vector<PlateCell> open{cells.begin()->first};
    std::vector<PlatePoint> cluster = std::move(cells.begin()->second);
    cells.erase(cells.begin());
    while (!open.empty()) {
      const PlateCell of = open.back();
      open.pop_back();
      visit_neighbours(of, 1, [&](const PlateCell& next) {
        const auto found = cells.find(next);
        if (found == cells.end()) return;
        cluster.insert(cluster.end(), found->second.begin(), found->second.end());
        open.push_back(next);
        cells.erase(found);
      });
    }
    std::ranges::sort(cluster, std::less<>{});  // sums do not depend on the order of the points
    clusters.push_back(std::move(cluster));
  }
  return clusters;
}

struct Plate {
  CloudSign sign;
  double rms = 0, base = 0, top = 0;
  double middle_z = 0;  // in the frame of the scanner
};

std::optional<Plate> fit_plate(const std::vector<PlatePoint>& points) {
  const auto n = static_cast<double>(points.size());
  Plate plate;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  plate.base = 1e9, plate.top = -1e9;
  for (const PlatePoint& p : points) {
    mean += p.at.head<2>() / n;
    plate.sign.height += p.height / n, plate.middle_z += p.at.z() / n;
    plate.base = std::min(plate.base, p.height), plate.top = std::max(plate.top, p.height);
  }
  double xx = 0, xy = 0, yy = 0;
  for (const PlatePoint& p : points) {
    const Eigen::Vector2d d = p.at.head<2>() - mean;
    xx += d.x() * d.x() / n, xy += d.x() * d.y() / n, yy += d.y() * d.y() / n;
  }
  const double half = std::hypot((xx - yy) / 2, xy), along = (xx + yy) / 2 + half,
               across = std::max(0.0, (xx + yy) / 2 - half), angle = std::atan2(2 * xy, xx - yy) / 2;
  if (!(along > 0)) return {};
  const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
  CloudSign& sign = plate.sign;
  sign.normal = {-direction.y(), direction.x()};
  if (sign.normal.dot(mean) > 0) sign.normal = -sign.normal;
  double begin = 0, end = 0;
  for (const PlatePoint& p : points) {
    const double s = direction.dot(p.at.head<2>() - mean);
    begin = std::min(begin, s), end = std::max(end, s);
  }
  // The middle between the outermost points does not depend on how the rows fall.
  sign.at = mean + (begin + end) / 2 * direction;
  // The foot may stand higher than the lowest ground near it; of a far plate one or two rows are seen.
  sign.height_sd = std::hypot(kFootSd, std::max(0.0, kPlateSize - (plate.top - plate.base)) / 2);
  sign.width = end - begin;
  sign.points = static_cast<int>(points.size());
  plate.rms = std::sqrt(across);
  const double variance = std::max(across, kSignPointSd * kSignPointSd);
  const double step = sign.width / std::max(1.0, std::sqrt(n));  // of the columns, roughly
  sign.covariance = (variance / n + kSignPointSd * kSignPointSd) * Eigen::Matrix2d::Identity() +
                    step * step / 6 * direction * direction.transpose();
  sign.normal_variance = variance / (n * along) + kPlateAngleSd * kPlateAngleSd;
  return plate;
}

bool has_size_of_sign(const Plate& plate, const CloudSignOptions& options) {
  return plate.base >= options.min_base && plate.top <= options.max_top &&
         plate.top - plate.base <= options.max_size && plate.sign.width >= options.min_width &&
         plate.sign.width <= options.max_size && plate.rms <= options.max_rms;
}

/// Returns whether a bright spot is part of a larger surface, such as a glossy wall that is seen head-on.
bool is_on_wall(const Plate& plate, const PointCloud& cloud) {
  const CloudSign& sign = plate.sign;
  const Eigen::Vector2d along(-sign.normal.y(), sign.normal.x());
  int around = 0;
  for (const Eigen::Vector3f& p : cloud.points) {
    const Eigen::Vector2d off = p.head<2>().cast<double>() - sign.at;
    const double aside = std::abs(along.dot(off)) - sign.width / 2;
    around += std::abs(sign.normal.dot(off)) < kSamePlane && aside > 0.1 && aside < 0.7 &&
              std::abs(static_cast<double>(p.z()) - plate.middle_z) < (plate.top - plate.base) / 2 + 0.3;
  }
  return around > sign.points / 2;
}

/// Signs of strong returns.
std::vector<CloudSign> reflecting_signs(const PointCloud& cloud, const CloudSignOptions& options) {
  std::vector<CloudSign> signs;
  for (const auto& cluster : clusters_of(raised_points(cloud, options, strong_intensity(cloud, options)))) {
    if (static_cast<int>(cluster.size()) < options.min_points) continue;
    if (const auto plate = fit_plate(cluster);
        plate && has_size_of_sign(*plate, options) && !is_on_wall(*plate, cloud))
      signs.push_back(plate->sign);
  }
  return signs;
}

/// Returns the points of a plate about a cell: those whose layers are as wide as plates are. The post below
/// is not.
std::vector<PlatePoint> wide_layers(const std::vector<PlatePoint>& points, double min_width) {
  std::map<int, std::vector<PlatePoint>> layers;
  for (const PlatePoint& p : points) layers[static_cast<int>(std::floor(p.height / kSignCell))].push_back(p);
  std::vector<PlatePoint> wide;
  for (const auto& [layer, of] : layers) {
    double width = 0;
    for (const PlatePoint& p : of) width = std::max(width, (p.at - of[0].at).head<2>().norm());
    for (const PlatePoint& p : of) width = std::max(width, (p.at - of.back().at).head<2>().norm());
    if (width >= 0.8 * min_width) wide.insert(wide.end(), of.begin(), of.end());
  }
  std::ranges::sort(wide, std::less<>{});
  return wide;
}

/// Returns whether a plate has edges of its own: no nearer object beside it cuts them off, it is no piece of
/// a larger plane, nothing stands beside it, and below it is a post at most.
bool is_free(const Plate& plate, const std::vector<PlatePoint>& of, const PlateCells& cells,
             const CloudSignOptions& options) {
  const CloudSign& sign = plate.sign;
  const Eigen::Vector2d along(-sign.normal.y(), sign.normal.x());
  const double range = sign.at.norm(), half = sign.width / 2;
  double lowest = 1e9, highest = -1e9, left = 1e9, right = -1e9;
  for (const PlatePoint& p : of) lowest = std::min(lowest, p.at.z()), highest = std::max(highest, p.at.z());
  int beside = 0;
  for (const auto& [cell, points] : cells)
    for (const PlatePoint& p : points) {
      const Eigen::Vector2d off = p.at.head<2>() - sign.at;
      const double aside = std::abs(along.dot(off)), depth = sign.normal.dot(off);
      const bool at_height = std::abs(p.height - sign.height) < plate.top - plate.base + 0.5;
      beside +=
          at_height && aside > half + 0.1 &&
          (off.norm() < half + options.clear || (std::abs(depth) < kSamePlane && aside < half + kPlaneReach));
      const double scale = range / p.at.head<2>().norm();  // to the plate, along the ray
      const double cut = std::abs(along.dot(scale * p.at.head<2>() - sign.at));
      beside += p.at.head<2>().dot(sign.at) > 0 && depth > kNearer && cut < half + options.clear &&
                scale * p.at.z() > lowest - 0.1 && scale * p.at.z() < highest + 0.1;
      if (p.height < plate.base - 0.1 && std::abs(depth) < 0.3 && aside < half + 0.2)
        left = std::min(left, along.dot(off)), right = std::max(right, along.dot(off));
    }
  return beside <= kMaxBeside * static_cast<double>(of.size()) && right - left <= kPostWidth;
}

/// Signs by shape alone: plates on a post, or in the air, with nothing beside them.
std::vector<CloudSign> free_plates(const PointCloud& cloud, const CloudSignOptions& options) {
  const PlateCells cells = raised_points(cloud, options, {});
  std::vector<CloudSign> signs;
  for (const auto& cluster : clusters_of(cells)) {
    const std::vector<PlatePoint> wide = wide_layers(cluster, options.min_free_width);
    if (static_cast<int>(wide.size()) < options.min_free_points) continue;
    const auto plate = fit_plate(wide);
    if (!plate || !has_size_of_sign(*plate, options) || plate->rms > options.max_free_rms ||
        plate->sign.width < options.min_free_width)
      continue;
    if (plate->base >= options.min_free_base && is_free(*plate, wide, cells, options))
      signs.push_back(plate->sign);
  }
  return signs;
}

}  // namespace

std::vector<CloudSign> find_signs(const PointCloud& cloud, const CloudSignOptions& options) {
  // A converter that had no intensities writes the same for all points.
  const bool differ = std::ranges::any_of(
      cloud.intensities, [&](float intensity) { return intensity != cloud.intensities.front(); });
  return differ && cloud.intensities.size() == cloud.points.size() ? reflecting_signs(cloud, options)
                                                                   : free_plates(cloud, options);
}

}  // namespace waymark::localization
