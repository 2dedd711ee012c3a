// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/fusion/valuation/area_filter.hpp"
namespace waymark::pipeline {

using LandmarkList = std::vector<Landmark>;
using ObservationList = std::vector<Observation>;

/// Ports of the stages that value merged landmarks, part by part: all of them together may not fit into
/// memory.
struct ValuedParts {
  static constexpr In<Parts<LandmarkList>> merged{"merged"};
  static constexpr In<Parts<ObservationList>> merged_evidence{"merged_evidence"};
  static constexpr Out<Parts<LandmarkList>> landmarks{"landmarks"};
  static constexpr Out<Parts<ObservationList>> evidence{"evidence"};
  static constexpr Out<Parts<ObservationList>> rejected{"rejected"};

  using Value = std::function<void(LandmarkList&, ObservationList&)>;
  using InArea = std::function<bool(double x, double y)>;

  /// Applies `value` to each part; it may remove landmarks and reports what it rejects. Then removes what is
  /// outside the area, calls `finish`, and writes the three outputs: evidence of landmarks, and rejected
  /// observations.
  static void write(StageContext& unit, const Value& value, const InArea& in_area, const Value& finish = {}) {
    const Parts<LandmarkList>& all = unit.read(merged);
    const Parts<ObservationList>& seen = unit.read(merged_evidence);
    PartsWriter<LandmarkList> valued(unit.make_scratch_file());
    PartsWriter<ObservationList> kept(unit.make_scratch_file()), dropped(unit.make_scratch_file());
    for (std::size_t part = 0; part < all.count(); ++part) {
      LandmarkList own = all.read(part);
      ObservationList own_evidence = seen.read(part);
      unit.count_in(static_cast<std::int64_t>(own.size()));
      value(own, own_evidence);
      unit.reject(kOutsideArea, remove_outside(own, own_evidence, in_area));
      if (finish) finish(own, own_evidence);
      unit.count_out(static_cast<std::int64_t>(own.size()));
      valued.add(own);
      const auto first_rejected = std::stable_partition(
          own_evidence.begin(), own_evidence.end(), [](const Observation& o) { return o.rejected.empty(); });
      dropped.add({std::make_move_iterator(first_rejected), std::make_move_iterator(own_evidence.end())});
      own_evidence.erase(first_rejected, own_evidence.end());
      kept.add(own_evidence);
      unit.progress(static_cast<double>(part + 1) / static_cast<double>(all.count()));
    }
    unit.write(landmarks, valued.parts());
    unit.write(evidence, kept.parts());
    unit.write(rejected, dropped.parts());
  }
};

}  // namespace waymark::pipeline
