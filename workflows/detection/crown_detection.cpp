// SPDX-License-Identifier: Apache-2.0
#include "workflows/detection/crown_detection.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "importers/tiling.hpp"
#include "pipeline/forest/crown_network.hpp"
#include "pipeline/forest/crown_width.hpp"
#include "pipeline/forest/find_trees.hpp"

namespace waymark::workflows {
namespace {

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

std::vector<DetectedCrown> detect_crowns(const ColourImage& image, const pipeline::DenseNetwork& network,
                                         int threads, const pipeline::ProgressMeter::Listener& progress) {
  const CrownCanopy canopy(image, network);
  const pipeline::TreeSearch search = crown_search();
  const std::vector<pipeline::Tile> tiles = importers::tiles_of(image.columns(), image.rows(), kSide);
  std::vector<std::vector<DetectedCrown>> parts(tiles.size());
  const auto reach = static_cast<std::int64_t>(std::ceil(pipeline::kMaxCrownDiameter / image.cell())) + 1;
  pipeline::ProgressMeter meter(progress, "search_image", static_cast<std::int64_t>(tiles.size()));
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, tiles.size(), [&](std::size_t i) {
      const std::vector<pipeline::DetectedTree> found = pipeline::find_trees(canopy, tiles[i].cells, search);
      pipeline::ColourWindow seen;
      if (!found.empty()) seen = image.read(pipeline::expand(tiles[i].cells, reach));
      for (const pipeline::DetectedTree& tree : found)
        parts[i].push_back({image.pixel(tree.top.column), image.pixel(tree.top.row),
                            pipeline::crown_width(seen, tree.top), calibrated(tree.height)});
      meter.add(1);
    });
  });
  meter.finish();
  std::vector<DetectedCrown> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace waymark::workflows
