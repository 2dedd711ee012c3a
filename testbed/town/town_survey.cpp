// SPDX-License-Identifier: Apache-2.0
#include "testbed/town/town_survey.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/random.hpp"
#include "core/units.hpp"

namespace waymark::testbed {
namespace {

constexpr double kMaxSlant = 15 * kRadiansPerDegree, kSurveySquare = 1, kSurveyMargin = 3;  // m
constexpr double kSurveyTop = 40;       // m, where pulses start: above all that stands
constexpr double kFoliagePath = 0.6;    // m, mean path of a pulse in a crown
constexpr double kSurveyGoesOn = 0.55;  // probability after a return from a crown
constexpr std::size_t kMaxSurveyReturns = 4;

/// A slanted line: its point on the road and how far it moves north for each metre of height.
struct Pulse {
  Eigen::Vector2d foot = Eigen::Vector2d::Zero();
  double slant = 0;

  Eigen::Vector3d at(double z) const { return {foot.x(), foot.y() + slant * z, z}; }
};

void raise_to_roof(const TownRoof& roof, const Pulse& pulse, double& highest) {
  if (std::abs(pulse.foot.x() - roof.middle.x()) > roof.half.x()) return;
  for (const double side : {-1.0, 1.0}) {
    const double falling = 1 + roof.slope * side * pulse.slant;
    const double z = (roof.ridge - roof.slope * side * (pulse.foot.y() - roof.middle.y())) / falling;
    const double from_ridge = side * (pulse.at(z).y() - roof.middle.y());
    if (from_ridge >= 0 && from_ridge <= roof.half.y()) highest = std::max(highest, z);
  }
}

/// Returns the height of the highest solid surface that a pulse meets.
double highest_surface(const Town& town, const Pulse& pulse) {
  double highest = town.ground(pulse.foot);
  for (const TownRoof& roof : town.roofs) raise_to_roof(roof, pulse, highest);
  if (std::abs(pulse.slant) < 1e-6) return highest;
  const Eigen::Vector2d from = pulse.at(kSurveyTop).head<2>(), along(0, pulse.slant > 0 ? -1 : 1);
  town.visit_hits(from, along, 0, [&](const TownHit& hit) {
    const double z = kSurveyTop - hit.range / std::abs(pulse.slant);
    if (z >= hit.bottom && z <= hit.top) highest = std::max(highest, z);
  });
  return highest;
}

/// Heights at which a pulse enters and leaves a crown.
std::optional<std::array<double, 2>> span_of(const TownCrown& crown, const Pulse& pulse) {
  const Eigen::Vector3d up = Eigen::Vector3d(0, pulse.slant, 1), off = crown.at - pulse.at(0);
  const double middle = off.dot(up) / up.squaredNorm();
  const double square = crown.radius * crown.radius - (off - middle * up).squaredNorm();
  if (!(square > 0)) return {};
  const double half = std::sqrt(square / up.squaredNorm());
  return std::array{middle + half, middle - half};
}

class Survey {
 public:
  Survey(const Town& town, const StreetModel& model, std::uint64_t seed)
      : town_(town), model_(model), random_(seed, "survey"), shift_(draw_shift()) {}

  /// Appends the returns of a pulse, first to last.
  void shoot(const Pulse& pulse, std::vector<LaserReturn>& out) {
    const double solid = highest_surface(town_, pulse);
    std::vector<double> heights;
    bool goes_on = true;
    for (const TownCrown& crown : town_.crowns)
      if (const auto span = span_of(crown, pulse); span && goes_on) goes_on = pass(*span, solid, heights);
    std::ranges::sort(heights, std::greater<>{});
    if (goes_on) heights.push_back(solid);
    const bool ground = goes_on && solid == town_.ground(pulse.foot);
    for (std::size_t i = 0; i < heights.size(); ++i)
      out.push_back(measured(pulse.at(heights[i]), i, heights.size(), ground && i + 1 == heights.size()));
  }

  Random& random() { return random_; }

 private:
  Eigen::Vector2d draw_shift() {
    const double east = random_.normal(0, model_.survey_shift_sd);
    return {east, random_.normal(0, model_.survey_shift_sd)};
  }

  /// Adds the returns from a crown. Returns whether the pulse goes on below it.
  bool pass(const std::array<double, 2>& span, double solid, std::vector<double>& heights) {
    for (double z = span[0];;) {
      z += kFoliagePath * std::log(1 - random_.uniform());
      if (z <= std::max(span[1], solid)) return true;
      heights.push_back(z);
      if (heights.size() + 1 == kMaxSurveyReturns || !random_.bernoulli(kSurveyGoesOn)) return false;
    }
  }

  LaserReturn measured(const Eigen::Vector3d& at, std::size_t index, std::size_t of, bool ground) {
    constexpr double kAcrossSd = 0.08, kRangeSd = 0.03;  // m
    return {.x = at.x() + shift_.x() + random_.normal(0, kAcrossSd),
            .y = at.y() + shift_.y() + random_.normal(0, kAcrossSd),
            .z = at.z() + random_.normal(0, kRangeSd),
            .number = static_cast<std::uint8_t>(index + 1),
            .of = static_cast<std::uint8_t>(of),
            .kind = static_cast<std::uint8_t>(ground ? 2 : 1)};
  }

  const Town& town_;
  const StreetModel& model_;
  Random random_;
  Eigen::Vector2d shift_;
};

}  // namespace

void survey_town(const Town& town, const StreetModel& model, std::uint64_t seed,
                 const std::function<void(std::span<const LaserReturn>)>& take) {
  Survey survey(town, model, seed);
  Eigen::AlignedBox2d area;
  for (const TownWall& wall : town.walls) area.extend(wall.from), area.extend(wall.to);
  std::vector<LaserReturn> row;
  for (double y = area.min().y() - kSurveyMargin; y < area.max().y() + kSurveyMargin; y += kSurveySquare) {
    row.clear();
    for (double x = area.min().x() - kSurveyMargin; x < area.max().x() + kSurveyMargin; x += kSurveySquare) {
      Random& random = survey.random();
      for (auto left = random.poisson(model.survey_pulses * kSurveySquare * kSurveySquare); left > 0;
           --left) {
        const double east = x + kSurveySquare * random.uniform(),
                     north = y + kSurveySquare * random.uniform();
        survey.shoot({{east, north}, std::tan(random.uniform(-kMaxSlant, kMaxSlant))}, row);
      }
    }
    take(row);
  }
}

}  // namespace waymark::testbed
