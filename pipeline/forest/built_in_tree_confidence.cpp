// SPDX-License-Identifier: Apache-2.0
// Made by `waymark train trees -o pipeline/forest/built_in_tree_confidence.cpp`; do not edit.
// clang-format off
#include "pipeline/forest/tree_confidence.hpp"

namespace waymark::pipeline {

const TreeConfidenceModel& built_in_tree_confidence() {
  static const TreeConfidenceModel model = parse_tree_confidence(
      "waymark network 2 treetops\n"
      "120 rough and 40 testbed forests of each type, 95337 treetops\n"
      "numbers decimal\n"
      "layer 5 3\n"
      "19.075 -12.14 0.25 6.131 -0.069 -3.058\n"
      "20.243 -13.5 0.594 4.947 -0.37 -3.537\n"
      "17.285 -9.366 1.193 3.21 -0.197 -2.517\n"
      "check a1892dd9\n"
      , "the built-in confidence of treetops");
  return model;
}

}  // namespace waymark::pipeline
