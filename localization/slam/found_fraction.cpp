// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/found_fraction.hpp"

#include <algorithm>

namespace waymark::localization {
namespace {

constexpr double kFade = 0.1;       // of a mean by one look, and of a weight by one set
constexpr int kKnownLooks = 10;     // after which a mean fades
constexpr double kMinWeight = 0.1;  // below it a landmark is forgotten: after 22 sets
constexpr double kPriorWeight = 2;  // landmarks

}  // namespace

void FoundFraction::add(std::span<const ExpectedLook> looks) {
  for (Landmark& l : landmarks_) l.weight *= 1 - kFade;
  for (const ExpectedLook& look : looks) {
    auto at = std::ranges::find(landmarks_, look.landmark, &Landmark::index);
    if (at == landmarks_.end()) at = landmarks_.insert(at, {.index = look.landmark});
    at->weight = 1;
    at->found += std::max(kFade, 1.0 / ++at->looks) * ((look.is_found ? 1 : 0) - at->found);
  }
  std::erase_if(landmarks_, [](const Landmark& l) { return l.weight < kMinWeight; });
}

void FoundFraction::raise_to(double usual) {
  for (Landmark& l : landmarks_) l.found = std::max(l.found, usual), l.looks = std::max(l.looks, kKnownLooks);
}

double FoundFraction::value(double usual) const {
  double found = kPriorWeight * usual, weight = kPriorWeight;
  for (const Landmark& l : landmarks_) found += l.weight * l.found, weight += l.weight;
  return found / weight;
}

}  // namespace waymark::localization
