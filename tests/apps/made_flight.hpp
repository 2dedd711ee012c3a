// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
namespace waymark::test {

/// Two lines of three square images about (0, 0), metres, that look straight down.
struct MadeFlight {
  int pixels = 300;  ///< across an image of 60 degrees
  double ground_cell = 0.5;
  double half_length = 25, north = 12, line_spacing = 25;
  double altitude = 90;
};

/// Simulates a flight into `folder`; returns the site, with images/ and truth/cameras.json.
std::filesystem::path simulate_flight(const std::filesystem::path& folder, const MadeFlight& flight);

}  // namespace waymark::test
