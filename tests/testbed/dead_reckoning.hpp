// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "testbed/drive/drive_world.hpp"
namespace waymark::test {

/// Returns the squared error of dead reckoning at the end of a drive in terms of the noise that its log
/// states, per coordinate: 1 on average if both agree.
double squared_error_of_odometry(const testbed::DriveWorld& world);

}  // namespace waymark::test
