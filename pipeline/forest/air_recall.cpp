// SPDX-License-Identifier: Apache-2.0
#include "pipeline/forest/air_recall.hpp"

#include <cmath>

namespace waymark {

std::vector<RecallRow> air_recall(double dominant_height) {
  if (!(dominant_height > 0) || !std::isfinite(dominant_height)) return {};
  struct Share {
    double from, recall, sd;
  };
  constexpr Share kShares[] = {
      {0, 0.15, 0.16}, {0.6, 0.23, 0.17}, {0.7, 0.36, 0.21}, {0.8, 0.53, 0.19}, {0.9, 0.81, 0.11}};
  std::vector<RecallRow> rows;
  for (const Share& share : kShares) rows.push_back({share.from * dominant_height, share.recall, share.sd});
  return rows;
}

}  // namespace waymark
