// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <waymark/detection.hpp>
#include <waymark/forest.hpp>
#include <waymark/localization.hpp>
#include <waymark/map.hpp>
#include <waymark/mapping.hpp>
#include <waymark/testbed.hpp>

/// \mainpage
/// Include one header by purpose, or `waymark/waymark.hpp` for all, and link `Waymark::waymark`:
/// - \ref map_header
/// - \ref mapping_header
/// - \ref detection_header
/// - \ref forest_header
/// - \ref localization_header
/// - \ref testbed_header
///
/// Whatever these headers do not include is private and not installed.

/// \namespace waymark
/// Semantic navigation maps: landmarks with features, evidence and quality, and robots that find themselves
/// by them.
