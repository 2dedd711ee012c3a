// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "made_flight.hpp"
#include "photo_files.hpp"
#include "program.hpp"
namespace waymark::test {

/// Six images of 300 x 300 pixels from 300 m in two lines.
inline const std::filesystem::path& grid_flight() {
  static const TempFolder folder;
  static const std::filesystem::path site = simulate_flight(
      folder.path(),
      {.ground_cell = 1, .half_length = 90, .north = 50, .line_spacing = 100, .altitude = 300});
  return site;
}

/// Pictures of grid_flight() as a camera writes them into `images`, with their positions.
class PhotoFlight : public testing::Test {
 protected:
  PhotoFlight() {
    const auto cameras = nlohmann::json::parse(text_of(grid_flight() / "truth/cameras.json"));
    for (const nlohmann::json& image : cameras["images"]) {
      const std::string name = image["name"];
      names_.push_back(std::filesystem::path(name).stem().string() + ".jpg");
      pictures_.push_back(read_picture(grid_flight() / "images" / name));
      const double metres = 111'320;       // per degree
      constexpr double lon = 9, lat = 48;  // of (0, 0)
      positions_.push_back(
          {.lon = lon + double(image["centre"][0]) / metres / std::cos(lat * std::numbers::pi / 180),
           .lat = lat + double(image["centre"][1]) / metres,
           .altitude = 500 + double(image["centre"][2])});
    }
    std::filesystem::create_directories(folder_ / "images");
  }
  std::filesystem::path image(const std::string& name) const {
    return std::filesystem::path(folder_ / "images") / name;
  }
  void write_good(std::size_t count, bool with_gps = false) {
    for (std::size_t i = 0; i < count; ++i)
      write_photo(image(names_[i]), pictures_[i], with_gps ? positions_[i] : PhotoExif{});
  }

  TempFolder folder_;
  std::vector<std::string> names_;
  std::vector<GreyPicture> pictures_;
  std::vector<PhotoExif> positions_;
};

}  // namespace waymark::test
