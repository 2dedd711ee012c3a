// SPDX-License-Identifier: Apache-2.0
// Memory and time of merging by cells: `merging_memory OBSERVATIONS [MAX_IN_CELL] [FOLDER]`. Rocks 5 m apart,
// seen five times each on average in eight surveys with errors of 5 to 60 cm; they are made while they are
// read, so the process holds what merging holds. One line per run; the peak is that of the process.
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdlib>

#include "core/random.hpp"
#include "pipeline/fusion/association/merging_by_cells.hpp"

namespace waymark::bench {
namespace {

using namespace pipeline;

constexpr std::uint32_t kSurveys = 8, kBlock = 100;  // a batch: 100 x 100 rocks
constexpr double kSpacing = 5, kRecall = 0.625;

// Rocks of one block, seed and position by its number.
std::vector<Observation> block(std::uint64_t number, std::uint64_t blocks_per_row, TypeId rock) {
  Random random(number + 1, "merging memory");
  const double x0 = kSpacing * kBlock * static_cast<double>(number % blocks_per_row);
  const double y0 = kSpacing * kBlock * static_cast<double>(number / blocks_per_row);
  std::vector<Observation> all;
  for (std::uint32_t i = 0; i < kBlock * kBlock; ++i) {
    const Eigen::Vector2d at(x0 + kSpacing * (i % kBlock + random.uniform(-0.25, 0.25)),
                             y0 + kSpacing * (i / kBlock + random.uniform(-0.25, 0.25)));
    const double radius = random.log_uniform(0.2, 1.0);
    for (std::uint32_t survey = 0; survey < kSurveys; ++survey) {
      if (!random.bernoulli(kRecall)) continue;
      const double sd = 0.05 * std::pow(12, survey / (kSurveys - 1.0));
      Observation o;
      o.type = rock;
      o.source = fmt::format("survey_{}.tif", survey);
      o.pixel = at;
      o.position.xyz << at.x() + random.normal(0, sd), at.y() + random.normal(0, sd), 0;
      o.covariance = Eigen::Matrix3d::Identity() * sd * sd;
      o.confidence = random.uniform(0.3, 1);
      const double seen = radius * std::exp(random.normal(0, 0.1));
      o.features = {{seen, 0.01 * seen * seen, 1}, {seen / 2, 0.01 * seen * seen, 1}};
      all.push_back(std::move(o));
    }
  }
  return all;
}

int run(std::uint64_t observations, const CellRules& cells) {
  TypeRegistry types;
  register_landmark_types(types);
  const auto per_block = static_cast<std::uint64_t>(kBlock * kBlock * kSurveys * kRecall);
  const std::uint64_t blocks = (observations + per_block - 1) / per_block;
  const auto per_row = static_cast<std::uint64_t>(std::ceil(std::sqrt(static_cast<double>(blocks))));
  const auto batches = [&](const auto& take) {
    for (std::uint64_t i = 0; i < blocks; ++i) take(block(i, per_row, types.id("rock")));
  };
  const auto begin = std::chrono::steady_clock::now();
  const MergedParts merged = merge_by_cells({batches, batches}, types, Crs::local(), {}, cells);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  std::size_t landmarks = 0;
  for (std::size_t part = 0; part < merged.landmarks.count(); ++part)
    landmarks += merged.landmarks.read(part).size();
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  fmt::print("{} observations, {} landmarks, {} parts, {:.1f} s, {:.1f} s of processor time, {} MB peak\n",
             merged.in, landmarks, merged.landmarks.count(), seconds.count(),
             static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec), used.ru_maxrss / 1000);
  return 0;
}

}  // namespace
}  // namespace waymark::bench

int main(int count, char** words) {
  if (count < 2) return fmt::print(stderr, "usage: merging_memory OBSERVATIONS [MAX_IN_CELL] [FOLDER]\n"), 2;
  waymark::pipeline::CellRules cells;
  if (count > 2) cells.max_in_cell = std::strtoull(words[2], nullptr, 10);
  if (count > 3) cells.scratch = words[3];
  return waymark::bench::run(std::strtoull(words[1], nullptr, 10), cells);
}
