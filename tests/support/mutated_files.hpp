// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/text_file.hpp"
#include "exporters/raster/raster_file.hpp"
#include "tests/support/mutations.hpp"
#include "tests/support/reader_faults.hpp"
namespace waymark::test {

// Slower than any mutation of such small files should be by far, also on a busy machine.
inline constexpr double kMaxSeconds = 5;

/// Gives a reader a sound file, then mutations of it.
class MutatedFiles : public ::testing::Test {
 protected:
  MutatedFiles() {
    std::string name = (std::filesystem::temp_directory_path() / "waymark-mutated-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw std::runtime_error("cannot make " + name);
    folder_ = name;
    ::alarm(300);  // ends a reader that hangs
  }
  ~MutatedFiles() override {
    ::alarm(0);
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  std::string write(const std::string& name, std::string_view content) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << content;
    return (folder_ / name).string();
  }

  /// Reads the sound file, then `count` mutations of it.
  void check(const std::string& name, const std::string& content, Content kind, std::size_t count,
             const std::function<void(const std::string& path)>& read) const {
    const std::string path = write(name, content);
    ASSERT_NO_THROW(read(path)) << "the sound file";
    std::size_t refused = 0, faults = 0;
    for (std::size_t n = 0; n < count && faults < 5; ++n) {
      write(name, mutate(content, kind, n));
      const auto began = std::chrono::steady_clock::now();
      const std::string fault = fault_of(path, read, refused);
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
      EXPECT_LT(seconds, kMaxSeconds) << name << ", mutation " << n;
      if (fault.empty()) continue;
      ++faults;
      ADD_FAILURE() << name << ", mutation " << n << ": " << fault;
    }
    EXPECT_GT(refused, 0u) << "no mutation was noticed";
    write(name, content);
  }

  static std::string fault_of(const std::string& path, const std::function<void(const std::string&)>& read,
                              std::size_t& refused) {
    try {
      read(path);
      return {};
    } catch (const Error& error) {
      ++refused;
      return fault_of_message(error, path);
    } catch (const std::exception& error) {
      return std::string("a foreign exception: ") + error.what();
    }
  }

  static std::string fault_of_message(const Error& error, const std::string& path) {
    if (const std::string fault = fault_of_text(error); !fault.empty()) return fault;
    const std::string said = error.what();
    // The readers of a data set name the part of it.
    if (said.find(std::filesystem::path(path).parent_path().filename().string()) == said.npos)
      return "the file is not named: " + said;
    return {};
  }

  std::filesystem::path folder_;
};

/// Returns 24 x 20 cells of a slope with bumps.
inline Grid<float> bumpy_slope() {
  Grid<float> cells(24, 20);
  for (std::int64_t y = 0; y < cells.rows(); ++y)
    for (std::int64_t x = 0; x < cells.columns(); ++x)
      cells(x, y) = static_cast<float>(100 + x + 10 * ((x * 7 + y * 5) % 11 == 0));
  return cells;
}

/// Writes the slope as a GeoTIFF in `folder` and returns its bytes.
inline std::string dem_bytes(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "made.tif";
  exporters::write_raster(file, bumpy_slope(), {Crs::from_text("EPSG:32633"), 500000, 5000000, 2, -2});
  return read_text(file, "the DEM");
}

}  // namespace waymark::test
