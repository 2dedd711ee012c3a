// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <mutex>
#include "pipeline/engine/progress_meter.hpp"
namespace waymark::workflows {

/// Progress of the searches of a route: stage `route`, one unit per search. How many searches a leg needs is
/// known only afterwards, so each leg counts with the largest number. Safe for many threads.
class RouteProgress {
 public:
  /// `max_searches`: of all legs together.
  RouteProgress(const pipeline::ProgressListener& listener, std::int64_t max_searches);

  /// Begins a leg that needs so many searches at most.
  void begin_leg(int max_searches);
  /// Begins a further search of the leg.
  void begin_search();
  /// Reports the fraction of the search that is done. The listener may throw to end the search.
  void advance(double done);
  /// Reports that the searches of the leg are done, those that were not needed as well.
  void end_leg();
  /// Reports the end, also of legs that were not needed.
  void finish();

 private:
  void move_to(double reached);

  pipeline::ProgressMeter meter_;
  std::mutex mutex_;
  const double max_searches_;
  double leg_begin_ = 0, leg_searches_ = 0;  // of the present leg
  double searches_ = 0;                      // begun in the leg
  double reached_ = 0;
};

}  // namespace waymark::workflows
