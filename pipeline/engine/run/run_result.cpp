// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "pipeline/engine/runner.hpp"

namespace waymark::pipeline {

Artifact::Value RunResult::find_one(std::string_view name, std::type_index type) const {
  const auto found = std::ranges::find(artifacts_, name, &StoredOutput::name);
  if (found == artifacts_.end()) throw std::logic_error(fmt::format("no stage of the run writes '{}'", name));
  if (std::ranges::count(artifacts_, name, &StoredOutput::name) > 1)
    throw std::logic_error(fmt::format("several stages of the run write '{}'", name));
  if (found->type != type || found->scope != Scope::map)
    throw std::logic_error(fmt::format("'{}' is a {} of {} scope, asked for as a {} of map scope", name,
                                       readable_type(found->type), to_string(found->scope),
                                       readable_type(type)));
  if (const ArtifactPtr& item = found->items.front()) return item->value();
  if (!report.failures.empty()) {
    const Failure& first = report.failures.front();
    throw Error(first.code, fmt::format("'{}' was not made: {} failed", name, first.unit), "", first.message);
  }
  throw Error(ErrorCode::input, fmt::format("'{}' was not made: part of the work is left", name), {},
              "run without --check, --shard, --stage and --unit to finish the job");
}

bool RunResult::is_complete(std::string_view stage, std::string_view name) const {
  return std::ranges::any_of(artifacts_, [&](const StoredOutput& kept) {
    return kept.stage == stage && kept.name == name &&
           std::ranges::none_of(kept.items, [](const ArtifactPtr& item) { return item == nullptr; });
  });
}

std::vector<ArtifactPtr> RunResult::take_items(std::string_view name, std::type_index type, Scope scope) {
  std::vector<ArtifactPtr> items;
  std::erase_if(artifacts_, [&](StoredOutput& kept) {
    if (kept.name != name || kept.type != type || kept.scope != scope) return false;
    for (ArtifactPtr& item : kept.items)
      if (item) items.push_back(std::move(item));
    return true;
  });
  return items;
}

std::vector<Artifact::Value> RunResult::find_all(std::string_view name, std::type_index type) const {
  std::vector<Artifact::Value> values;
  for (const StoredOutput& kept : artifacts_) {
    if (kept.name != name) continue;
    if (kept.type != type)
      throw std::logic_error(fmt::format("'{}' is a {}, asked for as a {}", name, readable_type(kept.type),
                                         readable_type(type)));
    for (const ArtifactPtr& item : kept.items)
      if (item) values.push_back(item->value());
  }
  return values;
}

}  // namespace waymark::pipeline
