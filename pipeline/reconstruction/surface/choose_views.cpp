// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/surface/choose_views.hpp"

#include <algorithm>
#include <cmath>

#include "core/units.hpp"

namespace waymark::pipeline {
namespace {

struct ViewCandidate {
  std::size_t view = 0;
  double gsd = 0, penalty = 0;
};

double radians_of(double degrees) {
  return to_radians(Degrees{degrees}).value;
}

bool same_sun(const SurfaceView& a, const SurfaceView& b, double limit) {
  if (!a.sun || !b.sun) return true;
  return sun_direction(*a.sun).unit.dot(sun_direction(*b.sun).unit) >= std::cos(radians_of(limit));
}

// Distance of an angle from the preferred one, in octaves; smaller angles hurt accuracy as they shrink.
double angle_penalty(double angle, const ViewRules& rules) {
  return std::abs(std::log2(std::max(angle, 1e-6) / radians_of(rules.best_angle)));
}

bool comparable(double angle, double gsd_a, double gsd_b, const ViewRules& rules) {
  return angle >= radians_of(rules.min_angle) && angle <= radians_of(rules.max_angle) &&
         std::max(gsd_a, gsd_b) <= rules.max_gsd_ratio * std::min(gsd_a, gsd_b);
}

void add_pairs(ChosenViews& chosen, const std::vector<ViewCandidate>& used,
               const std::vector<SurfaceView>& views, const Eigen::Vector3d& spot, const ViewRules& rules) {
  const bool halves = used.size() >= 4;
  std::vector<ViewPair> inside, across;
  for (std::size_t i = 0; i < used.size(); ++i)
    for (std::size_t j = i + 1; j < used.size(); ++j) {
      const double angle = convergence_angle(views[used[i].view].view, views[used[j].view].view, spot);
      if (!comparable(angle, used[i].gsd, used[j].gsd, rules)) continue;
      (halves && (j - i) % 2 == 0 ? inside : across).push_back({i, j, angle});
    }
  const auto preferred = [&](const ViewPair& a, const ViewPair& b) {
    return angle_penalty(a.angle, rules) < angle_penalty(b.angle, rules);
  };
  std::ranges::stable_sort(inside, preferred);
  std::ranges::stable_sort(across, preferred);
  double widest = 0;
  for (const auto* pairs : {&inside, &across})
    for (const ViewPair& pair : *pairs) widest = std::max(widest, pair.angle);
  const auto narrow = [&](const ViewPair& pair) { return pair.angle < rules.min_angle_fraction * widest; };
  std::erase_if(inside, narrow);
  std::erase_if(across, narrow);
  chosen.pairs = inside;
  chosen.pairs_in_halves = inside.size();
  for (const ViewPair& pair : across)
    if (chosen.pairs.size() < rules.max_pairs) chosen.pairs.push_back(pair);
}

}  // namespace

ChosenViews choose_views(const std::vector<SurfaceView>& views, const Eigen::Vector3d& spot, double spacing,
                         double margin_pixels, const ViewRules& rules, const HiddenTest& hidden) {
  std::vector<ViewCandidate> seen;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const auto pixel = project(views[v].view, {spot});
    if (!pixel || !in_image(views[v].view.camera, *pixel, margin_pixels)) continue;
    if (!(views[v].view.centre().xyz.z() > spot.z()) || (hidden && hidden(v, spot))) continue;
    const double gsd = ground_sample_distance(views[v].view, spot);
    if (std::isfinite(gsd)) seen.push_back({v, gsd, std::abs(std::log2(gsd / spacing))});
  }
  ChosenViews chosen{.candidates = static_cast<int>(seen.size())};
  if (seen.size() < 2) return chosen;

  // The reference has pixels near the spacing; finer ones count as good, since they can be reduced.
  const auto coarse = [&](const ViewCandidate& c) { return std::max(0.0, std::log2(c.gsd / spacing)); };
  std::ranges::stable_sort(seen, [&](const ViewCandidate& a, const ViewCandidate& b) {
    return std::pair(coarse(a), a.penalty) < std::pair(coarse(b), b.penalty);
  });
  const ViewCandidate reference = seen.front();
  std::vector<ViewCandidate> partners;
  for (std::size_t i = 1; i < seen.size(); ++i) {
    ViewCandidate partner = seen[i];
    const double angle = convergence_angle(views[reference.view].view, views[partner.view].view, spot);
    if (!comparable(angle, reference.gsd, partner.gsd, rules) ||
        !same_sun(views[reference.view], views[partner.view], rules.max_sun_angle))
      continue;
    partner.penalty = angle_penalty(angle, rules) + 0.5 * coarse(partner);
    partners.push_back(partner);
  }
  std::ranges::stable_sort(partners, {}, &ViewCandidate::penalty);
  std::vector<ViewCandidate> used{reference};
  for (const ViewCandidate& partner : partners)
    if (used.size() < rules.max_views) used.push_back(partner);
  if (used.size() < 2) return chosen;
  add_pairs(chosen, used, views, spot, rules);
  for (const ViewCandidate& c : used) {
    chosen.views.push_back(c.view);
    chosen.gsd = std::max(chosen.gsd, c.gsd);
  }
  for (const ViewPair& pair : chosen.pairs) chosen.angle = std::max(chosen.angle, pair.angle);
  return chosen;
}

}  // namespace waymark::pipeline
