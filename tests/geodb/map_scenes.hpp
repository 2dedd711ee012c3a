// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include "geodb/map_contents.hpp"
namespace waymark::test {
using namespace geodb;

/// Temporary folder of a test, removed by the destructor.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Exit code of a program, and its standard output and error.
struct ProgramResult {
  int exit_code = 0;
  std::string output;
};
ProgramResult run_program(const std::string& command_line);

/// Returns a type with two features and an attribute of each kind.
LandmarkType lamp_post();

/// Lamp posts at random positions in a box, with observations of the first ones; deterministic for a seed.
struct Scene {
  std::string crs = "EPSG:32632";
  double min_x = 400'000, min_y = 5'000'000, max_x = 500'000, max_y = 5'100'000;
  int landmarks = 1000, with_evidence = 20;
  unsigned seed = 1;
};
MapContents scattered(const Scene& scene);

RunRecord example_run();

/// Returns a DEM in memory: height = column + 1000 row, with a hole at the top left.
DemHandle ramp_dem(const Crs& crs, std::int64_t columns, std::int64_t rows);

std::string file_bytes(const std::filesystem::path& path);

/// Runs SQL on a map, with the geometry functions that its triggers need.
void execute_sql(const std::filesystem::path& map, const std::string& script);
std::string query_text(const std::filesystem::path& map, const std::string& sql);

}  // namespace waymark::test
