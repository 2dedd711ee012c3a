// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <string>
namespace waymark::pipeline {

/// Progress of a stage. Listeners are called one at a time, at most 20 times a second and at the end of each
/// stage.
struct Progress {
  std::string stage;
  double done = 0;  ///< units, parts of units included
  std::int64_t total = 0;
  double rate = 0;  ///< units per second since the stage began; 0 at the start
};

/// Function that receives progress; empty: nobody listens.
using ProgressListener = std::function<void(const Progress&)>;

}  // namespace waymark::pipeline
