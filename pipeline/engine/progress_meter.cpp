// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/progress_meter.hpp"

#include <utility>

namespace waymark::pipeline {

ProgressMeter::ProgressMeter(const Listener& listener, std::string stage, std::int64_t total)
    : listener_(listener), progress_{.stage = std::move(stage), .done = 0, .total = total, .rate = 0} {
  if (listener_) report(begin_);
}

void ProgressMeter::add(double units) {
  if (!listener_) return;
  const std::lock_guard lock(mutex_);
  progress_.done += units;
  const auto now = Clock::now();
  if (now - reported_ >= std::chrono::milliseconds(50)) report(now);
}

void ProgressMeter::finish() {
  if (!listener_) return;
  const std::lock_guard lock(mutex_);
  report(Clock::now());
}

void ProgressMeter::report(Clock::time_point now) {
  const double seconds = std::chrono::duration<double>(now - begin_).count();
  progress_.rate = seconds > 0 ? progress_.done / seconds : 0;
  reported_ = now;
  listener_(progress_);
}

void UnitProgress::advance_to(double done_fraction) {
  const std::lock_guard lock(mutex_);
  if (!(done_fraction > reached_)) return;
  meter_.add(done_fraction - std::exchange(reached_, done_fraction));
}

}  // namespace waymark::pipeline
