// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/engine/step.hpp"
namespace waymark::pipeline {

/// Stages available to jobs by name. It is not a global, so each test can create its own.
class Registry {
 public:
  /// Adds a stage. Throws std::logic_error if its name is taken or its spec contradicts itself.
  template <StageLike Stage>
  void add() {
    add(std::make_unique<TypedStep<Stage>>());
  }

  /// Moves the stages of another registry here. Throws std::logic_error if one of their names is taken; then
  /// nothing is moved.
  void take(Registry&& other);

  /// Returns the names in alphabetical order.
  std::vector<std::string> names() const;
  /// Returns the stage with its default options. Throws Error{usage} with the nearest name if there is none.
  const Step& at(std::string_view name) const;

 private:
  void add(std::unique_ptr<Step> step);

  std::map<std::string, std::unique_ptr<Step>, std::less<>> steps_;
};

}  // namespace waymark::pipeline
