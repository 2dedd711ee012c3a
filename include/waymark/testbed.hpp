// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "testbed/score.hpp"
#include "workflows/evaluation/evaluate.hpp"
#include "workflows/simulation/simulate.hpp"

/// \page testbed_header waymark/testbed.hpp
/// Simulated sites, forests and drives with known truth, and comparisons with the truth.
///
/// Make a site with simulate(), as `waymark simulate` does:
/// \snippet snippets/testbed.cpp simulate
/// Compare landmarks with the truth with evaluate():
/// \snippet snippets/testbed.cpp evaluate
/// Compare objects of your own with score():
/// \snippet snippets/testbed.cpp score

/// \example snippets/testbed.cpp
/// The excerpts of \ref testbed_header as a program.
