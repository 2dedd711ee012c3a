// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/engine/registry.hpp"
#include "pipeline/engine/step.hpp"
namespace waymark::pipeline {

/// Ordered list of stages with their options. Later stages read the artifacts of earlier ones.
class Pipeline {
 public:
  /// The registry must outlive the pipeline.
  explicit Pipeline(const Registry& registry) : registry_(&registry) {}

  /// Appends a stage by name; options as a JSON object, empty for the defaults.
  /// Throws Error{usage} naming the location in the job, "stages[1].min_prominence".
  Pipeline& add(std::string_view stage, std::string_view options_json = {});

  /// Appends a stage by type: pipeline.add<FindMountainTops>({.min_prominence = 25_m}).
  template <StageLike Stage>
  Pipeline& add(typename Stage::Options options = {}) {
    return add(std::make_unique<TypedStep<Stage>>(std::move(options)));
  }

  /// Changes one option of a stage already added: "find_mountain_tops.min_prominence=25" (--set).
  Pipeline& set(std::string_view assignment);

  /// Folder that relative paths in options start at; empty: the current folder.
  std::filesystem::path base_folder;

  const std::vector<std::unique_ptr<Step>>& steps() const { return steps_; }
  /// Returns the first step that writes the artifact, or null.
  const Step* find_writer(std::string_view artifact) const;

  /// Returns a warning for each option that was given by its former name.
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// Checks the connections between stages. Throws Error{usage} naming stages and ports if
  /// - an input has no earlier output of the same name and type, or several without gathering them;
  /// - a tile-scope (image-scope) stage has no earlier stage that lists tiles (images);
  /// - a stage occurs twice.
  void check() const;

 private:
  Pipeline& add(std::unique_ptr<Step> step);
  void add_warnings(const std::vector<std::string>& warnings);

  const Registry* registry_;
  std::vector<std::unique_ptr<Step>> steps_;
  std::vector<std::string> warnings_;
};

}  // namespace waymark::pipeline
