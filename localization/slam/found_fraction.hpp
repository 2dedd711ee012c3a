// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>
#include <vector>
namespace waymark::localization {

/// A landmark that a set of sightings should show, and whether it did.
struct ExpectedLook {
  std::size_t landmark = 0;
  bool is_found = false;
};

/// Fraction of the landmarks expected of late that are found. Each landmark counts once, by the mean of its
/// looks: one that something hides for many sets is one miss. A landmark that is no longer expected fades.
class FoundFraction {
 public:
  /// Adds the looks of one set. O(landmarks expected of late).
  void add(std::span<const ExpectedLook> looks);
  /// Raises the mean of each landmark to the usual one: the pose is right, whatever hides them.
  void raise_to(double usual);
  /// Returns the fraction, with two landmarks of the usual fraction added: few landmarks say little.
  double value(double usual) const;

 private:
  struct Landmark {
    std::size_t index;
    double found = 0;   // mean of its looks
    double weight = 1;  // 1 while expected
    int looks = 0;
  };
  std::vector<Landmark> landmarks_;
};

}  // namespace waymark::localization
