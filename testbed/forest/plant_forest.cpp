// SPDX-License-Identifier: Apache-2.0
#include "testbed/forest/plant_forest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "core/error.hpp"
#include "core/random.hpp"

namespace waymark::testbed {
namespace {

using Place = Eigen::Vector2d;

void check(const ForestModel& law) {
  const double hectares = law.width * law.height / 1e4;
  const double trees = hectares * (std::max(law.density, law.density_to) + law.understory);
  if (!(law.width >= 10 && law.height >= 10))
    throw Error(ErrorCode::usage, fmt::format("a forest of {} x {} m is too small", law.width, law.height),
                "forest", "set width and height to 10 m or more");
  if (!(trees <= 4e6))
    throw Error(ErrorCode::usage, fmt::format("the forest would have {:.0f} trees", trees), "forest",
                "at most 4 million are possible: reduce the site or the density");
}

/// Strips from west to east with irregular borders.
std::vector<SyntheticStand> lay_out(const ForestModel& law, double east, double north, std::uint64_t seed) {
  Random random(seed, "stands");
  const auto count = static_cast<int>(law.stands);
  constexpr int kPieces = 8;
  std::vector<std::vector<Place>> borders;
  for (int b = 0; b <= count; ++b) {
    std::vector<Place>& border = borders.emplace_back();
    const double x = law.width * (static_cast<double>(b) / count - 0.5);
    const double sway = b == 0 || b == count ? 0 : 0.15 * law.width / count;
    for (int i = 0; i <= kPieces; ++i)
      border.emplace_back(east + x + random.uniform(-sway, sway),
                          north + law.height * (static_cast<double>(i) / kPieces - 0.5));
  }
  std::vector<SyntheticStand> stands;
  for (int s = 0; s < count; ++s) {
    SyntheticStand stand{.name = fmt::format("{}", s + 1), .outline = borders[static_cast<std::size_t>(s)]};
    std::ranges::reverse(stand.outline);  // down the west side, up the east side
    const auto& right = borders[static_cast<std::size_t>(s) + 1];
    stand.outline.insert(stand.outline.end(), right.begin(), right.end());
    const double last = law.density_to > 0 ? law.density_to : law.density;
    const double along = count > 1 ? static_cast<double>(s) / (count - 1) : 0;
    stand.density = law.density > 0 ? law.density * std::pow(last / law.density, along) : 0;
    stands.push_back(std::move(stand));
  }
  return stands;
}

bool surrounds(const std::vector<Place>& ring, const Place& at) {
  bool odd = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Place *low = &ring[i], *high = &ring[(i + 1) % ring.size()];
    if (low->y() > high->y()) std::swap(low, high);
    if (low->y() <= at.y() && at.y() < high->y() &&
        at.x() < low->x() + (high->x() - low->x()) * (at.y() - low->y()) / (high->y() - low->y()))
      odd = !odd;
  }
  return odd;
}

/// Index of accepted positions by squares of the clearance.
class SpacingFilter {
 public:
  explicit SpacingFilter(double clearance) : clearance_(std::max(clearance, 1e-3)) {}
  bool take(const Place& place) {
    const auto column = index(place.x()), row = index(place.y());
    for (std::int64_t r = row - 1; r <= row + 1; ++r)
      for (std::int64_t c = column - 1; c <= column + 1; ++c)
        if (const auto found = taken_.find(key(c, r)); found != taken_.end())
          for (const Place& other : found->second)
            if ((other - place).squaredNorm() < clearance_ * clearance_) return false;
    taken_[key(column, row)].push_back(place);
    return true;
  }

 private:
  std::int64_t index(double value) const { return static_cast<std::int64_t>(std::floor(value / clearance_)); }
  static std::int64_t key(std::int64_t c, std::int64_t r) { return c * 4'000'037 + r; }
  double clearance_;
  std::unordered_map<std::int64_t, std::vector<Place>> taken_;
};

/// Stems of one stand: as many as its density requires, or as the clearance permits.
std::vector<Place> stems_of(const ForestModel& law, const SyntheticStand& stand, double hectares,
                            Random& random, SpacingFilter& clearings) {
  Place low = stand.outline[0], high = low;
  for (const Place& corner : stand.outline) low = low.cwiseMin(corner), high = high.cwiseMax(corner);
  std::vector<Place> stems;
  const auto add = [&](const Place& place) {
    if (surrounds(stand.outline, place) && clearings.take(place)) stems.push_back(place);
  };
  if (law.pattern == "rows") {
    const double spacing = 100 / std::sqrt(std::max(stand.density, 1.0));
    for (double y = low.y() + spacing / 2; y < high.y(); y += spacing)
      for (double x = low.x() + spacing / 2; x < high.x(); x += spacing)
        add({x + random.normal(0, law.row_jitter), y + random.normal(0, law.row_jitter)});
    return stems;
  }
  const auto wanted = static_cast<std::size_t>(random.poisson(stand.density * hectares));
  Place middle = low;
  std::uint64_t left = 0;
  for (std::size_t tried = 0; stems.size() < wanted && tried < 60 * wanted + 100; ++tried) {
    Place place{random.uniform(low.x(), high.x()), random.uniform(low.y(), high.y())};
    if (law.pattern == "clustered") {
      if (left == 0) middle = place, left = 1 + random.poisson(law.cluster_size - 1);
      --left;
      place = {random.normal(middle.x(), law.cluster_radius / 2),
               random.normal(middle.y(), law.cluster_radius / 2)};
    }
    add(place);
  }
  return stems;
}

double area_of(const std::vector<Place>& ring) {
  double doubled = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const Place a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
    doubled += a.x() * b.y() - a.y() * b.x();
  }
  return doubled / 2;
}

StandingTree grow_tree(const SpeciesModel& kind, int species, double dbh, Random& random) {
  StandingTree tree;
  tree.species = species;
  tree.dbh = dbh;
  const double mean = kind.top * std::pow(1 - std::exp(-kind.rate * 100 * dbh), kind.bend);
  tree.height = 1.3 + mean * std::clamp(random.normal(1, kind.height_scatter), 0.6, 1.4);
  tree.crown_diameter = (kind.crown_intercept + kind.crown_slope * dbh) *
                        std::clamp(random.normal(1, kind.crown_scatter), 0.5, 1.6);
  tree.crown_base = tree.height * (1 - kind.crown_length * std::clamp(random.normal(1, 0.1), 0.7, 1.3));
  return tree;
}

}  // namespace

const std::vector<SpeciesModel>& ForestModel::species() const {
  static const std::vector<SpeciesModel> kinds{{.name = "conifer"},
                                               {.name = "broadleaf",
                                                .conifer = false,
                                                .top = 28,
                                                .rate = 0.05,
                                                .bend = 1.1,
                                                .height_scatter = 0.09,
                                                .crown_intercept = 1.6,
                                                .crown_slope = 17,
                                                .crown_scatter = 0.18,
                                                .crown_length = 0.55,
                                                .shape = 2.2,
                                                .lobes = 0.14,
                                                .depth = 0.4}};
  return kinds;
}

SyntheticForest plant_forest(const ForestModel& law, const Terrain& terrain, double east, double north,
                             std::uint64_t seed) {
  check(law);
  SyntheticForest forest{.stands = lay_out(law, east, north, seed), .trees = {}};
  Random places(seed, "stems"), sizes(seed, "tree sizes");
  SpacingFilter clearings(law.clearance);
  const auto plant = [&](const Place& place, double dbh) {
    const int species = sizes.bernoulli(law.conifers) ? 0 : 1;
    StandingTree tree = grow_tree(law.species()[static_cast<std::size_t>(species)], species, dbh, sizes);
    const auto ground = terrain.height(place.x(), place.y());
    tree.foot = {place.x(), place.y(), ground.value_or(0)};
    if (ground) forest.trees.push_back(tree);
  };
  for (const SyntheticStand& stand : forest.stands) {
    // Fully stocked stands have constant N D^1.605 (Reineke 1933).
    const double crowding = stand.density > 0 ? std::pow(law.density / stand.density, 1 / 1.605) : 1;
    // Weibull distribution above kMinDbh with that mean.
    const double scale =
        std::max(law.mean_dbh * crowding - kMinDbh, 0.01) / std::tgamma(1 + 1 / law.dbh_shape);
    for (const Place& place : stems_of(law, stand, area_of(stand.outline) / 1e4, places, clearings))
      plant(place,
            std::min(kMinDbh + scale * std::pow(-std::log(1 - sizes.uniform()), 1 / law.dbh_shape), 1.5));
  }
  Random young(seed, "understory");
  const auto count = young.poisson(law.understory * law.width * law.height / 1e4);
  for (std::uint64_t i = 0; i < count; ++i) {
    const Place place{east + young.uniform(-0.5, 0.5) * law.width,
                      north + young.uniform(-0.5, 0.5) * law.height};
    const double dbh = young.uniform(0.015, kMinDbh - 0.001);
    if (clearings.take(place)) plant(place, dbh);
  }
  std::ranges::stable_sort(forest.trees, [](const auto& a, const auto& b) { return a.height > b.height; });
  return forest;
}

int stand_index_at(const std::vector<SyntheticStand>& stands, const Place& place) {
  for (std::size_t i = 0; i < stands.size(); ++i)
    if (surrounds(stands[i].outline, place)) return static_cast<int>(i);
  return -1;
}

}  // namespace waymark::testbed
