// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "importers/cameras/camera_set.hpp"
#include "importers/tables/text_table.hpp"
namespace waymark::test {
using namespace importers;

/// Returns the path of a real camera file outside the repository.
inline std::string camera_data(const std::string& name) {
  return WAYMARK_SOURCE_DIR "/../shared/data/cameras/" + name;
}

#define SKIP_WITHOUT_CAMERA_DATA()                        \
  if (!std::filesystem::exists(camera_data("README.md"))) \
  GTEST_SKIP() << "the camera files are not on this machine"

inline const PosedCamera& view_of(const CameraSet& set, const std::string& image) {
  const ImageCamera* found = find_camera(set, image);
  if (!found || !found->view) throw std::runtime_error("no pose for " + image);
  return *found->view;
}

/// Returns the viewing direction of the middle of the image, in the grid.
inline Eigen::Vector3d looks_along(const PosedCamera& view) {
  const auto& c = view.camera;
  return ray(view, {static_cast<double>(c.columns - 1) / 2, static_cast<double>(c.rows - 1) / 2})
      .value()
      .direction.unit;
}

/// Returns the angle between two orientations, degrees.
inline double turn_between(const PosedCamera& a, const PosedCamera& b) {
  return Eigen::AngleAxisd(a.grid_from_camera.transform.linear().transpose() *
                           b.grid_from_camera.transform.linear())
             .angle() /
         kRadiansPerDegree;
}

}  // namespace waymark::test
