// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>
#include <vector>
#include "core/random.hpp"
#include "pipeline/fusion/association/observed_object.hpp"
namespace waymark::test {
using namespace pipeline;

struct Making {
  std::uint64_t seed = 0;
  std::uint32_t things = 10, images = 3;
  double spacing = 5;  ///< metres; things lie at least half of it apart
  double recall = 0.8;
};

struct MadeObjects {
  std::vector<ObservedObject> seen;
  std::vector<std::uint32_t> thing;  ///< truth, per sighting
};

/// Round things on a jittered lattice, detected in images of different sharpness with errors according to
/// their covariances.
inline MadeObjects made_objects(const Making& making) {
  MadeObjects made;
  Random random(making.seed, "sightings");
  const auto side = static_cast<std::uint32_t>(std::ceil(std::sqrt(making.things)));
  std::vector<ObservedObject> things(making.things);
  for (std::uint32_t t = 0; t < making.things; ++t) {
    const double x = t % side, y = t / side;
    things[t].at =
        making.spacing * Eigen::Vector2d(x + random.uniform(-0.25, 0.25), y + random.uniform(-0.25, 0.25));
    things[t].log_size = std::log(random.log_uniform(0.2, 1.0));
  }
  for (std::uint32_t image = 0; image < making.images; ++image) {
    const double along = random.log_uniform(0.05, 0.6), across = along * random.uniform(0.3, 1);
    const double turn = random.uniform(0, 3.14159);
    Eigen::Matrix2d root;
    root << along * std::cos(turn), -across * std::sin(turn), along * std::sin(turn), across * std::cos(turn);
    for (std::uint32_t t = 0; t < making.things; ++t) {
      if (!random.bernoulli(making.recall)) continue;
      ObservedObject s = things[t];
      s.source = image;
      s.at += root * Eigen::Vector2d(random.normal(), random.normal());
      s.covariance = root * root.transpose();
      s.log_size += random.normal(0, 0.1);
      s.log_size_variance = 0.01;
      made.seen.push_back(s);
      made.thing.push_back(t);
    }
  }
  return made;
}

}  // namespace waymark::test
