// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <stdexcept>

#include "pipeline/engine/runner.hpp"

namespace waymark {

std::vector<Artifact::Value> RunResult::find(std::string_view name, std::type_index type, Scope scope) const {
  const auto found = artifacts_.find(name);
  if (found == artifacts_.end()) throw std::logic_error(fmt::format("no stage of the run writes '{}'", name));
  const Kept& kept = found->second;
  if (kept.type != type || kept.scope != scope)
    throw std::logic_error(fmt::format("'{}' is a {} of {} scope, asked for as a {} of {} scope", name,
                                       readable_type(kept.type), to_string(kept.scope), readable_type(type),
                                       to_string(scope)));
  std::vector<Artifact::Value> values;
  for (const ArtifactPtr& item : kept.items) {
    if (item) {
      values.push_back(item->value());
      continue;
    }
    if (!report.failures.empty()) {
      const Failure& first = report.failures.front();
      throw Error(first.code, fmt::format("'{}' was not made: {} failed", name, first.unit), first.message);
    }
    if (!report.complete())
      throw Error(ErrorCode::input, fmt::format("'{}' was not made: part of the work is left", name), {},
                  "run without --check, --shard and --unit to finish the job");
    throw std::logic_error(fmt::format("'{}' was released after the last stage that reads it", name));
  }
  return values;
}

}  // namespace waymark
