// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>
#include "geodb/curve_ranges.hpp"
#include "geodb/map_contents.hpp"
namespace waymark {

/// The landmarks of one type in the order of their rows: along a Hilbert curve through their extent, uids
/// deciding between equal places. It depends neither on the order they came in nor on their parts. Of
/// landmarks in parts about `at_once` are in memory, and one part.
class LandmarkOrder {
 public:
  /// `contents` must outlive it.
  LandmarkOrder(const MapContents& contents, TypeId type, const Envelope& extent, std::size_t at_once);

  /// Calls `take(landmark, place)` for all: `place` counts from 0.
  void visit(const std::function<void(const Landmark&, std::int64_t place)>& take) const;
  /// The evidence of landmarks in parts, in the order of its landmarks, each with the place of its own.
  void visit_evidence(const std::function<void(const Observation&, std::int64_t place)>& take) const;

 private:
  struct Row {
    std::uint32_t along = 0, part = 0;
    const Landmark* landmark = nullptr;
  };
  struct Rows;
  std::shared_ptr<const std::vector<Landmark>> part(std::size_t number) const;
  Rows rows_in(const CurveRange& range) const;

  const MapContents* contents_;
  TypeId type_;
  Envelope extent_;
  std::vector<CurveRange> ranges_;
};

}  // namespace waymark
