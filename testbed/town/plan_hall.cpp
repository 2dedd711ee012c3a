// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "testbed/town/town.hpp"

namespace waymark::testbed {
namespace {

constexpr double kClearOfDoor = 0.5;  // m between a jamb and the middle of a pillar
constexpr int kDraws = 100;           // of a place for a pillar
constexpr double kJamb = 0.15;        // m: thickness of the walls towards the corridor
constexpr double kHallHalfTurn = std::numbers::pi;

struct Door {
  double from, to;  // along its wall
};

/// The rooms along one straight of the corridor. Along it runs u, away from the corridor v.
class RoomRow {
 public:
  RoomRow(const HallModel& model, const Eigen::Vector2d& from, const Eigen::Vector2d& to, Random& plan,
          Random& doors, Town& town)
      : model_(model),
        from_(from),
        u_((to - from).normalized()),
        v_(u_.y(), -u_.x()),
        length_((to - from).norm()),
        plan_(plan),
        doors_(doors),
        town_(town) {}

  void plan() {
    double start = 0, piece = 0;
    const double usual = model_.room_width;
    while (start < length_ - 1e-9) {
      double width = usual * (1 + model_.room_variation * plan_.uniform(-1, 1));
      if (length_ - start - width < 0.7 * usual) width = length_ - start;
      const double middle = start + width * (0.5 + model_.room_variation * plan_.uniform(-0.5, 0.5));
      const double door = model_.door_width / 2;
      wall(piece, middle - door);
      room(start, start + width, {middle - door, middle + door});
      piece = middle + door;
      start += width;
    }
    wall(piece, length_);
  }

 private:
  Eigen::Vector2d at(double u, double v) const { return from_ + u * u_ + v * v_; }

  /// Piece of the wall of the corridor between two doors, with the faces of both jambs.
  void wall(double a, double b) {
    if (b - a < 1e-9) return;
    town_.walls.push_back({at(a, 0), at(b, 0)});
    town_.walls.push_back({at(a, kJamb), at(b, kJamb)});
    if (b - a > 0.3)
      town_.landmarks.push_back({.type = "wall",
                                 .kind = {},
                                 .at = at((a + b) / 2, 0),
                                 .direction = std::atan2(-v_.x(), -v_.y()),
                                 .length = b - a});
  }

  void room(double a, double b, const Door& door) {
    town_.walls.push_back({at(a, kJamb), at(a, model_.room_depth)});
    town_.walls.push_back({at(b, kJamb), at(b, model_.room_depth)});
    town_.walls.push_back({at(a, model_.room_depth), at(b, model_.room_depth)});
    town_.walls.push_back({at(door.from, 0), at(door.from, kJamb)});
    town_.walls.push_back({at(door.to, 0), at(door.to, kJamb)});
    town_.landmarks.push_back({.type = "door",
                               .kind = {},
                               .at = at((door.from + door.to) / 2, 0),
                               .orientation = std::remainder(std::atan2(u_.x(), u_.y()), kHallHalfTurn),
                               .width = door.to - door.from});
    // Ends of the wall at both jambs: who looks at the face along v has the wall of the first on the right.
    for (const bool second : {false, true})
      town_.landmarks.push_back({.type = "wall_end",
                                 .kind = {},
                                 .at = at(second ? door.to : door.from, 0),
                                 .direction = std::atan2(-v_.x(), -v_.y()),
                                 .side = second ? 1.0 : -1.0});
    const bool open = doors_.bernoulli(model_.doors_open);
    const double swing = doors_.uniform(0.6, 1.7);  // rad
    if (!open)
      town_.walls.push_back({at(door.from, kJamb / 2), at(door.to, kJamb / 2)});
    else
      town_.walls.push_back(
          {at(door.from, kJamb),
           at(door.from, kJamb) + (door.to - door.from) * (std::cos(swing) * u_ + std::sin(swing) * v_)});
  }

  const HallModel& model_;
  Eigen::Vector2d from_, u_, v_;
  double length_;
  Random &plan_, &doors_;
  Town& town_;
};

/// Adds a second half that is the first one turned by half a turn about the origin.
void add_turned_half(Town& town) {
  const std::size_t walls = town.walls.size(), posts = town.posts.size(), landmarks = town.landmarks.size();
  for (std::size_t i = 0; i < walls; ++i) town.walls.push_back({-town.walls[i].from, -town.walls[i].to});
  for (std::size_t i = 0; i < posts; ++i) {
    TownPost post = town.posts[i];
    post.at = -post.at, post.to = -post.to;
    town.posts.push_back(post);
  }
  for (std::size_t i = 0; i < landmarks; ++i) {
    TownLandmark landmark = town.landmarks[i];
    landmark.at = -landmark.at;
    if (landmark.direction)
      landmark.direction = std::remainder(*landmark.direction + kHallHalfTurn, 2 * kHallHalfTurn);
    town.landmarks.push_back(landmark);
  }
}

}  // namespace

Town plan_hall(const HallModel& model, std::uint64_t seed, std::uint64_t drive_seed) {
  Town town;
  Random plan(seed, "rooms"), doors(drive_seed, "doors"), people(drive_seed, "people");
  const double x = model.length / 2, y = model.width / 2, half = model.corridor_width / 2;
  const double ox = x + half, oy = y + half, ix = x - half, iy = y - half;
  // Counter-clockwise around the outside; the corridor lies to the left.
  const std::vector<Eigen::Vector2d> outer = {{-ox, -oy}, {ox, -oy}, {ox, oy}, {-ox, oy}};
  for (std::size_t i = 0; i < (model.symmetric ? 2U : 4U); ++i)
    RoomRow(model, outer[i], outer[(i + 1) % 4], plan, doors, town).plan();
  const std::int64_t pillars = model.symmetric ? model.pillars / 2 : model.pillars;
  for (std::int64_t i = 0; i < pillars; ++i) {
    const double v = (i % 2 == 0 && !model.symmetric) ? oy - 0.25 : -oy + 0.25;
    double u = plan.uniform(-ix + 1, ix - 1);
    const auto blocks_door = [&](const TownLandmark& l) {
      return l.type == "door" && (l.at - Eigen::Vector2d(u, v)).norm() < model.door_width / 2 + kClearOfDoor;
    };
    for (int draw = 0; draw < kDraws && std::ranges::any_of(town.landmarks, blocks_door); ++draw)
      u = plan.uniform(-ix + 1, ix - 1);
    const double diameter = plan.uniform(0.32, 0.45);
    town.posts.push_back({.at = {u, v}, .radius = diameter / 2});
    town.landmarks.push_back({.type = "pillar", .kind = {}, .at = {u, v}, .diameter = diameter, .height = 3});
  }
  if (model.symmetric) add_turned_half(town);
  const std::vector<Eigen::Vector2d> core = {{-ix, -iy}, {ix, -iy}, {ix, iy}, {-ix, iy}};
  add_outline(town, core, false);
  for (std::size_t i = 0; i < 4; ++i) {  // walls of the core, seen from the corridor
    const Eigen::Vector2d run = core[(i + 1) % 4] - core[i];
    town.landmarks.push_back({.type = "wall",
                              .kind = {},
                              .at = core[i] + run / 2,
                              .direction = std::atan2(run.y(), -run.x()),
                              .length = run.norm()});
  }
  for (std::size_t i = 0; i < 4; ++i) {  // corners of the corridor, seen from inside
    const Eigen::Vector2d open = -outer[i].cwiseSign();
    town.landmarks.push_back({.type = "wall_corner",
                              .kind = {},
                              .at = outer[i],
                              .direction = std::atan2(open.x(), open.y()),
                              .opening_angle = kHallHalfTurn / 2});
  }
  for (std::int64_t i = 0; i < model.people; ++i) {
    const double v = (i % 2 == 0 ? 1 : -1) * (y + people.uniform(-0.5, 0.5) * half);
    town.posts.push_back({.at = {-x + people.uniform(0, 4), v},
                          .radius = 0.2,
                          .to = {x - people.uniform(0, 4), v},
                          .speed = people.uniform(0.6, 1.2)});
  }
  std::vector<Eigen::Vector2d> loop;
  const double c = 1;  // corners are cut
  for (int round = 0; round < 2; ++round)
    loop.insert(loop.end(), {{-x + c, -y},
                             {x - c, -y},
                             {x, -y + c},
                             {x, y - c},
                             {x - c, y},
                             {-x + c, y},
                             {-x, y - c},
                             {-x, -y + c}});
  town.path = dense_path(loop);
  return town;
}

}  // namespace waymark::testbed
