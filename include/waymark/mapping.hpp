// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "geo/crs.hpp"
#include "geo/dem_source.hpp"
#include "pipeline/engine/job.hpp"
#include "pipeline/engine/runner.hpp"
#include "pipeline/engine/stage.hpp"
#include "pipeline/fusion/association/landmark_codec.hpp"
#include "pipeline/terrain/divide_tree.hpp"
#include "pipeline/terrain/isolation.hpp"
#include "pipeline/terrain/prominence.hpp"
#include "workflows/mapping/make_map.hpp"
#include "workflows/registries.hpp"

/// \page mapping_header waymark/mapping.hpp
/// From files to a map: pipelines of stages, the engine that runs them, and summits of a DEM.
///
/// Make a map with make_map(), as `waymark peaks` does:
/// \snippet snippets/mapping.cpp make
/// Choose the stages of a command with add_crater_stages(), add_tree_stages() and add_name_stage():
/// \snippet snippets/mapping.cpp stages
/// Receive progress and messages with Callbacks:
/// \snippet snippets/mapping.cpp listen
/// Keep finished work in a folder, and count it with plan(); run() resumes:
/// \snippet snippets/mapping.cpp resume
/// Read a Job from text or a file with parse_job() and load_job():
/// \snippet snippets/mapping.cpp job
/// \snippet snippets/mapping.cpp load
/// Print a plan for a scheduler with plan_as_slurm() and the like:
/// \snippet snippets/mapping.cpp schedule
/// Write a stage of your own:
/// \snippet snippets/mapping.cpp stage
/// Run it with the built-in stages:
/// \snippet snippets/mapping.cpp registry
/// Compute prominence with build_divide_tree() and join_divide_trees():
/// \snippet snippets/mapping.cpp prominence
/// Compute isolation with measure_isolation():
/// \snippet snippets/mapping.cpp isolation
/// Transform coordinates with CrsTransform:
/// \snippet snippets/mapping.cpp crs

/// \example snippets/mapping.cpp
/// The excerpts of \ref mapping_header as a program.
