// SPDX-License-Identifier: Apache-2.0
#include "localization/detectors/column_flanks.hpp"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

namespace waymark::test {
using namespace localization;
namespace {

constexpr double kStep = 0.005;  // rad between columns
constexpr double kRange = 20;    // m of the column

// Ranges of a column of three layers and its neighbours, from left to right: 'o' the column, 'n' 5 m nearer,
// 'c' 1 m nearer (closely), 'b' 10 m behind, 's' 2 m behind (set back), '.' no return.
double fraction(std::initializer_list<std::string_view> rows, double step = kStep) {
  std::vector<Eigen::Vector3f> points;
  std::vector<ColumnLayer> layers;
  double slope = -0.06;
  for (const std::string_view row : rows) {
    const double middle = 0.5 * static_cast<double>(row.size() - 1);
    const auto bearing = [&](std::size_t i) { return kStep * (middle - static_cast<double>(i)); };
    for (std::size_t i = 0; i < row.size(); ++i) {
      const char c = row[i];
      if (c == '.') continue;
      const double range = kRange + (c == 'n' ? -5 : c == 'c' ? -1 : c == 'b' ? 10 : c == 's' ? 2 : 0);
      points.emplace_back(static_cast<float>(range * std::cos(1 + bearing(i))),
                          static_cast<float>(range * std::sin(1 + bearing(i))),
                          static_cast<float>(range * slope));
    }
    layers.push_back(
        {.right = bearing(row.rfind('o')), .left = bearing(row.find('o')), .low = slope, .high = slope});
    slope += 0.02;
  }
  return cut_off_fraction(layers, CloudBearings(points), 1, kRange, step);
}

TEST(ColumnFlanks, OfAPoleShowItsBackground) {
  EXPECT_EQ(fraction({"bbboobbb", "...oo...", "sssoobbb"}), 0);
}

TEST(ColumnFlanks, OfAGapAreNearer) {
  EXPECT_EQ(fraction({"nnnoonnn", "nnnoonnn", "nnnoonnn"}), 1);
  EXPECT_EQ(fraction({"nnnoonnn", "bbboobbb", "bbboobbb"}), 1.0 / 3) << "a car before the foot of a pole";
}

TEST(ColumnFlanks, MayHideAHalf) {
  EXPECT_EQ(fraction({"nnnoobbb", "bbboonnn", "nnnoobbb"}), 0);
  EXPECT_EQ(fraction({"nnnoo...", "...oonnn", "nnnoo..."}), 1) << "nothing shows that it ends";
}

TEST(ColumnFlanks, OfAWallAtAFlatAngleAreNearerAndFartherPieces) {
  EXPECT_EQ(fraction({"cccooss", "cccooss", "cccooss"}), 1);
  EXPECT_EQ(fraction({"cccoobb", "cccoobb", "cccoobb"}), 1) << "its end";
  EXPECT_EQ(fraction({"nnnooss", "nnnooss", "nnnooss"}), 1) << "the next house is set back";
}

TEST(ColumnFlanks, AreAsNearAsThreeColumns) {
  EXPECT_EQ(fraction({"nbboobbn", "nbboobbn", "nbboobbn"}), 0);
  EXPECT_EQ(fraction({"nboobn", "nboobn", "nboobn"}), 1);
}

TEST(ColumnFlanks, AreUnknownWithoutColumns) {
  EXPECT_EQ(fraction({"nnnoonnn"}, 0), 0);
  EXPECT_EQ(cut_off_fraction({}, CloudBearings({}), 0, 1, kStep), 0);
}

}  // namespace
}  // namespace waymark::test
