// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/drive_world.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

#include "core/error.hpp"
#include "core/random.hpp"
#include "planning/vehicle.hpp"
#include "testbed/drive/drive_route.hpp"

namespace waymark::testbed {
namespace {

constexpr double kSpacing = 0.5;    // metres between points of the path
constexpr double kObstacle = 0.15;  // metres: higher rocks are obstacles
constexpr double kFelledAhead = 5;  // metres ahead at which a tree on the path is felled

std::vector<Eigen::Vector2d> plan_path(const DriveSettings& s, const Scene& scene, std::uint64_t seed) {
  const Eigen::Vector2d middle(scene.ground.east, scene.ground.north);
  const Eigen::Vector2d half(scene.ground.width / 2 - s.margin, scene.ground.height / 2 - s.margin);
  if (!(half.minCoeff() > 0))
    throw Error(ErrorCode::usage,
                fmt::format("the site of {:.0f} x {:.0f} m has no room within drive.margin = {:g} m",
                            scene.ground.width, scene.ground.height, s.margin),
                "drive", "enlarge the site, or reduce the margin");
  std::vector<Eigen::Vector2d> corners;
  if (s.route == "waypoints") {
    for (const Eigen::Vector2d& at : s.waypoints) corners.push_back(middle + at);
    if (corners.size() < 2)
      throw Error(ErrorCode::usage, "drive.waypoints must be a list of at least two [east, north]", "drive",
                  "or set drive.route to loop, lanes or wander");
  } else {
    Random random(seed, "route");
    // Longer than needed, since unreachable corners are skipped.
    corners = automatic_route(s.route, middle, half, 3 * s.length + 4 * half.norm(), s.lane_spacing, random);
  }
  const std::vector<Obstacle> obstacles = obstacles_of(scene.solids, kObstacle);
  const double edge = std::max(2.0, s.wheels.base);
  const TraversableMap ground(scene.terrain, obstacles, s.clearance, edge, s.max_slope);
  std::vector<Eigen::Vector2d> path;
  double driven = 0;
  Eigen::Vector2d reached = corners.front();
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const auto leg = ground.shortest_path(reached, corners[i + 1]);
    if (leg.empty()) {
      if (path.empty()) reached = corners[i + 1];  // start at the next corner
      if (s.route != "waypoints") continue;
      throw Error(
          ErrorCode::usage,
          fmt::format("no path leads from waypoint {} ({:.1f}, {:.1f}) to the next ({:.1f}, {:.1f})", i,
                      s.waypoints[i].x(), s.waypoints[i].y(), s.waypoints[i + 1].x(), s.waypoints[i + 1].y()),
          "drive", "move it, or change drive.clearance or drive.max_slope");
    }
    reached = leg.back();
    for (const Eigen::Vector2d& at : leg) {
      const double step = path.empty() ? 0 : (at - path.back()).norm();
      if (!path.empty() && step < 1e-6) continue;
      // An automatic route is cut at its length.
      if (s.route != "waypoints" && driven + step > s.length) {
        path.push_back(path.back() + (at - path.back()) * ((s.length - driven) / step));
        return smooth_path(path, kSpacing);
      }
      driven += step;
      path.push_back(at);
    }
  }
  if (path.size() < 2)
    throw Error(ErrorCode::usage, "no route can be driven on this terrain", "drive",
                "change drive.clearance or drive.max_slope, or use another seed");
  return smooth_path(path, kSpacing);
}

// Time at which each tree is felled: in the corridor before the vehicle arrives, others when it is beside
// them.
std::vector<FelledTree> fell(const DriveWorld& world, std::uint64_t seed) {
  const CraneModel& crane = world.settings.crane;
  std::vector<FelledTree> felled;
  for (std::size_t i = 0; i < world.trees.size(); ++i) {
    const Eigen::Vector2d at = world.trees[i].foot.head<2>();
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t beside = 0, first = world.steps.size();
    for (std::size_t k = 0; k < world.steps.size(); ++k) {
      const double d = (world.steps[k].at.plane.at() - at).squaredNorm();
      if (d < nearest) nearest = d, beside = k;
      // On the path: felled before the vehicle first reaches it.
      if (d < crane.corridor * crane.corridor && first == world.steps.size()) first = k;
    }
    nearest = std::sqrt(nearest);
    Random random(named_seed(seed, "thinning") + i);
    const bool on_path = first < world.steps.size();
    const bool thinned = nearest < crane.reach && random.bernoulli(crane.thinning);
    if (!on_path && !thinned) continue;
    std::size_t when = on_path ? first : beside;
    const double distance = world.steps[when].distance - (on_path ? kFelledAhead : 0.0);
    while (when > 0 && world.steps[when].distance > distance) --when;
    if ((world.steps[when].at.plane.at() - at).norm() > crane.reach && on_path) when = first;
    felled.push_back({world.steps[when].t, static_cast<std::uint32_t>(i)});
  }
  std::ranges::stable_sort(felled, {}, &FelledTree::t);
  return felled;
}

}  // namespace

namespace {

std::uint64_t seed_of(const DriveSettings& settings, std::uint64_t seed) {
  return settings.seed >= 0 ? static_cast<std::uint64_t>(settings.seed) : seed;
}

DriveSettings completed(DriveSettings s) {
  if (s.harvester() && s.laser.field.value == 240) s.laser.field = Degrees{180};
  if (s.laser_height == 0) s.laser_height = s.harvester() ? 2.0 : 0.35;
  if (s.dynamics.on) {
    // The vehicle that moves is that of its file: its wheels must pass what its route passes.
    const planning::Vehicle vehicle = planning::find_vehicle(s.moved_vehicle());
    const auto [rear, front] =
        std::ranges::minmax(vehicle.supports, {}, [](const planning::Support& p) { return p.x; });
    s.wheels = {.base = front.x.value - rear.x.value,
                .track = vehicle.track_width() - vehicle.supports.front().width.value};
    s.clearance = std::max(s.clearance, vehicle.base_radius());
  }
  return s;
}

// Adds rocks, stems and branches. Bushes and branches depend on the site, not on the drive.
void add_targets(DriveWorld& world, const Scene& scene, std::uint64_t site_seed) {
  ForestSolids solids = world.trees.empty()
                            ? ForestSolids{}
                            : forest_solids(world.trees, world.settings.clutter, scene.terrain, site_seed);
  for (const FelledTree& f : world.felled) {
    solids.stems[f.tree].felled_at = f.t;
    for (Thicket& t : solids.thickets)
      if (t.stem == f.tree) t.felled_at = f.t;
  }
  world.targets =
      LaserTargets(scene.terrain, scene.solids, std::move(solids.stems), std::move(solids.thickets));
}

}  // namespace

DriveWorld make_drive(const DriveSettings& settings, const Scene& scene, std::vector<StandingTree> trees,
                      std::uint64_t seed) {
  const std::uint64_t own = seed_of(settings, seed);
  const DriveSettings s = completed(settings);
  DriveWorld world{s, own, plan_path(s, scene, own), {}, {}, std::move(trees), {}, {scene.terrain, {}}};
  PathDrive drive = drive_along(scene.terrain, scene.solids, world.path, s, own);
  world.steps = std::move(drive.steps), world.mishap = std::move(drive.mishap);
  if (s.harvester()) world.felled = fell(world, own);
  add_targets(world, scene, seed);
  return world;
}

DriveWorld make_drive_site(const DriveSettings& settings, const Scene& scene, std::vector<StandingTree> trees,
                           std::uint64_t seed) {
  DriveWorld world{completed(settings), seed_of(settings, seed), {}, {}, {}, std::move(trees), {},
                   {scene.terrain, {}}};
  add_targets(world, scene, seed);
  return world;
}

namespace {

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t from = 0; from <= line.size();) {
    const std::size_t comma = std::min(line.find(',', from), line.size());
    std::string_view field = line.substr(from, comma - from);
    while (!field.empty() && (field.back() == '\r' || field.back() == ' ' || field.back() == '"'))
      field.remove_suffix(1);
    while (!field.empty() && (field.front() == ' ' || field.front() == '"')) field.remove_prefix(1);
    fields.push_back(field);
    from = comma + 1;
  }
  return fields;
}

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failed != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

}  // namespace

std::vector<StandingTree> trees_from_table(std::string_view csv, const std::string& source,
                                           const std::string& stand, const Eigen::Vector2d& middle,
                                           const Terrain& terrain) {
  const std::size_t head = std::min(csv.find('\n'), csv.size());
  const auto names = fields_of(csv.substr(0, head));
  const auto column = [&](std::initializer_list<std::string_view> any) -> std::optional<std::size_t> {
    for (const std::string_view name : any)
      for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == name) return i;
    return {};
  };
  const auto x = column({"x", "x_coord"}), y = column({"y", "y_coord"}), dbh = column({"dbh"}),
             diameter = column({"diameter"}), tall = column({"height"}), stands = column({"stand_id"}),
             id = column({"tree_id"});
  if (!x || !y || (!dbh && !diameter))
    throw Error(ErrorCode::input, "a table of trees needs the columns x, y and dbh (cm) or diameter (m)",
                source);
  std::map<std::string, std::size_t> seen;
  std::vector<StandingTree> trees;
  for (std::size_t from = head + 1; from < csv.size();) {
    const std::size_t end = std::min(csv.find('\n', from), csv.size());
    const auto row = fields_of(csv.substr(from, end - from));
    from = end + 1;
    if (row.size() < names.size() || (stands && !stand.empty() && row[*stands] != stand)) continue;
    const auto east = number(row[*x]), north = number(row[*y]);
    const auto wide = number(row[dbh ? *dbh : *diameter]);
    if (!east || !north || !wide || !(*wide > 0)) continue;  // trees without position or size are skipped
    StandingTree tree;
    tree.dbh = dbh ? *wide / 100 : *wide;
    const auto given = tall ? number(row[*tall]) : std::nullopt;
    tree.height = given && *given > 1.3 ? *given : 1.3 + 30 * (1 - std::exp(-3 * tree.dbh));
    tree.crown_diameter = 1 + 12 * tree.dbh;
    tree.crown_base = 0.4 * tree.height;
    tree.foot = {*east, *north, 0};
    if (id) {
      // The last year of a tree replaces earlier ones.
      const auto [place, is_new] = seen.try_emplace(std::string(row[*id]), trees.size());
      if (!is_new) {
        trees[place->second] = tree;
        continue;
      }
    }
    trees.push_back(tree);
  }
  if (trees.empty())
    throw Error(ErrorCode::input, "the table has no tree with a position and a diameter", source,
                stand.empty() ? "" : "is there a stand_id '" + stand + "'?");
  Eigen::Vector2d low = trees[0].foot.head<2>(), high = low;
  for (const StandingTree& t : trees)
    low = low.cwiseMin(t.foot.head<2>()), high = high.cwiseMax(t.foot.head<2>());
  const Eigen::Vector2d shift = middle - (low + high) / 2;
  std::vector<StandingTree> placed;
  for (StandingTree& t : trees) {
    t.foot.head<2>() += shift;
    if (const auto h = terrain.height(t.foot.x(), t.foot.y())) {
      t.foot.z() = *h;
      placed.push_back(t);
    }
  }
  return placed;
}

}  // namespace waymark::testbed
