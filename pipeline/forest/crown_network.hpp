// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/forest/crown_evidence.hpp"
#include "pipeline/vision/dense_network.hpp"
namespace waymark {

/// The networks that are shipped: for images with near infrared and for plain colour. Trained by
/// `waymark train trees` on the NAIP crops of Eureka, California (Ventura et al. 2022, CC BY 4.0).
const DenseNetwork& crown_network_infrared();
const DenseNetwork& crown_network_colour();

/// How probably the middle of a crown is at each of the cells `wanted`, smoothed by 0.9 m: a canopy whose
/// local maxima are trees. `image` reaches crown_probability_reach() around `wanted` where there is an image;
/// NaN where it is not known. Bitwise the same for any window.
Grid<float> crown_probability(const ColourWindow& image, const Window& wanted, const DenseNetwork& network);

std::int64_t crown_probability_reach(double cell);

/// A tree that somebody marked, in pixels of the image: (0, 0) is the centre of the first.
struct MarkedTree {
  double x = 0, y = 0;
};

/// Adds pixels of an image whose trees are all marked, with the probability each should get: a bell of 1.2 m
/// around every tree. Pixels far from trees are drawn more seldom. The image is also shown in other light
/// (exposure, tint and contrast drawn at random) `variants` times.
void add_crown_examples(NetworkExamples& examples, const ColourWindow& image,
                        const std::vector<MarkedTree>& trees, int variants, std::uint64_t seed);

}  // namespace waymark
