// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include "pipeline/engine/progress.hpp"
namespace waymark::pipeline {

/// Sums the progress of many threads in one stage and reports it to a listener at intervals.
class ProgressMeter {
 public:
  using Listener = ProgressListener;
  /// Reports the start. An empty listener costs nothing.
  ProgressMeter(const Listener& listener, std::string stage, std::int64_t total);
  /// Adds units or a part of one.
  void add(double units);
  /// Reports the end.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void report(Clock::time_point now);

  const Listener& listener_;
  std::mutex mutex_;
  Progress progress_;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point reported_ = begin_;
};

/// Progress of one unit; never decreases and adds up to one unit.
class UnitProgress {
 public:
  explicit UnitProgress(ProgressMeter& meter) : meter_(meter) {}
  void advance_to(double done_fraction);

 private:
  ProgressMeter& meter_;
  std::mutex mutex_;
  double reached_ = 0;
};

}  // namespace waymark::pipeline
