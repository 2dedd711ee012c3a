// SPDX-License-Identifier: Apache-2.0
#include "localization/identification/landmark_window.hpp"

#include <algorithm>
#include <cassert>

namespace waymark::localization {

LandmarkWindow::LandmarkWindow(LandmarkGrid whole) : grid_(std::move(whole)) {}

LandmarkWindow::LandmarkWindow(LandmarkSource source, double margin)
    : source_(std::move(source)), margin_(margin) {
  assert(source_ && margin > 0);
}

const LandmarkGrid& LandmarkWindow::landmarks_near(const Eigen::Vector2d& at, double reach) {
  if (whole()) return grid_;
  const Eigen::Vector2d half = Eigen::Vector2d::Constant(reach);
  const Eigen::AlignedBox2d asked(at - half, at + half);
  if (loaded_.isEmpty() || !loaded_.contains(asked)) {
    const Eigen::Vector2d more = Eigen::Vector2d::Constant(std::max(margin_, reach / 4));
    loaded_ = Eigen::AlignedBox2d(asked.min() - more, asked.max() + more);
    // Neighbours outside decide as well which landmarks at the edge are left out.
    const Eigen::Vector2d around = Eigen::Vector2d::Constant(kOutweighedRadius);
    grid_ = LandmarkGrid(source_({loaded_.min() - around, loaded_.max() + around}));
  }
  return grid_;
}

}  // namespace waymark::localization
