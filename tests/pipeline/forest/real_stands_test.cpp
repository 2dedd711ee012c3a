// SPDX-License-Identifier: Apache-2.0
// Plots whose trees and figures somebody measured; the data stay outside the repository
// (docs/evaluation/2026-11-21-inventory-checks.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "core/text_file.hpp"
#include "pipeline/forest/stand_inventory.hpp"

namespace waymark::test {
namespace {

std::filesystem::path forest_data() {
  return std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/forest";
}

std::vector<std::map<std::string, std::string>> table(const std::filesystem::path& path) {
  std::istringstream file(read_text(path, "the table"));
  std::vector<std::string> names;
  std::vector<std::map<std::string, std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    std::vector<std::string> cells;
    std::istringstream parts(line);
    for (std::string cell; std::getline(parts, cell, ',');) {
      std::erase(cell, '"');
      std::erase(cell, '\r');
      cells.push_back(cell);
    }
    if (names.empty()) {
      names = cells;
      continue;
    }
    for (std::size_t i = 0; i < cells.size() && i < names.size(); ++i) {
      if (i == 0) rows.emplace_back();
      rows.back()[names[i]] = cells[i];
    }
  }
  return rows;
}

TEST(RealStands, StemsAndBasalAreaAreThePublishedOnes) {
  const auto path = forest_data() / "lmfor/spati.csv";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not on this machine";
  struct Plot {
    double width = 0, height = 0, stems = 0, basal_area = 0;
    std::vector<pipeline::StandTree> trees;
  };
  std::map<std::string, Plot> plots;
  for (const auto& row : table(path)) {
    Plot& plot = plots[row.at("plot")];
    plot.width = std::stod(row.at("X")) / 10;
    plot.height = std::stod(row.at("Y")) / 10;
    plot.stems = std::stod(row.at("N"));
    plot.basal_area = std::stod(row.at("G"));
    // A few stems were measured just outside the frame and belong to it: drawn in, they stand on its edge.
    const double x = std::clamp(std::stod(row.at("xk")) / 10, 0.0, plot.width - 0.01),
                 y = std::clamp(std::stod(row.at("yk")) / 10, 0.0, plot.height - 0.01);
    plot.trees.push_back({.position = {x, y}, .height = 15, .diameter = std::stod(row.at("d")) / 100});
  }
  ASSERT_EQ(plots.size(), 66u);
  int complete = 0;
  for (const auto& [name, plot] : plots) {
    const pipeline::StandPolygon stand{
        {{{0, 0}, {plot.width, 0}, {plot.width, plot.height}, {0, plot.height}}}};
    const pipeline::StandAttributes f = pipeline::inventory(plot.trees, stand);
    EXPECT_EQ(static_cast<std::size_t>(f.trees), plot.trees.size()) << name;
    // Some lists lack trees the published figures have.
    if (std::abs(static_cast<double>(plot.trees.size()) - plot.stems * f.hectares) > 0.5) continue;
    ++complete;
    EXPECT_NEAR(f.stems.value, plot.stems, 0.011) << name;
    EXPECT_NEAR(f.basal_area.value, plot.basal_area, 0.0051) << name;  // published with two decimals
  }
  EXPECT_GE(complete, 20);
  RecordProperty("complete_plots", complete);
}

TEST(RealStands, ThePlotsOfQuatreMontagnesFitTheDefinitions) {
  const auto path = forest_data() / "quatre_montagnes/quatre_montagnes.csv";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not on this machine";
  int plots = 0;
  for (const auto& row : table(path)) {
    const double g = std::stod(row.at("G_m2_ha")), n = std::stod(row.at("N_ha"));
    EXPECT_GE(200 * std::sqrt(g / n / std::numbers::pi), std::stod(row.at("D_mean_cm"))) << row.at("plot_id");
    ++plots;
  }
  EXPECT_EQ(plots, 96);
}

TEST(RealStands, TheBuiltInFormFactorIsWithinTwoErrorsForPines) {
  const auto path = forest_data() / "lmfor/alsTree.csv";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not on this machine";
  double measured = 0, reported = 0;
  for (const auto& row : table(path)) {
    measured += std::stod(row.at("V"));
    reported += pipeline::stem_volume(pipeline::built_in_volume()[0], std::stod(row.at("DBH")) / 100,
                                      std::stod(row.at("H")));
  }
  EXPECT_NEAR(
      reported / measured, 1,
      2.2 * pipeline::built_in_volume()[0].form_factor_sd / pipeline::built_in_volume()[0].form_factor);
}

}  // namespace
}  // namespace waymark::test
