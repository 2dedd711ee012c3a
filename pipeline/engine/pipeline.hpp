// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>
#include "pipeline/engine/registry.hpp"
#include "pipeline/engine/step.hpp"
namespace waymark {

/// Stages in order, each with its options. Later stages read what earlier ones write.
class Pipeline {
 public:
  /// The registry must outlive the pipeline.
  explicit Pipeline(const Registry& registry) : registry_(&registry) {}

  /// Appends a stage by name; options as a JSON object, empty for all defaults. Throws Error{usage} naming
  /// the place in the job, "stages[1].min_prominence".
  Pipeline& add(std::string_view stage, std::string_view options_json = {});

  /// Appends a stage whose type is visible: pipeline.add<FindMountainTops>({.min_prominence = 25_m}).
  template <StageLike Stage>
  Pipeline& add(typename Stage::Options options = {}) {
    return add(std::make_unique<StepOf<Stage>>(std::move(options)));
  }

  /// Changes one option of a stage already added: "find_mountain_tops.min_prominence=25" (--set).
  Pipeline& set(std::string_view assignment);

  /// Relative paths in options start here; empty: the current folder.
  std::filesystem::path base_folder;

  const std::vector<std::unique_ptr<Step>>& steps() const { return steps_; }
  /// The first step that writes the artifact, or null.
  const Step* writer_of(std::string_view artifact) const;

  /// Throws Error{usage} naming stages and ports where an input has no earlier output of the same name and
  /// type, or several but does not gather them, where a tile-scope (image-scope) stage has no stage before it
  /// that lists tiles (images), or where a stage is there twice.
  void check() const;

 private:
  Pipeline& add(std::unique_ptr<Step> step);

  const Registry* registry_;
  std::vector<std::unique_ptr<Step>> steps_;
};

}  // namespace waymark
