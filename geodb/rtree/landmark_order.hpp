// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>
#include "geodb/hilbert_ranges.hpp"
#include "geodb/map_contents.hpp"
namespace waymark::geodb {

/// Row order of the landmarks of one type: by index on a Hilbert curve through their extent, then by uid. It
/// does not depend on the order of input or the division into parts. About `max_in_memory` landmarks of
/// parts, and one part, are in memory.
class LandmarkOrder {
 public:
  /// `contents` must outlive it.
  LandmarkOrder(const MapContents& contents, TypeId type, const Envelope& extent, std::size_t max_in_memory);

  /// Calls `take` for all landmarks with their index in the order, from 0; calls `before_release` before the
  /// landmarks taken so far disappear.
  void visit(const std::function<void(const Landmark&, std::int64_t row_index)>& take,
             const std::function<void()>& before_release = {}) const;
  /// Calls `take` for the observations of landmarks in parts, in the order of their landmarks, with the
  /// landmark's index.
  void visit_evidence(const std::function<void(const Observation&, std::int64_t row_index)>& take) const;

 private:
  struct Row {
    std::uint32_t curve_position = 0, part = 0;
    const Landmark* landmark = nullptr;
  };
  struct Rows;
  std::shared_ptr<const std::vector<Landmark>> part(std::size_t number) const;
  Rows read_rows(const HilbertRange& range) const;

  const MapContents* contents_;
  TypeId type_;
  Envelope extent_;
  std::vector<HilbertRange> ranges_;
};

}  // namespace waymark::geodb
