// SPDX-License-Identifier: Apache-2.0
// Whether the standard errors of an inventory from the air are as large as its errors: ten simulated forests
// with seeds that the recall was not fitted to.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "importers/tables/table.hpp"
#include "workflows/forest/inventory.hpp"
#include "workflows/mapping/make_map.hpp"
#include "workflows/simulation/simulate.hpp"

namespace waymark::test {
namespace {

namespace fs = std::filesystem;

struct Forest {
  double conifers;
  int density;
  const char* pattern;
};

struct Truth {
  double stems = 0, basal_area = 0;  ///< of the whole forest; m2
};

Truth true_sums(const fs::path& table) {
  const auto trees = importers::open_table(table.string(), importers::TableFormat::csv, "", "");
  const auto& columns = trees->header().columns;
  const auto diameter = static_cast<std::size_t>(std::ranges::find(columns, "diameter") - columns.begin());
  Truth sums;
  importers::TableRow row;
  while (trees->next(row)) {
    const double metres = std::stod(row.cells.at(diameter));
    ++sums.stems;
    sums.basal_area += std::numbers::pi / 4 * metres * metres;
  }
  return sums;
}

TEST(InventoryCoverage, NinetyPercentIntervalsHoldTheTruth) {
  constexpr Forest kForests[] = {{1, 250, "poisson"},   {1, 500, "clustered"}, {1, 900, "rows"},
                                 {0.5, 250, "rows"},    {0.5, 500, "poisson"}, {0.5, 900, "clustered"},
                                 {0, 250, "clustered"}, {0, 500, "rows"},      {0, 900, "poisson"},
                                 {0.7, 400, "poisson"}};
  constexpr double kNinetyPercent = 1.645;  // standard errors
  const fs::path folder = fs::temp_directory_path() / ("waymark_coverage_" + std::to_string(::getpid()));
  int held = 0, intervals = 0, seed = 7000;
  double relative_errors = 0;
  for (const Forest& forest : kForests) {
    fs::create_directories(folder);
    std::ofstream(folder / "scenario.json")
        << R"({"waymark_scenario": 1, "crs": "EPSG:32632", "ground": {"cell": 1, "east": 440000, "north": 5400000},)"
        << R"("relief": {"rms": 4, "max_wavelength": 150, "slope": 0.12}, "seed": )" << ++seed
        << R"(, "forest": {"width": 100, "height": 100, "stands": 1, "understory": 120, "conifers": )"
        << forest.conifers << R"(, "density": )" << forest.density << R"(, "density_to": )" << forest.density
        << R"(, "pattern": ")" << forest.pattern << R"("}})";
    workflows::simulate(
        {.scenario = (folder / "scenario.json").string(), .folder = (folder / "made").string()});
    const std::string map = (folder / "trees.gpkg").string();
    workflows::make_map(workflows::load_job(folder / "made/job.json"), {.map = map});
    workflows::InventoryRequest request;
    request.map = map;
    const workflows::InventoryResult result = workflows::inventory(request);
    ASSERT_EQ(result.stands.size(), 1u);
    const pipeline::StandAttributes& found = result.stands[0].complete;
    const Truth truth = true_sums(folder / "made/truth/landmarks.csv");
    for (const auto& [estimate, sum] :
         {std::pair(found.stems, truth.stems), {found.basal_area, truth.basal_area}}) {
      const double error = std::abs(estimate.value - sum / found.hectares);
      held += error < kNinetyPercent * estimate.se;
      relative_errors += estimate.se / estimate.value;
      ++intervals;
      EXPECT_LT(error, 4 * estimate.se) << forest.conifers << " " << forest.density << " " << forest.pattern;
    }
    fs::remove_all(folder);
  }
  RecordProperty("held", held);
  EXPECT_GE(held, 17) << "of " << intervals;
  EXPECT_LT(relative_errors / intervals, 0.8) << "errors that say nothing";
}

}  // namespace
}  // namespace waymark::test
