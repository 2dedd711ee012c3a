// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <cmath>

#include "core/error.hpp"
#include "core/random.hpp"
#include "importers/tables/measured_trees.hpp"
#include "pipeline/forest/allometry_fit.hpp"
#include "tests/importers/raster_maker.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(StemDiameter, IsThatOfTheFormula) {
  const Allometry pine{.form = AllometryForm::height, .a = 2, .b = 1, .sigma = 0.1};
  const auto stem = stem_diameter(pine, 21.3, 0, 0, 0);
  ASSERT_TRUE(stem);
  EXPECT_NEAR(stem->metres, 0.40, 1e-9);
  EXPECT_NEAR(stem->sd, 0.04, 1e-9);
  EXPECT_FALSE(stem_diameter(pine, 1.2, 0, 0, 0));
  const auto jucker = stem_diameter(built_in_allometry()[0], 20, 0, 5, 0);
  ASSERT_TRUE(jucker);
  EXPECT_NEAR(jucker->metres, 0.557 * std::pow(100, 0.809) * std::exp(0.237 * 0.237 / 2) / 100, 1e-9);
  EXPECT_FALSE(stem_diameter(built_in_allometry()[0], 20, 0, 0, 0)) << "no crown";
}

TEST(AllometryTable, IsReadAsItIsWritten) {
  const std::vector<Allometry> table{
      {.species = "all", .a = 1.5, .b = 1.1, .sigma = 0.2, .trees = 50, .source = "x"},
      {.species = "PIAB", .form = AllometryForm::height_crown, .a = 0.5, .b = 0.8, .sigma = 0.1}};
  const auto read = parse_allometry(allometry_as_csv(table), "t.csv");
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[1].species, "PIAB");
  EXPECT_EQ(read[1].form, AllometryForm::height_crown);
  EXPECT_DOUBLE_EQ(read[0].a, 1.5);
  EXPECT_EQ(allometry_of(read, "piab"), &read[1]);
  EXPECT_EQ(allometry_of(read, "unknown"), &read[0]);
}

TEST(AllometryTable, SaysWhatIsWrongInWhichLine) {
  EXPECT_THAT(message_of([] { parse_allometry("species,form,a,b,sigma\nall,heigth,1,1,0.1\n", "t.csv"); }),
              AllOf(HasSubstr("the form is 'heigth'"), HasSubstr("t.csv, line 2")));
  EXPECT_THAT(message_of([] { parse_allometry("species,form,a,b,sigma\nall,height,x,1,0.1\n", "t.csv"); }),
              HasSubstr("'x' is no number for a"));
  EXPECT_THAT(message_of([] { parse_allometry("species,form,a,b,sigma\n", "t.csv"); }), HasSubstr("no rows"));
}

TEST(AllometryFit, FindsTheCurveAndSaysHowFarItErrs) {
  Random random(1, "fit");
  std::vector<MeasuredTree> trees;
  for (int i = 0; i < 400; ++i) {
    MeasuredTree tree{.species = i % 2 ? "PIAB" : "FASY", .height = 5 + 25 * random.uniform()};
    const double a = i % 2 ? 1.2 : 0.9;
    tree.diameter = a * std::pow(tree.height - 1.3, 1.1) * (1 + 0.2 * (random.uniform() - 0.5));
    tree.plot = std::to_string(i / 10);
    trees.push_back(tree);
  }
  const auto table = fit_allometry(trees);
  ASSERT_EQ(table.size(), 3U);
  EXPECT_EQ(table[0].species, "all");
  EXPECT_NEAR(table[2].a, 1.2, 0.1);
  EXPECT_NEAR(table[2].b, 1.1, 0.03);
  EXPECT_LT(table[2].rmse, table[2].held_out_rmse);
  EXPECT_LT(table[2].held_out_rmse, table[0].held_out_rmse);
  EXPECT_NEAR(table[2].sigma, 0.2 / std::sqrt(12.0), 0.01);
}

TEST(AllometryFit, TakesCrownsWhereTheyTellMore) {
  Random random(2, "crowns");
  std::vector<MeasuredTree> trees;
  for (int i = 0; i < 100; ++i) {
    MeasuredTree tree{.height = 10 + 10 * random.uniform(), .crown = 2 + 6 * random.uniform()};
    tree.diameter = 0.6 * std::pow(tree.height * tree.crown, 0.8) * (1 + 0.1 * (random.uniform() - 0.5));
    trees.push_back(tree);
  }
  const auto table = fit_allometry(trees);
  EXPECT_EQ(table[0].form, AllometryForm::height_crown);
  EXPECT_NEAR(table[0].b, 0.8, 0.03);
}

TEST(MeasuredTrees, AreFoundByTheNamesInUse) {
  const auto file = write_text(
      "t.csv", "plotID,taxonID,DBH,H\n1,PIAB,24.7,21.9\n1,PIAB,NA,20\n2,FASY,0,10\n2,FASY,31,25\n");
  const importers::MeasuredTrees read = importers::read_measured_trees(file, {});
  ASSERT_EQ(read.trees.size(), 2U);
  EXPECT_EQ(read.skipped_rows, 2);
  EXPECT_EQ(read.trees[1].species, "FASY");
  EXPECT_DOUBLE_EQ(read.trees[0].diameter, 24.7);
  const auto metres = write_text("m.csv", "height,dbh\n21.9,0.247\n25,0.31\n");
  EXPECT_NEAR(importers::read_measured_trees(metres, {}).trees[0].diameter, 24.7, 1e-9);
  EXPECT_THAT(message_of([&] { importers::read_measured_trees(file, {.height = "hoehe"}); }),
              HasSubstr("no column 'hoehe'"));
  const auto none = write_text("n.csv", "a,b\n1,2\n");
  EXPECT_THAT(message_of([&] { importers::read_measured_trees(none, {}); }),
              AllOf(HasSubstr("no column of the table is a height"), HasSubstr("--height")));
}

}  // namespace
}  // namespace waymark::test
