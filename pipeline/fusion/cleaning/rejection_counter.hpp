// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "core/observation.hpp"
#include "pipeline/engine/stage_context.hpp"
namespace waymark::pipeline {

/// Counts the observations of a cleaning stage: unmarked inputs are kept or rejected.
class RejectionCounter {
 public:
  RejectionCounter(StageContext& unit, std::span<const Observation> before) : unit_(unit) {
    for (const Observation& o : before) was_accepted_.push_back(o.rejected.empty());
    for (const bool kept : was_accepted_) unit_.count_in(kept ? 1 : 0);
    unit_.count_in(0);
  }
  /// Reports the counts. `after` must be in the order of `before`.
  void close(std::span<const Observation> after) {
    std::int64_t out = 0;
    for (std::size_t i = 0; i < after.size(); ++i) {
      if (!was_accepted_[i]) continue;
      if (after[i].rejected.empty())
        ++out;
      else
        unit_.reject(after[i].rejected);
    }
    unit_.count_out(out);
  }

 private:
  StageContext& unit_;
  std::vector<bool> was_accepted_;
};

}  // namespace waymark::pipeline
