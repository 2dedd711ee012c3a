// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>
#include "pipeline/reconstruction/poses/pose_growth.hpp"
namespace waymark::pipeline {

struct PoseSettings {
  GrowthSettings growth = {};
  std::size_t seeds = 5;            ///< pairs tried as a start
  std::size_t growing_marks = 600;  ///< per image, while poses grow
  std::size_t final_marks = 2000;   ///< per image, in the result
  std::function<void(std::size_t posed)> progress = {};
};

/// Poses of images that share points. Images of other components have no pose in it.
struct SolvedComponent {
  Reconstruction scene = {};
  std::size_t posed = 0;
};

struct SolvedPoses {
  std::vector<SolvedComponent> components = {};  ///< most images first; each has its own frame
  std::vector<std::string> failures = {};        ///< by image: why it has no pose; empty: it has one
};

/// Solves the poses of images incrementally (Schonberger & Frahm 2016).
/// - Starts from up to `seeds` pairs; keeps what poses most images.
/// - Where the plane of its pair leaves two solutions, both are grown. The one of lower cost is taken.
/// - Images that cannot be joined start a component of their own; components are never joined by a guess.
/// - The frame of each component is arbitrary: that of its first camera.
SolvedPoses solve_poses(std::span<const ImageToMatch> images, std::span<const ImageFeatures> features,
                        const ImageMatches& matches, const PoseSettings& settings);

}  // namespace waymark::pipeline
