// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/rock_match.hpp"

#include <algorithm>
#include <cmath>
namespace waymark::workflows {
namespace {

bool clear_of_border(const Pixels& pixels, double x, double y, double diameter, double reach,
                     double sun_angle) {
  const double margin = 0.5 * diameter + 2;
  for (const double t : {0.0, reach + 0.5 * diameter}) {
    const double u = x - t * std::cos(sun_angle), v = y - t * std::sin(sun_angle);
    if (u < margin || v < margin || u > static_cast<double>(pixels.columns() - 1) - margin ||
        v > static_cast<double>(pixels.rows() - 1) - margin)
      return false;
  }
  return true;
}

}  // namespace

RockMatch match_rocks(const RockImage& image, const std::vector<Detection>& found, double sun_angle) {
  RockMatch match{std::vector<int>(image.rocks.size(), -1), std::vector<int>(found.size(), -1), {}, {}};
  for (std::size_t i = 0; i < image.rocks.size(); ++i) {
    const auto& rock = image.rocks[i];
    double best = std::max(0.75 * rock.diameter, 2.0);
    int who = -1;
    for (std::size_t j = 0; j < found.size(); ++j) {
      if (match.rock_of[j] >= 0) continue;
      const double d = std::hypot(found[j].outline.x - rock.x, found[j].outline.y - rock.y);
      if (d <= best) {
        best = d;
        who = static_cast<int>(j);
      }
    }
    match.detection_of[i] = who;
    if (who >= 0) match.rock_of[static_cast<std::size_t>(who)] = static_cast<int>(i);
    match.rock_counts.push_back(
        clear_of_border(image.pixels, rock.x, rock.y, rock.diameter, rock.reach, sun_angle));
  }
  for (std::size_t j = 0; j < found.size(); ++j) {
    const auto& d = found[j];
    const bool clear = clear_of_border(image.pixels, d.outline.x, d.outline.y, d.outline.diameter(),
                                       d.shadow_reach ? d.shadow_reach->value : 0, sun_angle);
    const int rock = match.rock_of[j];
    match.detection_counts.push_back(clear &&
                                     (rock < 0 || match.rock_counts[static_cast<std::size_t>(rock)]));
  }
  return match;
}

}  // namespace waymark::workflows
