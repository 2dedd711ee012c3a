// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/error.hpp"
#include "landmarks/landmark_type.hpp"
#include "localization/detectors/detector_table.hpp"
#include "localization/laser_scan.hpp"
#include "localization/sighting.hpp"
#include "pipeline/engine/stage.hpp"
#include "workflows/detection/image_detector.hpp"
#include "workflows/plug_in.hpp"

/// \page plug_in_header waymark/plug_in.hpp
/// Landmark types, stages and detectors in a shared library, which `waymark --plugin FILE.so` loads.
///
/// A plug-in defines waymark_plug_in(), which adds a LandmarkType, a DetectorSpec and an ImageDetectorSpec:
/// \snippet snippets/plug_in.cpp register
/// The detector in scans turns a LaserScan or a PointCloud into sightings:
/// \snippet snippets/plug_in.cpp scan
/// The detector in images searches what the DetectionPlan says, and may have settings of its own:
/// \snippet snippets/plug_in.cpp image
/// A program loads plug-ins with load_plug_in(), and lists detectors with image_detectors():
/// \snippet snippets/plug_in.cpp load

/// \example snippets/plug_in.cpp
/// The excerpts of \ref plug_in_header as a program.
