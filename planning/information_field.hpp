// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>
#include "landmarks/sensor_profile.hpp"
#include "localization/identification/landmark_grid.hpp"
#include "localization/line_of_sight.hpp"
#include "planning/belief.hpp"
namespace waymark::planning {

/// How landmarks inform a vehicle that drives past them.
struct LandmarkSensing {
  SensorCoverage coverage;
  double sightings_per_metre = 1;          ///< of each landmark in view
  double correlation_per_range = 0.4;      ///< length over which a landmark's map error repeats, in ranges
  double min_confidence = 0.5;             ///< less probable landmarks count as absent
  bool identities_known = true;            ///< false: sightings can be taken for other landmarks
  localization::LineOfSight visible = {};  ///< empty: always free; must be thread-safe
};

/// Calls `visit` with the index of each landmark that the sensor sees from a pose and its information per
/// metre driven, (m^-2, ...)/m. The factor of existence is left out.
/// - An error of the map repeats in every sighting: it counts as white noise of the same spectral density,
///   2 x correlation length x variance.
using VisitInformation = std::function<void(std::uint32_t landmark, const Symmetric3& information)>;
void visit_information(const localization::Pose2& pose, const localization::LandmarkGrid& map,
                       const LandmarkSensing& sensing, const VisitInformation& visit);

/// Information at a pose.
struct Information {
  Symmetric3 rate;     ///< per metre driven; each landmark counts with its confidence
  int landmarks = 0;   ///< seen, of the least confidence
  double quality = 0;  ///< sum of their qualities for the sensor (eq. 8)
};
Information information_at(const localization::Pose2& pose, const localization::LandmarkGrid& map,
                           const LandmarkSensing& sensing);

/// Directions of drives between cells: east, then counter-clockwise in steps of 45 degrees.
inline constexpr int kHeadings = 8;
localization::Pose2 heading_pose(double x, double y, int heading);

/// Calls `visit` as visit_information() does, once for each landmark seen in any of the first directions, one
/// to kHeadings. Bit h of `seen_in` is set if it is seen in direction h. Information does not depend on the
/// heading, so it and the line of sight are computed once.
using VisitDirections =
    std::function<void(std::uint32_t landmark, const Symmetric3& information, unsigned seen_in)>;
void visit_directions(const Eigen::Vector2d& at, int directions, const localization::LandmarkGrid& map,
                      const LandmarkSensing& sensing, const VisitDirections& visit);
/// Returns the information at a position in each of the first directions; the others are zero.
std::array<Information, kHeadings> information_in_directions(const Eigen::Vector2d& at, int directions,
                                                             const localization::LandmarkGrid& map,
                                                             const LandmarkSensing& sensing);

/// Square cells of the map frame on which routes are searched, row 0 in the south.
struct RouteCells {
  double x0 = 0, y0 = 0;  ///< centre of cell (0, 0), metres
  double cell = 1;        ///< metres
  std::int64_t columns = 0, rows = 0;

  std::int64_t count() const { return columns * rows; }
  double x(std::int64_t i) const { return x0 + static_cast<double>(i % columns) * cell; }
  double y(std::int64_t i) const { return y0 + static_cast<double>(i / columns) * cell; }
  /// Returns the index of the cell that holds a position; -1 outside.
  std::int64_t index(double x, double y) const;
};

/// Returns the number of headings at which the information differs: 1 if the sensor sees all round.
inline int informative_headings(const LandmarkSensing& sensing) {
  return sensing.coverage.view < 360 ? kHeadings : 1;
}

/// Information in every cell and heading. Most cells of large maps see nothing: they share one entry.
struct InformationField {
  RouteCells cells;
  int headings = 1;                   ///< 1: the sensor sees all round; else kHeadings
  std::vector<std::uint32_t> blocks;  ///< by cell; block 0: nothing is seen
  std::vector<Information> at;        ///< `headings` of each block

  const Information& get(std::int64_t cell, int heading) const {
    const std::size_t first = blocks[static_cast<std::size_t>(cell)] * static_cast<std::size_t>(headings);
    return at[first + (headings == 1 ? 0 : static_cast<std::size_t>(heading))];
  }
};
/// Receives the fraction of a computation that is done, from one thread at a time; may throw to end it.
using Advanced = std::function<void(double done)>;

/// Calls `visit` for each passable cell. Rows run in parallel; `advanced` is called after each.
void visit_cells(const RouteCells& cells, const std::vector<char>& passable,
                 const std::function<void(std::int64_t cell)>& visit, const Advanced& advanced = {});

/// Computes the field of the cells that are `passable`; others are empty. Threads do not change it.
InformationField make_information_field(const RouteCells& cells, const std::vector<char>& passable,
                                        const localization::LandmarkGrid& map, const LandmarkSensing& sensing,
                                        const Advanced& advanced = {});

}  // namespace waymark::planning
