// SPDX-License-Identifier: Apache-2.0
#include "planning/world_beliefs.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/random.hpp"
#include "planning/sd_bounds.hpp"

namespace waymark::planning {
namespace {

// Square root of the intra-class correlation of detections: 0.4 for the rocks of a simulated site
// (docs/methods/routes.md).
constexpr double kRepeated = 0.63;

}  // namespace

WorldBeliefs::WorldBeliefs(const Symmetric3& start, const Odometry& odometry,
                           const localization::LandmarkGrid& map, std::int64_t worlds, std::int64_t seed)
    : beliefs_(static_cast<std::size_t>(worlds), DriveBelief(start, odometry)),
      rivals_(std::make_shared<const Rivals>(map)) {
  std::vector<std::vector<Draw>> all(static_cast<std::size_t>(worlds));
  for (std::int64_t world = 0; world < worlds; ++world) {
    Random random(static_cast<std::uint64_t>(seed * 1'000'003 + world));
    std::vector<Draw>& draws = all[static_cast<std::size_t>(world)];
    draws.reserve(map.size());
    for (std::size_t i = 0; i < map.size(); ++i) {
      const bool exists = random.uniform() < map[i].quality;
      draws.push_back({exists, random.uniform()});
    }
  }
  draws_ = std::make_shared<const std::vector<std::vector<Draw>>>(std::move(all));
}

void WorldBeliefs::drive(const DriveStep& step) {
  for (DriveBelief& belief : beliefs_) belief.drive(step);
}

void WorldBeliefs::see(const localization::Pose2& pose, double length, const localization::LandmarkGrid& map,
                       const LandmarkSensing& sensing) {
  std::vector<Symmetric3> sums(beliefs_.size());
  visit_information(pose, map, sensing, [&](std::uint32_t i, const Symmetric3& information) {
    const localization::MapLandmark& landmark = map[i];
    const double detection =
        detection_probability(sensing.coverage, (landmark.at - pose.at()).norm(), landmark.diameter);
    if (!(detection > 0)) return;
    for (std::size_t world = 0; world < sums.size(); ++world) {
      const Draw& draw = (*draws_)[world][i];
      if (!draw.exists) continue;
      const double repeated = draw.visible < detection ? kRepeated : 0;
      const double recognised =
          sensing.identities_known
              ? 1
              : std::exp(-rivals_->expected(beliefs_[world].pose(), pose, i, sensing.coverage));
      add(sums[world], information, length * recognised * (1 - kRepeated + repeated / detection));
    }
  });
  for (std::size_t world = 0; world < sums.size(); ++world)
    if (!(sums[world] == Symmetric3{})) beliefs_[world].see(sums[world]);
}

Symmetric3 WorldBeliefs::mean() const {
  Symmetric3 mean;
  for (const DriveBelief& belief : beliefs_)
    add(mean, belief.pose(), 1 / static_cast<double>(beliefs_.size()));
  return mean;
}

std::vector<double> WorldBeliefs::position_sds() const {
  std::vector<double> sds;
  for (const DriveBelief& belief : beliefs_) sds.push_back(position_sd(belief.pose()));
  return sds;
}

std::vector<double> max_rate_in_any_world(const RouteCells& cells, const std::vector<char>& passable,
                                          const localization::LandmarkGrid& map,
                                          const LandmarkSensing& sensing, const Advanced& advanced) {
  std::vector<double> max_rates(slot(cells.count()), 0);
  const int headings = informative_headings(sensing);
  visit_cells(
      cells, passable,
      [&](std::int64_t cell) {
        const Eigen::Vector2d at(cells.x(cell), cells.y(cell));
        std::array<Symmetric3, kHeadings> sums{};
        visit_directions(at, headings, map, sensing,
                         [&](std::uint32_t i, const Symmetric3& information, unsigned seen_in) {
                           const double detection = detection_probability(
                               sensing.coverage, (map[i].at - at).norm(), map[i].diameter);
                           if (!(detection > 0)) return;
                           for (int h = 0; h < headings; ++h)
                             if (seen_in >> h & 1)
                               add(sums[slot(h)], information, 1 - kRepeated + kRepeated / detection);
                         });
        for (int h = 0; h < headings; ++h)
          max_rates[slot(cell)] = std::max(max_rates[slot(cell)], max_rate(sums[slot(h)]));
      },
      advanced);
  return max_rates;
}

std::vector<double> follow_route(WorldBeliefs& beliefs, const RouteProblem& problem,
                                 const localization::LandmarkGrid& map, const LandmarkSensing& sensing,
                                 Route& route) {
  const RouteCells& cells = problem.field.cells;
  std::vector<double> worst = beliefs.position_sds();
  route.worst_sd = 0;
  for (std::size_t i = 0; i < route.nodes.size(); ++i) {
    if (problem.advanced) problem.advanced(static_cast<double>(i) / static_cast<double>(route.nodes.size()));
    RouteNode& node = route.nodes[i];
    const localization::Pose2 pose = heading_pose(cells.x(node.cell), cells.y(node.cell), node.heading);
    const std::int64_t before = i > 0 ? route.nodes[i - 1].cell : node.cell;
    if (before != node.cell) {
      const double length = std::hypot(pose.x - cells.x(before), pose.y - cells.y(before));
      const double turn = std::abs(
          localization::wrap_angle((node.heading - route.nodes[i - 1].heading) * std::numbers::pi / 4));
      beliefs.drive({length, std::cos(pose.yaw), std::sin(pose.yaw), turn});
      beliefs.see(pose, length, map, sensing);
    }
    const std::vector<double> sds = beliefs.position_sds();
    for (std::size_t world = 0; world < sds.size(); ++world)
      worst[world] = std::max(worst[world], sds[world]);
    node.covariance = beliefs.mean();
    route.worst_sd = std::max(route.worst_sd, position_sd(node.covariance));
  }
  return worst;
}

}  // namespace waymark::planning
