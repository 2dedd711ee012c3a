// SPDX-License-Identifier: Apache-2.0
// Everything that the file of a stage needs:
//
//   struct FindMountainTops {
//     struct Options { Meters min_prominence{20}; void describe(OptionVisitor& option); };
//     static constexpr In<DemHandle> dem{"dem"};
//     static constexpr Out<DivideTree> tree{"divide_tree"};
//     static StageSpec spec();  // {.name = "find_mountain_tops", ..., .inputs = {dem}, .outputs = {tree}}
//     static void run(const Options& options, StageContext& unit);
//   };
//   void register_stage_find_mountain_tops(Registry& registry) { registry.add<FindMountainTops>(); }
//
// A stage that opens files also has `static std::vector<std::string> input_files(const Options&)`.
// A stage whose options may not fit its inputs also has `static void check_inputs(const Options&,
// StageContext&)`, which runs before all work, with the artifacts that planning made.
#pragma once
#include "core/error.hpp"
#include "core/options.hpp"
#include "landmarks/landmark_type.hpp"
#include "pipeline/engine/codec.hpp"
#include "pipeline/engine/image_item.hpp"
#include "pipeline/engine/parts.hpp"
#include "pipeline/engine/port.hpp"
#include "pipeline/engine/registry.hpp"
#include "pipeline/engine/stage_context.hpp"
#include "pipeline/engine/stage_spec.hpp"
#include "pipeline/engine/tile.hpp"
