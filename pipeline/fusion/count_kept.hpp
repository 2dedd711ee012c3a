// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>
#include "core/observation.hpp"
#include "pipeline/engine/stage_context.hpp"
namespace waymark {

/// Keeps a cleaning stage's books: observations that came in unmarked went out or were rejected here.
class KeptCount {
 public:
  KeptCount(StageContext& unit, std::span<const Observation> before) : unit_(unit) {
    for (const Observation& o : before) came_.push_back(o.rejected.empty());
    for (const bool kept : came_) unit_.count_in(kept ? 1 : 0);
    unit_.count_in(0);
  }
  /// `after` in the same order.
  void close(std::span<const Observation> after) {
    std::int64_t out = 0;
    for (std::size_t i = 0; i < after.size(); ++i) {
      if (!came_[i]) continue;
      if (after[i].rejected.empty())
        ++out;
      else
        unit_.reject(after[i].rejected);
    }
    unit_.count_out(out);
  }

 private:
  StageContext& unit_;
  std::vector<bool> came_;
};

}  // namespace waymark
