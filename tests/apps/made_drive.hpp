// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <functional>
#include <string>
#include <vector>
namespace waymark::test {

/// A robot on a circle among rocks on a plain, 0.5 s per step; its log as text.
struct MadeDrive {
  int steps = 120;
  double reach = 9, speed = 0.6, turn = 0.1;
  bool named = false;  ///< sightings say which rock they are
  bool truth = true, start = true, features = true;
  std::string header = {};  ///< more fields of the header
  /// Bad or missing data: what becomes of a line. Empty: left out.
  std::function<std::string(int step, const std::string& kind, const std::string& line)> change = {};
};

struct Rock {
  double x = 0, y = 0, radius = 0;
};

/// The rocks of the plain, always the same.
std::vector<Rock> made_rocks();
/// x,y,uid,radius as `waymark import` reads them.
std::string rocks_csv(double east = 0, double north = 0);
/// The log of a drive (docs/reference/log_format.md).
std::string drive_log(const MadeDrive& drive);
/// The same drive as an MRCLAM dataset of one robot.
void write_mrclam(const std::string& folder);

}  // namespace waymark::test
