// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "core/error.hpp"
#include "core/landmark.hpp"
#include "core/units.hpp"
#include "exporters/report/report_html.hpp"
#include "exporters/vector/export_map.hpp"
#include "geodb/map_editor.hpp"
#include "geodb/map_query.hpp"
#include "geodb/map_store.hpp"
#include "geodb/validate_map.hpp"
#include "geodb/write_map.hpp"
#include "landmarks/landmark_type.hpp"
#include "landmarks/semantic_map.hpp"
#include "landmarks/sensor_profile.hpp"
#include "workflows/mapping/import_landmarks.hpp"
#include "workflows/query/query.hpp"
#include "workflows/registries.hpp"

/// \page map_header waymark/map.hpp
/// The map: landmark types, landmarks with features and evidence, and the map file (docs/reference/map.md).
///
/// Write a map file with write_map(); the file appears complete or not at all:
/// \snippet snippets/map.cpp write
/// Read it with MapStore and MapQuery:
/// \snippet snippets/map.cpp read
/// Ask as the command does, with query():
/// \snippet snippets/map.cpp query
/// Check a request once and run it often with PreparedQuery:
/// \snippet snippets/map.cpp prepared
/// Change landmarks in place with MapEditor:
/// \snippet snippets/map.cpp edit
/// Keep a map in memory as a SemanticMap:
/// \snippet snippets/map.cpp memory
/// Weigh landmarks for a sensor with quality_for(); all_sensors() has the built-in SensorProfile values:
/// \snippet snippets/map.cpp sensor
/// Declare a sensor of your own in a SensorRegistry:
/// \snippet snippets/map.cpp own_sensor
/// Merge observations with merge(), and rate them with spread_confidence() and multiplicity_confidence():
/// \snippet snippets/map.cpp merge
/// Compute the quality of eq. 8 with landmark_quality():
/// \snippet snippets/map.cpp quality
/// Convert angles, and compute with units, by Quantity:
/// \snippet snippets/map.cpp units
/// Declare a LandmarkType of your own:
/// \snippet snippets/map.cpp type
/// Ask types by what they declare, with find_type() and the like:
/// \snippet snippets/map.cpp types
/// Turn a table into a map with import_landmarks():
/// \snippet snippets/map.cpp import
/// List the rules for GIS layers with ready_rule_names():
/// \snippet snippets/map.cpp rules
/// Check, export and report a map with validate_map(), export_map() and write_report():
/// \snippet snippets/map.cpp deliver
/// Every function that fails throws an Error with the problem, its place and a remedy:
/// \snippet snippets/map.cpp error

/// \example snippets/map.cpp
/// The excerpts of \ref map_header as a program.
