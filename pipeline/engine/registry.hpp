// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/engine/step.hpp"
namespace waymark {

/// The stages that jobs can name. An object, not a global: a test makes its own.
class Registry {
 public:
  /// Throws std::logic_error where the name is taken or the spec contradicts itself.
  template <StageLike Stage>
  void add() {
    add(std::make_unique<StepOf<Stage>>());
  }

  /// Names in alphabetical order.
  std::vector<std::string> names() const;
  /// The stage with its default options. Throws Error{usage} with the nearest name where there is none.
  const Step& at(std::string_view name) const;

 private:
  void add(std::unique_ptr<Step> step);

  std::map<std::string, std::unique_ptr<Step>, std::less<>> steps_;
};

}  // namespace waymark
