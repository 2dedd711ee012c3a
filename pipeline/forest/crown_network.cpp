// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/crown_network.hpp"

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "pipeline/forest/canopy_window.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kSmoothing = 0.9;  // metres
constexpr double kBell = 1.2;       // metres: about the precision of annotated crown centres
// Fractions of the pixels near and far from trees that are used for training.
constexpr double kNearKept = 0.6, kFarKept = 0.12;

/// Target probability of each pixel.
Grid<float> target_probability(const ColourWindow& image, const std::vector<MarkedTree>& trees) {
  Grid<float> wanted(image.cells.columns, image.cells.rows);
  for (std::int64_t r = 0; r < wanted.rows(); ++r)
    for (std::int64_t c = 0; c < wanted.columns(); ++c)
      for (const MarkedTree& tree : trees) {
        const double away =
            std::hypot(tree.x - double(c + image.cells.column), tree.y - double(r + image.cells.row)) *
            image.cell / kBell;
        if (away < 4) wanted(c, r) = std::max(wanted(c, r), static_cast<float>(std::exp(-away * away / 2)));
      }
  return wanted;
}

/// The scene with random exposure, tint and contrast.
ColourWindow augment_light(ColourWindow image, Random& random) {
  const double exposure = random.normal(0, 0.15), contrast = std::exp(random.normal(0, 0.12));
  for (Grid<float>& band : image.bands) {
    const double gain = std::exp(exposure + random.normal(0, 0.06));
    for (float& value : band.cells())
      value = static_cast<float>(std::pow(std::clamp(double(value) * gain, 0.0, 1.0), contrast));
  }
  return image;
}

}  // namespace

std::string crown_network_as_text(const DenseNetwork& network) {
  return as_text(network, "crowns");
}

DenseNetwork parse_crown_network(std::string_view text, const std::string& where) {
  return parse_dense_network(text, "crowns", where);
}

std::int64_t crown_probability_reach(double cell) {
  return crown_evidence_reach(cell) + smoothing_reach(kSmoothing, cell);
}

Grid<float> crown_probability(const ColourWindow& image, const Window& wanted, const DenseNetwork& network) {
  const std::vector<Grid<float>> evidence = crown_evidence(image);
  CanopyWindow odds{image.cells, Grid<float>(image.cells.columns, image.cells.rows), image.cell, image.cell};
  std::vector<const float*> inputs;
  for (const Grid<float>& plane : evidence) inputs.push_back(plane.cells().data());
  evaluate(network, inputs, odds.heights.cells());
  for (float& value : odds.heights.cells())
    value = std::isnan(value) ? kNoCanopy : 1 / (1 + std::exp(-value));
  const CanopyWindow smooth = smooth_canopy(odds, kSmoothing);
  Grid<float> probability(wanted.columns, wanted.rows, std::nanf(""));
  for (std::int64_t r = 0; r < wanted.rows; ++r)
    for (std::int64_t c = 0; c < wanted.columns; ++c)
      if (const CanopyCell cell{wanted.column + c, wanted.row + r};
          smooth.contains(cell) && smooth.at(cell) != kNoCanopy)
        probability(c, r) = smooth.at(cell);
  return probability;
}

void add_crown_examples(NetworkExamples& examples, const ColourWindow& image,
                        const std::vector<MarkedTree>& trees, int variants, std::uint64_t seed) {
  Random random(seed, "crown examples");
  const Grid<float> wanted = target_probability(image, trees);
  const double fraction = variants > 0 ? 1.6 / (variants + 1) : 1;
  for (int variant = 0; variant <= variants; ++variant) {
    const std::vector<Grid<float>> evidence =
        crown_evidence(variant == 0 ? image : augment_light(image, random));
    examples.inputs = static_cast<int>(evidence.size());
    for (std::size_t i = 0; i < wanted.cells().size(); ++i) {
      const bool near = wanted.cells()[i] > 0.05F;
      if (!random.bernoulli(fraction * (near ? kNearKept : kFarKept)) || std::isnan(evidence[0].cells()[i]))
        continue;
      for (const Grid<float>& plane : evidence) examples.values.push_back(plane.cells()[i]);
      examples.targets.push_back(wanted.cells()[i]);
    }
  }
}

}  // namespace waymark::pipeline
