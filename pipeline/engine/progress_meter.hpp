// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include "pipeline/engine/runner.hpp"
namespace waymark {

/// Sums up what many threads have done of one stage and tells a listener now and then.
class ProgressMeter {
 public:
  using Listener = std::function<void(const Progress&)>;
  /// An empty listener costs nothing. Tells the start.
  ProgressMeter(const Listener& listener, std::string stage, std::int64_t total);
  /// Adds units or a part of one.
  void add(double units);
  /// Tells the end.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  void tell(Clock::time_point now);

  const Listener& listener_;
  std::mutex mutex_;
  Progress progress_;
  const Clock::time_point begin_ = Clock::now();
  Clock::time_point told_ = begin_;
};

/// How far one unit is: never goes back, and counts as one unit in the end.
class UnitProgress {
 public:
  explicit UnitProgress(ProgressMeter& meter) : meter_(meter) {}
  void reach(double done_fraction);

 private:
  ProgressMeter& meter_;
  std::mutex mutex_;
  double reached_ = 0;
};

}  // namespace waymark
