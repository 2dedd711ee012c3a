// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>
#include "core/observation.hpp"
namespace waymark::localization {

/// Views of one landmark where it was expected, by range in half octaves from 1 m, and by whether the view
/// before showed it.
struct RangeViews {
  struct Counts {
    std::uint32_t seen = 0, missed = 0;
  };
  static constexpr std::size_t kBins = 12;

  std::array<Counts, kBins> after_missed{}, after_seen{};
  bool last_seen = false;
  bool is_learnt = false;  ///< they are part of the rates of the type

  void add(double range, bool is_seen);
  RangeViews& operator+=(const RangeViews& other);  ///< adds the counts
};

/// Probabilities of detection by type and range, learnt from landmarks that were seen at all.
/// - A miss is often followed by a miss: a parked car hides a pole for many scans. Views are a Markov chain
/// of
///   two states.
/// - Landmarks of one type differ: a thin pole is seen only from near. The probability of each is a draw from
///   a beta distribution about the mean of its type, so that further misses at one range say less and less
///   (beta-binomial distribution).
/// - A type is not expected beyond the range at which it has been seen, nor one that was never seen.
class DetectionRates {
 public:
  /// Notes a sighting: how far the sensor sees this type, or everything if it gives no types.
  void note(std::optional<TypeId> type, double range);
  /// Returns the largest range noted that applies to a type, m; 0 if there is none.
  double reach(std::optional<TypeId> type) const;

  /// Adds views of a landmark that has been seen, at least once, at any range.
  void learn(std::optional<TypeId> type, const RangeViews& views);
  /// Returns the log probability that a landmark that exists is missed in the view after `views`.
  double log_miss(std::optional<TypeId> type, double range, const RangeViews& views) const;

 private:
  struct OfType {
    double reach = 0;
    RangeViews views;
  };
  static std::size_t index(std::optional<TypeId> type) { return type ? *type + std::size_t{1} : 0; }
  OfType& of(std::optional<TypeId> type);

  std::vector<OfType> types_;  // the first is that of no type
};

}  // namespace waymark::localization
