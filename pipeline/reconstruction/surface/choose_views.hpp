// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <vector>
#include "pipeline/reconstruction/surface/surface_view.hpp"
#include "pipeline/reconstruction/surface/window_correlation.hpp"
namespace waymark::pipeline {

/// Rules by which views of a spot are chosen.
struct ViewRules {
  std::size_t max_views = 8;
  std::size_t max_pairs = 16;
  double max_gsd_ratio = 2;              ///< between views that are compared
  double min_angle = 3, max_angle = 40;  ///< between views that are compared, degrees
  double min_angle_fraction = 0.6;       ///< of a pair, of the largest angle at the spot
  double best_angle = 18;                ///< preferred, degrees
  double max_sun_angle = 5;              ///< between the suns of views, degrees
};

/// Views of a spot, and the pairs of them that are compared.
struct ChosenViews {
  std::vector<std::size_t> views = {};  ///< indices, best first; even ones are one half, odd ones the other
  std::vector<ViewPair> pairs = {};     ///< indices into `views`; those within a half first
  std::size_t pairs_in_halves = 0;
  double gsd = 0;      ///< coarsest of the views, metres
  double angle = 0;    ///< largest of the pairs, radians
  int candidates = 0;  ///< views that see the spot, chosen or not
};

/// Returns whether a point is hidden in a view.
using HiddenTest = std::function<bool(std::size_t view, const Eigen::Vector3d& point)>;

/// Chooses the views of a spot on terrain sampled every `spacing` metres: the view whose pixels match it
/// best, then those of similar pixel size at angles near the preferred one, under the same sun. Fewer than
/// two views: none can be compared. Ties are broken by the order of `views`, which is that of their names.
ChosenViews choose_views(const std::vector<SurfaceView>& views, const Eigen::Vector3d& spot, double spacing,
                         double margin_pixels, const ViewRules& rules, const HiddenTest& hidden = {});

}  // namespace waymark::pipeline
