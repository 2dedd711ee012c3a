// SPDX-License-Identifier: Apache-2.0
#include "testbed/forest/forest_scan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "testbed/noise.hpp"

namespace waymark::testbed {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kBucket = 5;  // metres
constexpr int kMaxReturns = 5;
constexpr double kPassProbability = 0.55, kMinReturnGap = 1.0;

/// Crown in the scan; heights are absolute.
struct Crown {
  Eigen::Vector2d middle;
  double radius = 0, base = 0, length = 0, shape = 1, bumps = 0, depth = 0.25;
  double lobe[3] = {}, phase[3] = {};

  double reach() const { return radius * 1.5; }
  /// Height of the surface; below the base where the crown does not reach.
  double surface(double x, double y, std::uint32_t noise) const {
    const double dx = x - middle.x(), dy = y - middle.y(), r = std::hypot(dx, dy);
    if (r > reach()) return -1e9;
    double outline = 1;
    const double angle = std::atan2(dy, dx);
    for (int k = 0; k < 3; ++k) outline += lobe[k] * std::cos((k + 2) * angle + phase[k]);
    const double relative_radius = r / (radius * std::clamp(outline, 0.4, 1.5));
    if (relative_radius >= 1) return -1e9;
    // Twigs and gaps; none at the top, so that the tree has its nominal height.
    const double rough = bumps * relative_radius * (gradient_noise_value(x / 0.9, y / 0.9, noise) - 1);
    return base + std::max(0.05, length * (1 - std::pow(relative_radius, shape)) + rough);
  }
};

Crown crown_of(const ForestModel& law, const StandingTree& tree, std::uint64_t seed, std::size_t index) {
  Random random(mix_bits(named_seed(seed, "crowns") + index));
  const SpeciesModel& kind = law.species().at(static_cast<std::size_t>(tree.species));
  Crown crown;
  crown.middle =
      tree.foot.head<2>() + 0.012 * tree.height * Eigen::Vector2d(random.normal(), random.normal());
  crown.radius = tree.crown_diameter / 2;
  crown.base = tree.foot.z() + tree.crown_base;
  crown.length = tree.height - tree.crown_base;
  crown.shape = kind.shape;
  crown.depth = kind.depth;
  crown.bumps = kind.conifer ? 0.2 : 0.45;
  for (int k = 0; k < 3; ++k) {
    crown.lobe[k] = random.normal(0, kind.lobes);
    crown.phase[k] = random.uniform(0, 2 * kPi);
  }
  return crown;
}

/// Index of crowns by the squares that they reach into.
class CrownIndex {
 public:
  CrownIndex(const ForestModel& law, const SyntheticForest& forest, std::uint64_t seed)
      : noise_(static_cast<std::uint32_t>(named_seed(seed, "twigs"))) {
    Eigen::Vector2d high(-1e18, -1e18);
    low_ = -high;
    for (std::size_t i = 0; i < forest.trees.size(); ++i) {
      crowns_.push_back(crown_of(law, forest.trees[i], seed, i));
      const Eigen::Vector2d reach = Eigen::Vector2d::Constant(crowns_[i].reach());
      low_ = low_.cwiseMin(crowns_[i].middle - reach);
      high = high.cwiseMax(crowns_[i].middle + reach);
    }
    if (crowns_.empty()) return;
    columns_ = bucket(high.x() - low_.x()) + 1;
    rows_ = bucket(high.y() - low_.y()) + 1;
    buckets_.resize(static_cast<std::size_t>(columns_ * rows_));
    const auto from = [](double distance) { return std::max<std::int64_t>(0, bucket(distance)); };
    for (std::size_t i = 0; i < crowns_.size(); ++i) {
      const Eigen::Vector2d at = crowns_[i].middle - low_;
      const double reach = crowns_[i].reach();
      for (std::int64_t r = from(at.y() - reach); r <= std::min(rows_ - 1, bucket(at.y() + reach)); ++r)
        for (std::int64_t c = from(at.x() - reach); c <= std::min(columns_ - 1, bucket(at.x() + reach)); ++c)
          buckets_[static_cast<std::size_t>(r * columns_ + c)].push_back(static_cast<std::uint32_t>(i));
    }
  }

  const std::vector<Crown>& crowns() const { return crowns_; }

  /// Crowns over a position with the height of their surface there, highest first.
  void crowns_over(double x, double y, std::vector<std::pair<double, const Crown*>>& found) const {
    found.clear();
    const std::int64_t c = bucket(x - low_.x()), r = bucket(y - low_.y());
    if (c < 0 || r < 0 || c >= columns_ || r >= rows_) return;
    for (const std::uint32_t i : buckets_[static_cast<std::size_t>(r * columns_ + c)]) {
      const double z = crowns_[i].surface(x, y, noise_);
      if (z > crowns_[i].base) found.emplace_back(z, &crowns_[i]);
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first > b.first : a.second < b.second;
    });
  }

 private:
  static std::int64_t bucket(double distance) {
    return static_cast<std::int64_t>(std::floor(distance / kBucket));
  }

  std::uint32_t noise_;
  std::vector<Crown> crowns_;
  Eigen::Vector2d low_;
  std::int64_t columns_ = 0, rows_ = 0;
  std::vector<std::vector<std::uint32_t>> buckets_;
};

std::uint8_t kind_of(double above_ground) {
  return above_ground < 2 ? 3 : above_ground < 5 ? 4 : 5;
}

/// Appends the returns of a pulse.
void trace_pulse(double x, double y, double ground,
                 const std::vector<std::pair<double, const Crown*>>& crowns, const ForestModel& law,
                 double time, Random& random, std::vector<LaserReturn>& returns) {
  const std::size_t first = returns.size();
  double last = 1e9;
  bool lost = false;
  const auto add = [&](double z, std::uint8_t kind) {
    last = z;
    returns.push_back({.x = x + random.normal(0, law.position_sd),
                       .y = y + random.normal(0, law.position_sd),
                       .z = z + random.normal(0, law.range_sd),
                       .kind = kind,
                       .intensity = static_cast<std::uint16_t>(kind == 2 ? 900 + random.uniform_index(400)
                                                                         : 250 + random.uniform_index(500)),
                       .time = time});
  };
  for (const auto& [top, crown] : crowns) {
    const double z = top + crown->depth * std::log(1 - random.uniform());
    if (z < std::max(crown->base, ground) || z > last - kMinReturnGap) continue;
    add(z, kind_of(z - ground));
    if (returns.size() - first == kMaxReturns || !random.bernoulli(kPassProbability)) {
      lost = true;
      break;
    }
  }
  if (!lost && ground < last - 0.5) add(ground, 2);
  const auto count = static_cast<std::uint8_t>(returns.size() - first);
  for (std::uint8_t k = 0; k < count; ++k) {
    returns[first + k].number = static_cast<std::uint8_t>(k + 1);
    returns[first + k].of = count;
  }
}

/// Fills cells without a value with the mean of their known neighbours, once.
void fill_pits(Grid<float>& heights) {
  const Grid<float> before = heights;
  for (std::int64_t j = 0; j < heights.rows(); ++j)
    for (std::int64_t i = 0; i < heights.columns(); ++i) {
      if (!std::isnan(before(i, j))) continue;
      double sum = 0;
      int count = 0;
      for (std::int64_t b = j - 1; b <= j + 1; ++b)
        for (std::int64_t a = i - 1; a <= i + 1; ++a)
          if (before.contains(a, b) && !std::isnan(before(a, b)))
            sum += static_cast<double>(before(a, b)), ++count;
      if (count > 0) heights(i, j) = static_cast<float>(sum / count);
    }
}

}  // namespace

ForestRasters scan_forest(const ForestModel& law, const SyntheticForest& forest, const Terrain& terrain,
                          double east, double north, std::uint64_t seed,
                          const std::function<void(std::span<const LaserReturn>)>& take) {
  const CrownIndex index(law, forest, seed);
  const auto columns = static_cast<std::int64_t>(std::floor(law.width / law.cell + 1e-9)),
             rows = static_cast<std::int64_t>(std::floor(law.height / law.cell + 1e-9));
  const float none = std::nanf("");
  ForestRasters out{.x0 = east - law.width / 2 + law.cell / 2,
                    .y0 = north + law.height / 2 - law.cell / 2,
                    .cell = law.cell,
                    .dsm = Grid<float>(columns, rows, none),
                    .dtm = Grid<float>(columns, rows, none),
                    .chm = Grid<float>(columns, rows, none)};
  const auto dtm_seed = static_cast<std::uint32_t>(named_seed(seed, "dtm errors"));
  std::vector<LaserReturn> returns;
  std::vector<std::pair<double, const Crown*>> over;
  for (std::int64_t j = 0; j < rows; ++j) {
    Random random(named_seed(seed, fmt::format("pulses of row {}", j)));
    returns.clear();
    const double middle_y = out.y0 - static_cast<double>(j) * law.cell;
    for (std::int64_t i = 0; i < columns; ++i) {
      const double middle_x = out.x0 + static_cast<double>(i) * law.cell;
      if (const auto ground = terrain.height(middle_x, middle_y))
        out.dtm(i, j) = static_cast<float>(
            *ground +
            law.dtm_sd * gradient_noise_value((middle_x - east) / 12, (middle_y - north) / 12, dtm_seed));
      const auto pulses = random.poisson(law.pulses * law.cell * law.cell);
      for (std::uint64_t p = 0; p < pulses; ++p) {
        const double x = middle_x + random.uniform(-0.5, 0.5) * law.cell,
                     y = middle_y + random.uniform(-0.5, 0.5) * law.cell;
        const auto ground = terrain.height(x, y);
        if (!ground) continue;
        index.crowns_over(x, y, over);
        const double time =
            static_cast<double>(j) * 0.02 + static_cast<double>(i) * 1e-5 + static_cast<double>(p) * 1e-7;
        trace_pulse(x, y, *ground, over, law, time, random, returns);
      }
    }
    for (const LaserReturn& hit : returns) {
      if (hit.number > 1) continue;
      const auto i = static_cast<std::int64_t>(std::floor((hit.x - out.x0) / law.cell + 0.5)),
                 r = static_cast<std::int64_t>(std::floor((out.y0 - hit.y) / law.cell + 0.5));
      if (!out.dsm.contains(i, r)) continue;
      float& cell = out.dsm(i, r);
      if (!(cell >= static_cast<float>(hit.z))) cell = static_cast<float>(hit.z);
    }
    if (take) take(returns);
  }
  for (int round = 0; round < 2; ++round) fill_pits(out.dsm);
  for (std::size_t k = 0; k < out.chm.cells().size(); ++k)
    out.chm.cells()[k] =
        std::isnan(out.dsm.cells()[k]) ? none : std::max(0.0F, out.dsm.cells()[k] - out.dtm.cells()[k]);
  return out;
}

std::vector<double> visible_crown_fraction(const ForestModel& law, const SyntheticForest& forest,
                                           std::uint64_t seed) {
  const CrownIndex index(law, forest, seed);
  std::vector<double> seen;
  std::vector<std::pair<double, const Crown*>> over;
  constexpr int kSamples = 48;
  const double golden = kPi * (3 - std::sqrt(5.0));
  for (const Crown& crown : index.crowns()) {
    int inside = 0, free = 0;
    for (int k = 0; k < kSamples; ++k) {
      const double r = crown.radius * std::sqrt((k + 0.5) / kSamples), angle = k * golden;
      index.crowns_over(crown.middle.x() + r * std::cos(angle), crown.middle.y() + r * std::sin(angle), over);
      const auto own = std::ranges::find(over, &crown, [](const auto& pair) { return pair.second; });
      if (own == over.end()) continue;
      ++inside;
      free += own == over.begin() ? 1 : 0;
    }
    seen.push_back(inside > 0 ? static_cast<double>(free) / inside : 0);
  }
  return seen;
}

}  // namespace waymark::testbed
