// SPDX-License-Identifier: Apache-2.0
#include "workflows/planning/route_progress.hpp"

#include <algorithm>

namespace waymark::workflows {

RouteProgress::RouteProgress(const pipeline::ProgressListener& listener, std::int64_t max_searches)
    : meter_(listener, "route", max_searches), max_searches_(static_cast<double>(max_searches)) {}

void RouteProgress::begin_leg(int max_searches) {
  const std::scoped_lock lock(mutex_);
  leg_searches_ = max_searches, searches_ = 0;
}

void RouteProgress::begin_search() {
  const std::scoped_lock lock(mutex_);
  ++searches_;
  move_to(leg_begin_ + std::min(searches_ - 1, leg_searches_));
}

void RouteProgress::advance(double done) {
  const std::scoped_lock lock(mutex_);
  const double searches = std::max(0.0, searches_ - 1) + std::clamp(done, 0.0, 1.0);
  move_to(leg_begin_ + std::min(searches, leg_searches_));
}

void RouteProgress::end_leg() {
  const std::scoped_lock lock(mutex_);
  leg_begin_ += leg_searches_, leg_searches_ = 0;
  move_to(leg_begin_);
}

void RouteProgress::finish() {
  const std::scoped_lock lock(mutex_);
  move_to(max_searches_);
  meter_.finish();
}

/// Reports even if nothing was gained: a listener ends the work by an exception.
void RouteProgress::move_to(double reached) {
  const double more = std::max(0.0, std::min(reached, max_searches_) - reached_);
  reached_ += more;
  meter_.add(more);
}

}  // namespace waymark::workflows
