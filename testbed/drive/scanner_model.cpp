// SPDX-License-Identifier: Apache-2.0
#include "testbed/drive/scanner_model.hpp"

namespace waymark::testbed {

void describe_scanner(ScannerModel& s, OptionVisitor& field) {
  field("on", s.on, {.help = "Simulate a 3-D scanner; in a street or a hall"});
  field("every", s.every, {.help = "Seconds between two turns", .min = 0.05, .max = 1e4});
  field("rows", s.rows, {.help = "Number of rows", .min = 2, .max = 256});
  field("lowest", s.lowest, {.help = "Elevation of the lowest row", .min = -89, .max = 89});
  field("highest", s.highest, {.help = "Elevation of the highest row", .min = -89, .max = 89});
  field("step", s.step, {.help = "Angle between two columns", .min = 0.05, .max = 10});
  field("max_range", s.max_range, {.help = "Maximum range, metres", .min = 1, .max = 500});
  field("height", s.height, {.help = "Height above the ground, metres", .min = 0.1, .max = 50});
  field("range_sd", s.range_sd, {.help = "Noise of a range, metres", .min = 0, .max = 1});
  field("dropouts", s.dropouts, {.help = "Fraction of beams without return", .min = 0, .max = 1});
  field("intensities", s.intensities, {.help = "Log the strengths of the returns"});
}

}  // namespace waymark::testbed
