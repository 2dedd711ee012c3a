// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <waymark/detection.hpp>
#include <waymark/forest.hpp>
#include <waymark/localization.hpp>
#include <waymark/map.hpp>
#include <waymark/mapping.hpp>
#include <waymark/plug_in.hpp>
#include <waymark/robot.hpp>
#include <waymark/testbed.hpp>

/// \mainpage
/// Include one header by purpose, or `waymark/waymark.hpp` for all, and link `Waymark::waymark`:
/// - \ref map_header
/// - \ref mapping_header
/// - \ref detection_header
/// - \ref forest_header
/// - \ref localization_header
/// - \ref plug_in_header
/// - \ref robot_header
/// - \ref testbed_header
///
/// Whatever these headers do not include is private and not installed.

/// \namespace waymark
/// Semantic navigation maps: landmarks with features, evidence and quality, and robots that find themselves
/// by them.

/// \namespace waymark::core
/// Values and tools that every folder uses: units, grids, options, errors. Inline: `waymark::Meters` is
/// `waymark::core::Meters`.

/// \namespace waymark::geo
/// Coordinate reference systems, cameras, images, DEMs and canopies as values. Inline.

/// \namespace waymark::landmarks
/// Landmark types, landmarks, observations and sensors. Inline.

/// \namespace waymark::geodb
/// The map as a GeoPackage: writing, editing, queries, validation.

/// \namespace waymark::importers
/// Readers of DEMs, images, cameras, laser points, tables and logs.

/// \namespace waymark::exporters
/// Writers of vector formats, rasters and reports.

/// \namespace waymark::pipeline
/// The engine that plans and runs stages, and the algorithms from detection to valuation.

/// \namespace waymark::localization
/// Identification of landmarks, filters, SLAM and pose search.

/// \namespace waymark::testbed
/// Simulated landings, drives and forests with known truth.

/// \namespace waymark::workflows
/// What each command of the program does, as a function.
