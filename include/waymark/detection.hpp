// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/error.hpp"
#include "pipeline/craters/find_craters.hpp"
#include "pipeline/rocks/find_rocks.hpp"
#include "workflows/detection/detect.hpp"
#include "workflows/training/train.hpp"

/// \page detection_header waymark/detection.hpp
/// Rocks and craters in images, craters in elevation models.
///
/// Detect in a file with detect(), as `waymark detect` does:
/// \snippet snippets/detection.cpp detect
/// Detect in pixels with find_craters() and find_rocks():
/// \snippet snippets/detection.cpp pixels
/// Estimate the light with estimate_crater_sun_angle() and search_rocks():
/// \snippet snippets/detection.cpp light
/// Detect craters in heights with find_craters():
/// \snippet snippets/detection.cpp heights
/// Train the models with train():
/// \snippet snippets/detection.cpp train

/// \example snippets/detection.cpp
/// The excerpts of \ref detection_header as a program.
