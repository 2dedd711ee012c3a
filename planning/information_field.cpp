// SPDX-License-Identifier: Apache-2.0
#include "planning/information_field.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <span>

#include "core/units.hpp"

namespace waymark::planning {
namespace {

constexpr double kMinRange = 0.1;  // m: nearer, a bearing has no direction

/// Returns the information per metre driven of a landmark in the direction `to`, r metres away.
Symmetric3 information_of(const localization::MapLandmark& landmark, const Eigen::Vector2d& to, double r,
                          const LandmarkSensing& sensing) {
  const SensorCoverage& sensor = sensing.coverage;
  const double correlation = sensing.correlation_per_range * sensor.range;
  const Eigen::Vector2d u = to / r, w(-u.y(), u.x());
  const Eigen::Matrix2d& s = landmark.covariance;
  const double rate = sensing.sightings_per_metre, bearing_sd = sensor.bearing_sd * kRadiansPerDegree;
  const double bearing = bearing_sd * bearing_sd / rate + 2 * correlation * w.dot(s * w) / (r * r);
  // The bearing's row of the measurement matrix is (-w / r, -1), that of the range (-u, 0).
  Symmetric3 j;
  const double detection = detection_probability(sensor, r, landmark.diameter);
  add(j, {w.x() * w.x() / (r * r), w.x() * w.y() / (r * r), w.y() * w.y() / (r * r), w.x() / r, w.y() / r, 1},
      detection / bearing);
  if (sensor.range_sd > 0) {
    const double range = sensor.range_sd * sensor.range_sd / rate + 2 * correlation * u.dot(s * u);
    add(j, {u.x() * u.x(), u.x() * u.y(), u.y() * u.y(), 0, 0, 0}, detection / range);
  }
  return j;
}

/// Adds a landmark to what is seen at a pose.
void add(Information& sum, const localization::MapLandmark& landmark, const Symmetric3& information) {
  add(sum.rate, information, landmark.quality);
  ++sum.landmarks;
  sum.quality += landmark.paper_quality;
}

/// Calls `visit` with each landmark that the sensor sees at one of the headings, its information, and the
/// headings as bits.
template <class Visit>
void visit_seen(const Eigen::Vector2d& at, std::span<const double> yaws,
                const localization::LandmarkGrid& map, const LandmarkSensing& sensing, const Visit& visit) {
  const double half_view = sensing.coverage.view / 2 * kRadiansPerDegree;
  map.near(at, sensing.coverage.range, [&](std::uint32_t i) {
    const Eigen::Vector2d to = map[i].at - at;
    const double r = to.norm();
    if (!(r > kMinRange)) return;
    unsigned seen_in = (1U << yaws.size()) - 1;
    if (half_view < std::numbers::pi) {
      const double azimuth = std::atan2(to.y(), to.x());
      for (std::size_t h = 0; h < yaws.size(); ++h)
        if (std::abs(localization::wrap_angle(azimuth - yaws[h])) > half_view) seen_in &= ~(1U << h);
    }
    if (seen_in == 0) return;
    if (sensing.visible && !sensing.visible({at.x(), at.y(), yaws.front()}, map[i].at)) return;
    visit(i, information_of(map[i], to, r, sensing), seen_in);
  });
}

}  // namespace

void visit_information(const localization::Pose2& pose, const localization::LandmarkGrid& map,
                       const LandmarkSensing& sensing, const VisitInformation& visit) {
  visit_seen(pose.at(), std::span(&pose.yaw, 1), map, sensing,
             [&](std::uint32_t i, const Symmetric3& information, unsigned) { visit(i, information); });
}

void visit_directions(const Eigen::Vector2d& at, int directions, const localization::LandmarkGrid& map,
                      const LandmarkSensing& sensing, const VisitDirections& visit) {
  static const std::array<double, kHeadings> yaws = [] {
    std::array<double, kHeadings> all{};
    for (int h = 0; h < kHeadings; ++h) all[static_cast<std::size_t>(h)] = heading_pose(0, 0, h).yaw;
    return all;
  }();
  visit_seen(at, std::span(yaws).first(static_cast<std::size_t>(directions)), map, sensing, visit);
}

Information information_at(const localization::Pose2& pose, const localization::LandmarkGrid& map,
                           const LandmarkSensing& sensing) {
  Information sum;
  visit_information(pose, map, sensing, [&](std::uint32_t i, const Symmetric3& information) {
    if (!(map[i].quality < sensing.min_confidence)) add(sum, map[i], information);
  });
  return sum;
}

std::array<Information, kHeadings> information_in_directions(const Eigen::Vector2d& at, int directions,
                                                             const localization::LandmarkGrid& map,
                                                             const LandmarkSensing& sensing) {
  std::array<Information, kHeadings> sums{};
  visit_directions(at, directions, map, sensing,
                   [&](std::uint32_t i, const Symmetric3& information, unsigned seen_in) {
                     if (map[i].quality < sensing.min_confidence) return;
                     for (int h = 0; h < directions; ++h)
                       if (seen_in >> h & 1) add(sums[static_cast<std::size_t>(h)], map[i], information);
                   });
  return sums;
}

localization::Pose2 heading_pose(double x, double y, int heading) {
  return {x, y, localization::wrap_angle(heading * std::numbers::pi / 4)};
}

std::int64_t RouteCells::index(double px, double py) const {
  const double c = std::floor((px - x0) / cell + 0.5), r = std::floor((py - y0) / cell + 0.5);
  if (!(c >= 0 && r >= 0 && c < static_cast<double>(columns) && r < static_cast<double>(rows))) return -1;
  return static_cast<std::int64_t>(r) * columns + static_cast<std::int64_t>(c);
}

void visit_cells(const RouteCells& cells, const std::vector<char>& passable,
                 const std::function<void(std::int64_t cell)>& visit, const Advanced& advanced) {
  std::mutex mutex;
  std::int64_t rows = 0;
  tbb::parallel_for(std::int64_t{0}, cells.rows, [&](std::int64_t row) {
    for (std::int64_t i = row * cells.columns; i < (row + 1) * cells.columns; ++i)
      if (passable[static_cast<std::size_t>(i)]) visit(i);
    if (!advanced) return;
    const std::scoped_lock lock(mutex);
    advanced(static_cast<double>(++rows) / static_cast<double>(cells.rows));
  });
}

InformationField make_information_field(const RouteCells& cells, const std::vector<char>& passable,
                                        const localization::LandmarkGrid& map, const LandmarkSensing& sensing,
                                        const Advanced& advanced) {
  InformationField field{cells, informative_headings(sensing), {}, {}};
  const auto count = static_cast<std::size_t>(field.headings);
  field.blocks.resize(static_cast<std::size_t>(cells.count()));
  // Blocks of a row are numbered from 1 until all rows before it are known.
  std::vector<std::vector<Information>> rows(static_cast<std::size_t>(cells.rows));
  visit_cells(
      cells, passable,
      [&](std::int64_t i) {
        const auto here = information_in_directions({cells.x(i), cells.y(i)}, field.headings, map, sensing);
        if (std::ranges::none_of(here, [](const Information& seen) { return seen.landmarks > 0; })) return;
        std::vector<Information>& row = rows[static_cast<std::size_t>(i / cells.columns)];
        row.insert(row.end(), here.begin(), here.begin() + field.headings);
        field.blocks[static_cast<std::size_t>(i)] = static_cast<std::uint32_t>(row.size() / count);
      },
      advanced);
  field.at.resize(count);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto before = static_cast<std::uint32_t>(field.at.size() / count) - 1;
    field.at.insert(field.at.end(), rows[r].begin(), rows[r].end());
    rows[r] = {};
    for (std::int64_t c = 0; c < cells.columns; ++c)
      if (auto& block =
              field.blocks[r * static_cast<std::size_t>(cells.columns) + static_cast<std::size_t>(c)])
        block += before;
  }
  return field;
}

}  // namespace waymark::planning
