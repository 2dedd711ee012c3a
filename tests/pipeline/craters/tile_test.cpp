// SPDX-License-Identifier: Apache-2.0
// The fast parts of the search against slow twins.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "core/random.hpp"
#include "pipeline/craters/sample.hpp"
#include "pipeline/craters/tile_correlation.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

std::size_t cell(int x, int y) {
  return static_cast<std::size_t>((y & (kTileSide - 1)) * kTileSide + (x & (kTileSide - 1)));
}

ComplexTile random_tile(Random& random, bool complex) {
  ComplexTile tile;
  for (float& v : tile.real) v = static_cast<float>(random.normal());
  if (complex)
    for (float& v : tile.imaginary) v = static_cast<float>(random.normal());
  return tile;
}

TEST(TileSpectrum, ProductsAreCircularConvolutions) {
  Random random(21, "tiles");
  const ComplexTile tile = random_tile(random, true);
  ComplexTile kernel;
  constexpr int reach = 4;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) {
      kernel.real[cell(x, y)] = static_cast<float>(random.normal());
      kernel.imaginary[cell(x, y)] = static_cast<float>(random.normal());
    }
  ComplexTile a = tile, b = kernel, product;
  forward_transform(a), forward_transform(b), inverse_transform_product(a, b, product);
  for (int i = 0; i < 300; ++i) {
    // The corners too, where the tile goes round.
    const int x = i < 4 ? i % 2 * (kTileSide - 1) : static_cast<int>(random.uniform_index(kTileSide)),
              y = i < 4 ? i / 2 * (kTileSide - 1) : static_cast<int>(random.uniform_index(kTileSide));
    double real = 0, imaginary = 0;
    for (int v = -reach; v <= reach; ++v)
      for (int u = -reach; u <= reach; ++u) {
        const std::size_t k = cell(u, v), t = cell(x - u, y - v);
        real += double(tile.real[t]) * kernel.real[k] - double(tile.imaginary[t]) * kernel.imaginary[k];
        imaginary += double(tile.real[t]) * kernel.imaginary[k] + double(tile.imaginary[t]) * kernel.real[k];
      }
    EXPECT_NEAR(product.real[cell(x, y)] / double(ComplexTile::kCells), real, 1e-4);
    EXPECT_NEAR(product.imaginary[cell(x, y)] / double(ComplexTile::kCells), imaginary, 1e-4);
  }
}

TEST(TileCorrelation, AgreesWithTheDefinition) {
  Random random(22, "tiles");
  const ComplexTile responses = random_tile(random, true), tile = random_tile(random, false);
  const TileSums sums(tile.real);
  for (const int half : {1, 6, 15})
    for (const bool two : {false, true}) {
      std::vector<float> squares = responses.real;
      const int margin = half + 1;
      const double floor = 0.5;
      normalise(squares, two ? std::span<const float>(responses.imaginary) : std::span<const float>(), sums,
                half, margin, floor);
      for (int i = 0; i < 200; ++i) {
        const auto place = [&](int k) {  // the first and last that count among them
          return k == 0   ? margin
                 : k == 1 ? kTileSide - margin - 1
                          : margin + static_cast<int>(random.uniform_index(
                                         static_cast<std::uint64_t>(kTileSide - 2 * margin)));
        };
        const int x = place(i % 7), y = place(i / 7);
        double n = 0, sum = 0, sum_of_squares = 0;
        for (int v = -half; v <= half; ++v)
          for (int u = -half; u <= half; ++u) {
            const double value = tile.real[cell(x + u, y + v)];
            ++n, sum += value, sum_of_squares += value * value;
          }
        double response = responses.real[cell(x, y)];
        if (two) response = std::max(response, double(responses.imaginary[cell(x, y)]));
        const double wanted = response * std::abs(response) / (sum_of_squares - sum * sum / n + floor);
        EXPECT_NEAR(squares[cell(x, y)], wanted, 1e-6 + 1e-5 * std::abs(wanted))
            << half << ' ' << x << ' ' << y;
      }
    }
}

TEST(TileCorrelation, RaiseKeepsTheGreater) {
  std::vector<float> values{1, -2, 3, 0, 5, 6, -7, 8};
  take_maximum(values, std::vector<float>{0, -1, 3, 1, 4, 9, -8, 8});
  EXPECT_THAT(values, ::testing::ElementsAre(1, -1, 3, 1, 5, 9, -7, 8));
}

TEST(Sample, InsideTheSame) {
  Random random(23, "samples");
  Pixels image(9, 7);
  for (float& v : image.cells()) v = static_cast<float>(random.normal());
  for (int i = 0; i < 500; ++i) {
    const double x = random.uniform(0, 8), y = random.uniform(0, 6);
    EXPECT_EQ(sample_inside(image.cells().data(), image.columns(), x, y), sample(image, x, y));
  }
  EXPECT_TRUE(is_inside(image, 4, 3, 2.9));
  EXPECT_FALSE(is_inside(image, 4, 3, 3)) << "the last row has none below it";
  EXPECT_FALSE(is_inside(image, 1, 3, 1.5));
}

}  // namespace
}  // namespace waymark::test
