// SPDX-License-Identifier: Apache-2.0
#include "made_flight.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace waymark::test {

std::filesystem::path simulate_flight(const std::filesystem::path& folder, const MadeFlight& flight) {
  const nlohmann::json scenario = {
      {"waymark_scenario", 1},
      {"seed", 3},
      {"ground", {{"cell", flight.ground_cell}}},
      {"camera", {{"columns", flight.pixels}, {"rows", flight.pixels}, {"field_of_view", 60}}},
      {"dem", {{"cell", 4}}},
      {"flights",
       {{{"images", 3},
         {"lines", 2},
         {"line_spacing", flight.line_spacing},
         {"from_east", -flight.half_length},
         {"to_east", flight.half_length},
         {"from_north", flight.north},
         {"to_north", flight.north},
         {"from_altitude", flight.altitude},
         {"to_altitude", flight.altitude},
         {"track_sd", 0.5}}}}};
  write_text(folder / "scenario.json", scenario.dump());
  const Outcome made = waymark({"simulate", folder / "scenario.json", "-o", folder / "site"});
  EXPECT_EQ(made.code, 0) << made.err;
  return folder / "site";
}

}  // namespace waymark::test
