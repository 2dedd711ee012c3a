// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include "pipeline/engine/runner.hpp"
namespace waymark::apps {

struct Session;

/// Returns a function that draws progress on standard error as `--progress` says: a bar, GDAL's dots, JSON
/// lines or nothing. `auto` is a bar on a terminal, a line every half minute elsewhere, and nothing with
/// --quiet. Empty if nothing is drawn.
std::function<void(const pipeline::Progress&)> progress_renderer(const Session& session);

/// Returns seconds until the stage is done at its present rate; negative if not known yet.
double seconds_left(const pipeline::Progress& progress);

/// Returns "0:07" or "1:02:09"; "-:--" for a negative time.
std::string clock_time(double seconds);

}  // namespace waymark::apps
