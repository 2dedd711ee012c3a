// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/forest/crown_evidence.hpp"
#include "pipeline/vision/dense_network.hpp"
namespace waymark::pipeline {

/// Return the shipped networks, for images with near infrared and for plain colour. Trained by `waymark
/// train trees` on the NAIP crops of Eureka, California (Ventura et al. 2022, CC BY 4.0).
const DenseNetwork& crown_network_infrared();
const DenseNetwork& crown_network_colour();

/// Write and read a network as text of kind `crowns`. Throws Error{input} that names `where`.
std::string crown_network_as_text(const DenseNetwork& network);
DenseNetwork parse_crown_network(std::string_view text, const std::string& where);

/// Returns the probability of a crown centre at each of the cells `wanted`, smoothed by 0.9 m; its local
/// maxima are trees. `image` covers crown_probability_reach() around `wanted` where there is an image; NaN
/// where it is unknown. Bitwise the same for any window.
Grid<float> crown_probability(const ColourWindow& image, const Window& wanted, const DenseNetwork& network);

std::int64_t crown_probability_reach(double cell);

/// Annotated tree, in pixels of the image: (0, 0) is the centre of the first pixel.
struct MarkedTree {
  double x = 0, y = 0;
};

/// Adds pixels of an image whose trees are all annotated, with target probabilities: a Gaussian of 1.2 m
/// around every tree. Pixels far from trees are sampled less often. `variants` copies with random exposure,
/// tint and contrast augment the data.
void add_crown_examples(NetworkExamples& examples, const ColourWindow& image,
                        const std::vector<MarkedTree>& trees, int variants, std::uint64_t seed);

}  // namespace waymark::pipeline
