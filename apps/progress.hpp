// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include "pipeline/engine/runner.hpp"
namespace waymark {

struct Session;

/// Draws the progress of a run on standard error in the way `--progress` names: a bar, GDAL's dots, JSON
/// lines, or nothing. `auto` is a bar on a terminal and else a line every half minute; with --quiet it is
/// nothing. Empty where nothing is to be drawn.
std::function<void(const Progress&)> progress_renderer(const Session& session);

/// Seconds until the stage is done at its present rate; negative where that is not known yet.
double seconds_left(const Progress& progress);

/// "0:07", "1:02:09"; "-:--" for a negative time.
std::string clock_time(double seconds);

}  // namespace waymark
