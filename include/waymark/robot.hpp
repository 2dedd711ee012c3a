// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/error.hpp"
#include "importers/logs/frame_tree.hpp"
#include "importers/logs/gyro_yaw.hpp"
#include "importers/logs/robot_readings.hpp"
#include "workflows/localization/live_localizer.hpp"

/// \page robot_header waymark/robot.hpp
/// The pose of a robot while it drives, from the messages of its sensors.
///
/// Open a map and begin with a LiveLocalizer:
/// \snippet snippets/robot.cpp begin
/// Make readings of what messages of ROS state with laser_scan(), mount() and fix_of_antenna(), and place
/// sensors by a FrameTree:
/// \snippet snippets/robot.cpp readings
/// Give odometry the yaw of a gyro with with_yaw_of_gyro():
/// \snippet snippets/robot.cpp gyro
/// Give the readings, and read the pose:
/// \snippet snippets/robot.cpp take

/// \example snippets/robot.cpp
/// The excerpts of \ref robot_header as a program.
