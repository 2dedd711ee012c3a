// SPDX-License-Identifier: Apache-2.0
#include "workflows/detection/crown_detection.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "importers/tiling.hpp"
#include "pipeline/forest/crown_network.hpp"
#include "pipeline/forest/find_trees.hpp"
#include "pipeline/forest/tree_ground.hpp"

namespace waymark::workflows {
namespace {

/// Darkness is squared, since lawns are as green as crowns, but brighter. NaN where there is no data.
double dark_green(const pipeline::ColourWindow& image, std::int64_t column, std::int64_t row) {
  const auto band = [&](std::size_t b) { return double(image.bands[b](column, row)); };
  const double red = band(0), green = band(1), blue = band(2);
  const double index = image.bands.size() > 3
                           ? (band(3) - red) / std::max(band(3) + red, 0.01)
                           : 12 * (2 * green - red - blue) / std::max(red + green + blue, 0.01);
  const double dark = std::clamp(1 - (red + green + blue) / 3, 0.0, 1.0);
  return std::max(index, 0.0) * dark * dark;
}

constexpr std::int64_t kSide = 768;       // cells worked on at once: 30 planes of them are in memory
constexpr double kMinProbability = 0.15;  // lowest probability of a crown's middle that is reported
constexpr double kIsolation = 3;          // metres

/// Probability of crowns in the role of a canopy.
class CrownCanopy final : public CanopySource {
 public:
  CrownCanopy(const ColourImage& image, const pipeline::DenseNetwork& network)
      : image_(image), network_(network) {
    grid_.columns = image.columns(), grid_.rows = image.rows();
    grid_.where = {Crs::local(), 0, 0, image.cell(), -image.cell()};
  }
  const GridGeometry& geometry() const override { return grid_; }
  const std::string& name() const override { return name_; }
  double ground_elevation(std::int64_t, std::int64_t) const override { return std::nan(""); }
  Grid<std::uint8_t> forest_types(const Window&) const override { return {}; }
  Grid<float> read(const Window& window) const override {
    const std::int64_t reach = pipeline::crown_probability_reach(image_.cell());
    const pipeline::ColourWindow seen = image_.read(
        {window.column - reach, window.row - reach, window.columns + 2 * reach, window.rows + 2 * reach});
    Grid<float> canopy = pipeline::crown_probability(seen, window, network_);
    for (float& value : canopy.cells())
      if (std::isnan(value)) value = kNoCanopy;
    return canopy;
  }

 private:
  const ColourImage& image_;
  const pipeline::DenseNetwork& network_;
  GridGeometry grid_;
  std::string name_ = "crowns";
};

pipeline::TreeSearch crown_search() {
  pipeline::TreeSearch search;
  search.forest.name = "imagery";
  search.forest.smoothing = 0;  // the probability is smooth
  search.forest.tops = {
      .min_height = kMinProbability, .isolation_base = kIsolation, .isolation_slope = 0, .prominence = 0};
  search.crowns = false;
  return search;
}

/// Returns the probability of a tree. The network's output is a smoothed bell about the middle and thus
/// lower. Fitted to detections in images that were left out of the training (`waymark train trees`).
double calibrated(double probability) {
  const double p = std::clamp(probability, 1e-6, 1 - 1e-6);
  return 1 / (1 + std::exp(-(1.25 + 1.15 * std::log(p / (1 - p)))));
}

}  // namespace

double crown_width(const pipeline::ColourWindow& image, const pipeline::CanopyCell& top) {
  const auto rings = static_cast<std::int64_t>(kMaxCrownDiameter / 2 / image.cell) + 1;
  std::vector<double> sum(static_cast<std::size_t>(rings) + 1), count(sum.size());
  for (std::int64_t dr = -rings; dr <= rings; ++dr)
    for (std::int64_t dc = -rings; dc <= rings; ++dc) {
      const std::int64_t c = top.column + dc - image.cells.column, r = top.row + dr - image.cells.row;
      const auto ring = static_cast<std::size_t>(std::llround(std::hypot(double(dc), double(dr))));
      if (ring >= sum.size() || !image.bands[0].contains(c, r)) continue;
      const double green = dark_green(image, c, r);
      if (!std::isnan(green)) sum[ring] += green, count[ring] += 1;
    }
  const auto mean = [&](std::size_t ring) { return count[ring] > 0 ? sum[ring] / count[ring] : 0; };
  const double middle = (sum[0] + sum[1]) / std::max(1.0, count[0] + count[1]);
  double before = middle;
  for (std::size_t ring = 1; ring < sum.size(); ++ring) {
    const double here = mean(ring);
    if (here < middle / 2) {  // interpolates the half value between the two rings
      const double part = before > here ? (before - middle / 2) / (before - here) : 0;
      return std::clamp(2 * (double(ring) - 1 + part) * image.cell, 2 * image.cell, kMaxCrownDiameter);
    }
    before = here;
  }
  return kMaxCrownDiameter;
}

bool crown_is_green(const pipeline::ColourWindow& image, const pipeline::CanopyCell& top) {
  const bool infrared = image.bands.size() > 3;
  double sum = 0;
  int count = 0;
  for (std::int64_t r = top.row - image.cells.row - 1; r <= top.row - image.cells.row + 1; ++r)
    for (std::int64_t c = top.column - image.cells.column - 1; c <= top.column - image.cells.column + 1;
         ++c) {
      if (!image.bands[0].contains(c, r) || std::isnan(image.bands[0](c, r))) continue;
      const auto band = [&](std::size_t b) { return double(image.bands[b](c, r)); };
      const double red = band(0), green = band(1), blue = band(2);
      sum += infrared ? (band(3) - red) / std::max(band(3) + red, 0.04)
                      : (2 * green - red - blue) / std::max(red + green + blue, 0.06);
      ++count;
    }
  return count > 0 && pipeline::is_vegetation(sum / count, infrared);
}

std::vector<DetectedCrown> detect_crowns(const ColourImage& image, const pipeline::DenseNetwork& network,
                                         int threads, const pipeline::ProgressMeter::Listener& progress) {
  const CrownCanopy canopy(image, network);
  const pipeline::TreeSearch search = crown_search();
  const std::vector<pipeline::Tile> tiles = importers::tiles_of(image.columns(), image.rows(), kSide);
  std::vector<std::vector<DetectedCrown>> parts(tiles.size());
  const auto reach = static_cast<std::int64_t>(std::ceil(kMaxCrownDiameter / image.cell())) + 1;
  pipeline::ProgressMeter meter(progress, "search_image", static_cast<std::int64_t>(tiles.size()));
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t i) {
      const std::vector<pipeline::DetectedTree> found = pipeline::find_trees(canopy, tiles[i].cells, search);
      pipeline::ColourWindow seen;
      if (!found.empty()) seen = image.read(pipeline::expand(tiles[i].cells, reach));
      for (const pipeline::DetectedTree& tree : found)
        parts[i].push_back({image.pixel(tree.top.column), image.pixel(tree.top.row),
                            crown_width(seen, tree.top), calibrated(tree.height),
                            crown_is_green(seen, tree.top)});
      meter.add(1);
    });
  });
  meter.finish();
  std::vector<DetectedCrown> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace waymark::workflows
