// SPDX-License-Identifier: Apache-2.0
// Craters that people marked, by the protocol of docs/evaluation/2026-11-22-crater-detection.md. The
// thresholds are the program's own. HRSC tile 1_24 served to set four constants (bowl_verification.cpp); the
// NAC images and the eastern half of the GLD100 piece were only measured. The data stay outside the
// repository.
#include <gmock/gmock.h>

#include <filesystem>
#include <sstream>

#include "core/text_file.hpp"
#include "importers/images/image.hpp"
#include "importers/rasters/dem.hpp"
#include "pipeline/craters/dem_blocks.hpp"
#include "pipeline/craters/find_craters.hpp"
#include "tests/pipeline/craters/score_circles.hpp"

namespace waymark::test {
using namespace pipeline;
namespace {

std::filesystem::path crater_data() {
  return std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/craters";
}

#define SKIP_WITHOUT_CRATER_DATA() \
  if (!std::filesystem::exists(crater_data())) GTEST_SKIP() << crater_data() << " is not on this machine"

std::vector<std::vector<double>> numbers_of(const std::filesystem::path& path, bool header) {
  std::istringstream file(read_text(path, "the catalogue"));
  std::vector<std::vector<double>> rows;
  std::string line;
  if (header) std::getline(file, line);
  while (std::getline(file, line)) {
    auto& row = rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::strtod(cell.c_str(), nullptr));
  }
  return rows;
}

Pixels pixels_of(const std::filesystem::path& path) {
  const auto image = importers::import_image(path.string());
  return image->read({0, 0, image->info().columns, image->info().rows});
}

std::vector<CraterCandidate> circles(const std::vector<Detection>& found) {
  std::vector<CraterCandidate> all;
  for (const Detection& d : found)
    all.push_back({d.outline.x, d.outline.y, d.outline.diameter(), d.confidence});
  return all;
}

std::vector<CraterCandidate> hrsc_truth() {
  std::vector<CraterCandidate> truth;
  for (const auto& row : numbers_of(crater_data() / "hrsc/1_24_gt.csv", false))
    truth.push_back({row[0], row[1], row[2], 1});
  return truth;
}

TEST(RealCraters, HrscTile) {
  SKIP_WITHOUT_CRATER_DATA();
  const Pixels image = pixels_of(crater_data() / "hrsc/tile1_24.pgm");
  const auto found = circles(find_craters(image, {}));
  const auto truth = hrsc_truth();
  const CircleScore score = score_circles(found, truth, 16);
  for (const auto& [low, high] : {std::pair{8.0, 12.0}, {12.0, 16.0}, {16.0, 32.0}, {32.0, 1e9}})
    std::cout << "HRSC 1_24, " << low << " to " << high
              << " px: " << score_circles(found, truth, low, high).text() << '\n';
  std::cout << "HRSC 1_24, D >= 16: " << score.text() << '\n'
            << "HRSC 1_24, DeepMoon's rule: " << score_circles(found, truth, 16, 1e9, Match::deepmoon).text()
            << '\n';
  EXPECT_GE(score.f1, 0.78);
  EXPECT_LE(score.centre, 0.075);
  EXPECT_LE(score.size, 0.065);
  EXPECT_LE(std::abs(score.bias), 0.025);
}

TEST(RealCraters, ProbabilitiesAreThoseOfMarkedCraters) {
  SKIP_WITHOUT_CRATER_DATA();
  const Pixels image = pixels_of(crater_data() / "hrsc/tile1_24.pgm");
  const double error =
      calibration_error(circles(find_craters(image, {.min_confidence = 0.02})), hrsc_truth(), 16);
  std::cout << "HRSC 1_24, expected calibration error: " << error << '\n';
  EXPECT_LE(error, 0.055);
}

TEST(RealCraters, ASecondOpinionSharpensThem) {
  SKIP_WITHOUT_CRATER_DATA();
  const Pixels image = pixels_of(crater_data() / "hrsc/tile1_24.pgm");
  const auto truth = hrsc_truth();
  const auto f1 = [&](const CraterSearch& search) {
    return score_circles(circles(find_craters(image, search)), truth, 16).f1;
  };
  const auto error = [&](const CraterSearch& search) {
    return calibration_error(circles(find_craters(image, search)), truth, 16);
  };
  EXPECT_GE(f1({}), f1({.second_opinion = false}) + 0.01);
  EXPECT_LT(error({.min_confidence = 0.02}), error({.min_confidence = 0.02, .second_opinion = false}));
}

TEST(RealCraters, HrscTileWithoutModelAndByEdges) {
  SKIP_WITHOUT_CRATER_DATA();
  const Pixels image = pixels_of(crater_data() / "hrsc/tile1_24.pgm");
  const CircleScore untrained =
      score_circles(circles(find_craters(image, {.verify = false})), hrsc_truth(), 16);
  const CircleScore edges =
      score_circles(circles(find_craters(image, {.method = CraterMethod::edges})), hrsc_truth(), 16);
  std::cout << "untrained: " << untrained.text() << "\nedges: " << edges.text() << '\n';
  EXPECT_GE(untrained.f1, 0.72);
  EXPECT_GE(edges.f1, 0.2);
}

/// Returns the mean F1 of images of LROC NAC.
double lunar_f1(std::initializer_list<const char*> names) {
  double sum = 0;
  for (const char* name : names) {
    const auto base = crater_data() / "lronac/train" / (std::string(name) + "_mosaic_train_small");
    std::vector<CraterCandidate> truth;
    for (const auto& row : numbers_of(base.string() + ".txt", true))
      if (row.size() >= 5)
        truth.push_back({row[1] + row[3] / 2 - 0.5, row[2] + row[4] / 2 - 0.5, (row[3] + row[4]) / 2, 1});
    const CircleScore score =
        score_circles(circles(find_craters(pixels_of(base.string() + ".png"), {})), truth, 16);
    std::cout << name << ": " << score.text() << '\n';
    sum += score.f1;
  }
  return sum / static_cast<double>(names.size());
}

TEST(RealCraters, LunarImages) {
  SKIP_WITHOUT_CRATER_DATA();
  EXPECT_GE(lunar_f1({"M115143943", "M1229577647", "M1266003170", "M180000082"}), 0.77);
}

TEST(RealCraters, OtherLunarImages) {
  SKIP_WITHOUT_CRATER_DATA();
  const double f1 = lunar_f1({"M1155395732", "M1183658592", "M1231933714", "M1275410097", "M134022629",
                              "M161142858", "M161149639", "M180007222"});
  std::cout << "mean: F1 " << f1 << '\n';
  EXPECT_GE(f1, 0.73);
}

TEST(RealCraters, LunarHighlandHeights) {
  SKIP_WITHOUT_CRATER_DATA();
  importers::DemImport import;
  import.files = {(crater_data() / "gld100/highland_e160_200.tif").string()};
  const auto dem = importers::import_dem(import);
  const auto& grid = dem->geometry();
  std::vector<CraterCandidate> found, truth;
  const std::int64_t half = grid.columns / 2;  // the western half set the constants
  for (const Observation& o : survey_craters(*dem, {half, 0, grid.columns - half, grid.rows}, {}))
    found.push_back({o.pixel->x(), o.pixel->y(), 2 * o.features[0].value / 473.8, o.confidence});
  for (const auto& row : numbers_of(crater_data() / "gld100/highland_e160_200_gt.csv", true))
    if (row[0] >= double(half)) truth.push_back({row[0], row[1], row[2], 1});
  const CircleScore score = score_circles(found, truth, 10.5, 80);
  std::cout << "GLD100 highland, eastern half: " << score.text() << '\n';
  EXPECT_GE(score.f1, 0.71);
}

}  // namespace
}  // namespace waymark::test
