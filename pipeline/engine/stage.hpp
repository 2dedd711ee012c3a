// SPDX-License-Identifier: Apache-2.0
// All a stage's file needs:
//
//   struct FindMountainTops {
//     struct Options { Meters min_prominence{20}; void describe(OptionVisitor& option); };
//     static constexpr In<DemHandle> dem{"dem"};
//     static constexpr Out<DivideTree> tree{"divide_tree"};
//     static StageSpec spec() { return {.name = "find_mountain_tops", ..., .inputs = {dem}, .outputs =
//     {tree}}; } static void run(const Options& options, StageContext& unit);
//   };
//   void register_stage_find_mountain_tops(Registry& registry) { registry.add<FindMountainTops>(); }
//
// A stage that opens files also has `static std::vector<std::string> input_files(const Options&)`.
#pragma once
#include "core/error.hpp"
#include "core/options.hpp"
#include "pipeline/engine/codec.hpp"
#include "pipeline/engine/image_item.hpp"
#include "pipeline/engine/port.hpp"
#include "pipeline/engine/registry.hpp"
#include "pipeline/engine/stage_context.hpp"
#include "pipeline/engine/stage_spec.hpp"
#include "pipeline/engine/tile.hpp"
