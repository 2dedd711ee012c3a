// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/text_file.hpp"
#include "importers/rasters/dem.hpp"
#include "pipeline/terrain/isolation.hpp"
#include "tests/pipeline/terrain/survey.hpp"
namespace waymark::test {

/// Real elevation models with known answers; they stay outside the repository.
inline std::filesystem::path dem_data() {
  return std::filesystem::path(WAYMARK_SOURCE_DIR) / "../shared/data/dem";
}

#define SKIP_WITHOUT_DEM_DATA() \
  if (!std::filesystem::exists(dem_data())) GTEST_SKIP() << dem_data() << " is not on this machine"

inline std::vector<std::vector<std::string>> read_rows(const std::filesystem::path& path) {
  std::istringstream file(read_text(path, "the table"));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    std::vector<std::string> row;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    if (!line.empty() && line.back() == ',') row.emplace_back();
    rows.push_back(std::move(row));
  }
  return rows;
}

/// A CSV file with a header: each row by column name.
inline std::vector<std::map<std::string, std::string>> read_table(const std::filesystem::path& path) {
  const auto rows = read_rows(path);
  std::vector<std::map<std::string, std::string>> table;
  for (std::size_t r = 1; r < rows.size(); ++r)
    for (auto& row = table.emplace_back(); const auto& name : rows[0])
      row[name] = rows[r].at(static_cast<std::size_t>(&name - rows[0].data()));
  return table;
}

inline std::shared_ptr<const DemSource> open_dem(const std::vector<std::string>& names,
                                                 NodataPolicy policy = NodataPolicy::ocean) {
  importers::DemImport import{.files = {}, .nodata = policy};
  for (const auto& name : names) import.files.push_back((dem_data() / name).string());
  return importers::import_dem(import);
}

inline std::vector<pipeline::Isolation> isolation_of(const std::vector<pipeline::Summit>& summits,
                                                     const DemSource& dem,
                                                     const pipeline::IsolationOptions& options = {}) {
  std::vector<pipeline::HighPoint> points;
  for (const pipeline::Summit& s : summits) points.push_back({s.cell, s.height});
  return pipeline::measure_isolation(points, dem, pyramid_of(dem, 512), options);
}

/// The cell whose centre is nearest to a place in the DEM's CRS.
inline std::int64_t cell_at(const GridGeometry& grid, double x, double y) {
  return grid.index(std::lround(grid.where.column(x)), std::lround(grid.where.row(y)));
}

}  // namespace waymark::test
