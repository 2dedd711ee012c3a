// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <set>
#include <vector>
#include "geodb/hilbert_ranges.hpp"
#include "geodb/map_contents.hpp"
namespace waymark::geodb {

/// Order of the rejected observations of parts: along a Hilbert curve through their extent, then by content.
/// It does not depend on the division into parts. About `max_in_memory` of them, and one part, are in memory.
class RejectedOrder {
 public:
  /// `parts` must outlive it.
  RejectedOrder(const LandmarkParts& parts, std::size_t max_in_memory);

  const std::set<TypeId>& types() const { return types_; }
  void visit(const std::function<void(const Observation&)>& take) const;

 private:
  std::uint32_t curve_position(const Observation& observation) const;

  const LandmarkParts* parts_;
  Envelope extent_;
  std::set<TypeId> types_;
  std::vector<HilbertRange> ranges_;
};

}  // namespace waymark::geodb
