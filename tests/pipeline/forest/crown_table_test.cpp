// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/crown_table.hpp"

#include <gtest/gtest.h>

#include "synthetic_canopy.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

/// What a crown is on the map, straight from the tree.
CrownShape plainly(const DetectedTree& tree, const CanopySource& canopy) {
  const Georeference& where = canopy.geometry().where;
  CrownShape shape;
  shape.source = canopy.name();
  shape.top = {where.x(static_cast<double>(tree.top.column)), where.y(static_cast<double>(tree.top.row))};
  shape.height = tree.height;
  shape.area = tree.crown_area;
  shape.diameter = tree.crown_diameter;
  for (const CanopyCell& corner : tree.crown.ring)
    shape.ring.emplace_back(where.x(static_cast<double>(corner.column) - 0.5),
                            where.y(static_cast<double>(corner.row) - 0.5));
  return shape;
}

void expect_same(const CrownShape& a, const CrownShape& b) {  // bit for bit
  EXPECT_EQ(a.uid, b.uid);
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.top, b.top);
  EXPECT_EQ(a.ring, b.ring);
  EXPECT_EQ(a.height, b.height);
  EXPECT_EQ(a.area, b.area);
  EXPECT_EQ(a.diameter, b.diameter);
}

TEST(CrownTable, GivesBackWhatWasPutIn) {
  Grid<float> block(200, 200, 0);  // with sides of 100 cells: steps of more than a byte
  for (std::int64_t r = 50; r < 150; ++r)
    for (std::int64_t c = 50; c < 150; ++c) block(c, r) = 20;
  for (const SyntheticCanopy& canopy : {synthetic_forest(3, 160, 60), SyntheticCanopy(block, 0.05)}) {
    TreeSearch search;
    search.forest.tops.min_height = 2;
    const std::vector<DetectedTree> trees = find_trees(canopy, canopy.all(), search);
    ASSERT_GE(trees.size(), 1U);
    CrownTable table, named;
    const std::uint32_t survey = table.add_survey(canopy);
    for (const DetectedTree& tree : trees) table.add(survey, tree);
    ASSERT_EQ(table.size(), trees.size());
    const CrownTable read = Codec<CrownTable>::decode(Codec<CrownTable>::encode(table));
    for (std::size_t i = 0; i < trees.size(); ++i) {
      CrownShape wanted = plainly(trees[i], canopy);
      ASSERT_GE(wanted.ring.size(), 4U);
      EXPECT_TRUE(table.has_outline(i));
      expect_same(table.at(i), wanted);
      expect_same(read.at(i), wanted);
      wanted.uid = "tr-" + std::to_string(i);
      named.add(read, i, wanted.uid);
      expect_same(named.at(i), wanted);
    }
  }
}

TEST(CrownTable, CrownsThatWereNotSoughtAreNotDrawn) {
  const SyntheticCanopy canopy = synthetic_forest(4, 60, 9);
  CrownTable table;
  const std::uint32_t survey = table.add_survey(canopy);
  for (const DetectedTree& tree : find_trees(canopy, canopy.all(), {.crowns = false}))
    table.add(survey, tree);
  ASSERT_GT(table.size(), 0U);
  EXPECT_FALSE(table.has_outline(0));
  EXPECT_TRUE(table.at(0).ring.empty());
}

TEST(CrownTable, DamagedBytesAreRefused) {
  const SyntheticCanopy canopy = synthetic_forest(5, 60, 9);
  CrownTable table;
  const std::uint32_t survey = table.add_survey(canopy);
  for (const DetectedTree& tree : find_trees(canopy, canopy.all(), {})) table.add(survey, tree);
  const std::string bytes = Codec<CrownTable>::encode(table);
  for (std::size_t size = 0; size < bytes.size(); size += 7)
    EXPECT_THROW(Codec<CrownTable>::decode(std::string_view(bytes).substr(0, size)), std::runtime_error);
}

}  // namespace
}  // namespace waymark::test
