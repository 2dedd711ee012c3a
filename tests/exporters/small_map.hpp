// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include "geodb/map_contents.hpp"
namespace waymark::test {

/// A folder of its own for one test, removed afterwards.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// Returns three summits about (x, y), `spacing` CRS units apart, the first the foremost; and one run. uids:
/// mt-one, mt-two, mt-three; elevations 3000, 2000, 1000; prominences 3000, 500, 20.
geodb::MapContents three_summits(const std::string& crs, double x, double y, double spacing);

/// Writes the three summits to `path`, in EPSG:4326 about 70 W 32.5 S.
void write_small_map(const std::filesystem::path& path);
void write_mars_map(const std::filesystem::path& path);
/// Writes three summits and two craters.
void write_two_type_map(const std::filesystem::path& path);

/// Writes two craters with a radius of 8 km, `spacing` CRS units apart.
void write_crater_map(const std::filesystem::path& path, const std::string& crs, double x, double y,
                      double spacing);

std::string content_of(const std::filesystem::path& file);

/// Lists the names in a folder, sorted.
std::vector<std::string> names_in(const std::filesystem::path& folder);

/// Returns the whole message of the Error that `action` throws; empty if it throws none.
template <class Action>
std::string error_of(Action action);

}  // namespace waymark::test

#include "core/error.hpp"

template <class Action>
std::string waymark::test::error_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}
