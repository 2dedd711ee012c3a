// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/outlying_images.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace waymark::pipeline {
namespace {

struct Views {
  std::size_t expected = 0, matched = 0;

  void add(const ImagePair& pair) { expected += pair.expected, matched += pair.matched; }
  double raw() const {
    return expected > 0 ? static_cast<double>(matched) / static_cast<double>(expected) : 0;
  }
};

}  // namespace

OutlyingImages find_outlying_images(const Repetition& seen, const OutlyingImageRules& rules) {
  const auto found = [&](double raw) {
    return seen.chance < 1 ? (raw - seen.chance) / (1 - seen.chance) : 0;
  };
  std::set<std::size_t> all, out;
  for (const ImagePair& pair : seen.pairs) all.insert({pair.from, pair.to});
  OutlyingImages outlying;
  while (true) {
    Views rest;
    std::map<std::size_t, Views> by_image;
    for (const ImagePair& pair : seen.pairs) {
      if (out.contains(pair.from) || out.contains(pair.to)) continue;
      rest.add(pair), by_image[pair.from].add(pair), by_image[pair.to].add(pair);
    }
    outlying.rest = rest.raw();
    std::optional<OutlyingImage> worst;
    for (const auto& [image, views] : by_image)
      if (views.expected >= rules.min_expected && (!worst || views.raw() < worst->raw))
        worst = OutlyingImage{.image = image, .expected = views.expected, .raw = views.raw()};
    if (!worst || !(found(worst->raw) < rules.wrong)) break;
    if (3 * (out.size() + 1) >= all.size()) return {};
    out.insert(worst->image);
    outlying.images.push_back(*worst);
  }
  return found(outlying.rest) >= rules.sound ? outlying : OutlyingImages{};
}

}  // namespace waymark::pipeline
