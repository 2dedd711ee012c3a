// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "testbed/town/town.hpp"

namespace waymark::testbed {
namespace {

constexpr double kHouseDepth = 9, kAlley = 3, kGap = 1;            // m
constexpr double kKerb = 3.5;                                      // m from the facade to the kerb
constexpr double kHouseHeight = 8, kSignMiddle = 2.2;              // m above the pavement
constexpr double kCarLength = 4.4, kCarWidth = 1.8, kSpace = 5.5;  // m
constexpr double kStreetHalfTurn = std::numbers::pi;

/// Puts what stands along one side of the street; `side` is 1 north, -1 south.
class StreetSide {
 public:
  StreetSide(const StreetModel& model, double side, std::uint64_t seed, std::uint64_t drive_seed, Town& town)
      : model_(model),
        side_(side),
        random_(seed, side > 0 ? "north" : "south"),
        drive_(drive_seed, side > 0 ? "cars north" : "cars south"),
        surfaces_(seed, side > 0 ? "surfaces north" : "surfaces south"),
        vans_(drive_seed, side > 0 ? "vans north" : "vans south"),
        roofs_(seed, side > 0 ? "roofs north" : "roofs south"),
        town_(town) {}

  void plan() {
    kerb();
    houses();
    row(model_.pole_spacing, 0.5, [&](const Eigen::Vector2d& at) {
      post(at, random_.uniform(0.12, 0.2), "pole", "lamp", random_.uniform(4, 8));
    });
    row(model_.sign_spacing, 0.8, [&](const Eigen::Vector2d& at) {
      post(at, 0.08, "pole", "sign", 2.5);
      plate(at);
      town_.landmarks.push_back({.type = "traffic_sign",
                                 .kind = {},
                                 .at = at,
                                 .facing = side_ > 0
                                               ? kStreetHalfTurn / 2
                                               : -kStreetHalfTurn / 2,  // towards who drives on this side
                                 .height = kSignMiddle});
    });
    row(model_.tree_spacing, 1.2, [&](const Eigen::Vector2d& at) {
      post(at, random_.uniform(0.35, 0.7), "tree", "", random_.uniform(6, 15));
      town_.crowns.push_back(
          {.at = {at.x(), at.y(), surfaces_.uniform(4, 5)}, .radius = surfaces_.uniform(1.2, 2)});
    });
    bollards();
    reflectors();
    cars();
  }

 private:
  Eigen::Vector2d at(double along, double from_kerb) const {
    return {along, side_ * (model_.width / 2 - kKerb + from_kerb)};
  }

  void kerb() {
    const double y = side_ * (model_.width / 2 - kKerb), half = model_.length / 2 + 10;
    const double height = surfaces_.uniform(0.08, 0.16);
    town_.kerb = std::abs(y);
    (side_ > 0 ? town_.kerb_north : town_.kerb_south) = height;
    town_.walls.push_back({.from = {-half, y}, .to = {half, y}, .bottom = 0, .top = height});
    town_.landmarks.push_back({.type = "curb",
                               .kind = {},
                               .at = {0, y},
                               .direction = side_ > 0 ? kStreetHalfTurn : 0,
                               .height = height,
                               .length = 2 * half});
  }

  /// The plate of a sign in front of its post.
  void plate(const Eigen::Vector2d& at) {
    const double half = surfaces_.uniform(0.25, 0.4), middle = town_.ground(at) + kSignMiddle;
    const double x = at.x() + side_ * 0.06;
    // Its front runs from the left to the right of who looks at it.
    town_.walls.push_back({.from = {x, at.y() - side_ * half},
                           .to = {x, at.y() + side_ * half},
                           .bottom = middle - half,
                           .top = middle + half,
                           .surface = {.reflectivity = 1, .retro = true}});
  }

  void houses() {
    for (double x = -model_.length / 2 - 10; x < model_.length / 2 + 10;) {
      const double length = model_.house_length * random_.uniform(0.6, 1.4);
      const double front = model_.width / 2 + random_.uniform(0, model_.max_setback);
      const double y0 = side_ > 0 ? front : -front - kHouseDepth;
      add_outline(town_, {{x, y0}, {x + length, y0}, {x + length, y0 + kHouseDepth}, {x, y0 + kHouseDepth}},
                  false);
      const TownSurface surface{.reflectivity = surfaces_.uniform(0.2, 0.5),
                                .gloss = surfaces_.bernoulli(0.3) ? 0.5 : 0};
      for (auto wall = town_.walls.end() - 4; wall != town_.walls.end(); ++wall)
        wall->top = kHouseHeight, wall->surface = surface, wall->has_windows = true;
      const double slope = roofs_.uniform(0.4, 0.9);
      town_.roofs.push_back(
          {.middle = {x + length / 2, y0 + kHouseDepth / 2},
           .half = {length / 2 + std::min(model_.overhang, kGap / 2), kHouseDepth / 2 + model_.overhang},
           .ridge = kHouseHeight + slope * kHouseDepth / 2,
           .slope = slope});
      town_.landmarks.push_back({.type = "wall",
                                 .kind = {},
                                 .at = {x + length / 2, side_ * front},
                                 .direction = side_ > 0 ? kStreetHalfTurn : 0,
                                 .height = kHouseHeight,
                                 .length = length});
      x += length + (random_.bernoulli(0.5) ? kAlley : kGap);
    }
  }

  template <class Put>
  void row(double spacing, double from_kerb, const Put& put) {
    row_of(random_, spacing, from_kerb, put);
  }
  template <class Put>
  void row_of(Random& random, double spacing, double from_kerb, const Put& put) {
    if (!(spacing > 0)) return;
    for (double x = -model_.length / 2 + spacing * random.uniform(0.2, 0.6); x < model_.length / 2;
         x += spacing * random.uniform(0.85, 1.15))
      put(at(x, from_kerb + random.uniform(-0.1, 0.1)));
  }

  void post(const Eigen::Vector2d& where, double diameter, const char* type, const char* kind,
            double height) {
    const auto near = [&](const TownPost& p) {
      return (p.at - where).norm() < p.radius + diameter / 2 + 0.5;
    };
    if (std::ranges::any_of(town_.posts, near)) return;
    town_.posts.push_back(
        {.at = where, .radius = diameter / 2, .to = {}, .top = std::min(height, 8.0) + town_.ground(where)});
    town_.landmarks.push_back(
        {.type = type, .kind = kind, .at = where, .diameter = diameter, .height = height});
  }

  void bollards() {
    double left = model_.bollards * model_.length / 2;
    while (left >= 1) {
      const double x = random_.uniform(-model_.length / 2, model_.length / 2);
      for (int k = 0; k < 4 && left >= 1; ++k, left -= 1)
        post(at(x + 1.6 * k, 0.3), 0.12, "pole", "bollard", 1.1);
    }
  }

  /// Posts with reflecting tape at the kerb, in gaps between the others.
  void reflectors() {
    row_of(surfaces_, model_.reflector_spacing, 0.4, [&](const Eigen::Vector2d& at) {
      const std::size_t before = town_.posts.size();
      post(at, 0.1, "beacon", "", 1.2);
      if (town_.posts.size() > before) town_.posts.back().surface = {.reflectivity = 1, .retro = true};
    });
  }

  void cars() {
    for (double x = -model_.length / 2; x + kSpace < model_.length / 2; x += kSpace) {
      const bool taken = drive_.bernoulli(model_.parked);
      const double shift = drive_.uniform(0.1, kSpace - kCarLength - 0.1), gap = drive_.uniform(0.15, 0.35);
      if (!taken) continue;
      const double y = side_ * (model_.width / 2 - kKerb - gap - kCarWidth / 2);
      const double w = kCarWidth / 2, from = x + shift, to = from + kCarLength, bevel = 0.35;
      std::vector<Eigen::Vector2d> hull = {{from + bevel, y - w}, {to - bevel, y - w},  {to, y - w + bevel},
                                           {to, y + w - bevel},   {to - bevel, y + w},  {from + bevel, y + w},
                                           {from, y + w - bevel}, {from, y - w + bevel}};
      const double top = vans_.bernoulli(0.15) ? 2.3 : 1.5;
      for (std::size_t i = 0; i < hull.size(); ++i)
        town_.walls.push_back(
            {.from = hull[i], .to = hull[(i + 1) % hull.size()], .bottom = 0.15, .top = top});
    }
  }

  const StreetModel& model_;
  double side_;
  Random random_, drive_, surfaces_, vans_, roofs_;
  Town& town_;
};

}  // namespace

Town plan_street(const StreetModel& model, std::uint64_t seed, std::uint64_t drive_seed) {
  Town town;
  for (const double side : {1.0, -1.0}) StreetSide(model, side, seed, drive_seed, town).plan();
  const double end = model.length / 2 - 5, lane = 1.2;
  town.path = dense_path({{-end, -lane}, {end - 3, -lane}, {end, 0}, {end - 3, lane}, {-end, lane}});
  return town;
}

}  // namespace waymark::testbed
