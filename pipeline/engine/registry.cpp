// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/registry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

#include "core/error.hpp"

namespace waymark::pipeline {
namespace {

bool is_name(std::string_view text) {
  return !text.empty() && text.front() >= 'a' && text.front() <= 'z' &&
         text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string_view::npos;
}

/// Returns the contradiction in a spec, or an empty text.
std::string contradiction(const StageSpec& spec) {
  if (!is_name(spec.name)) return "its name is not [a-z][a-z0-9_]*";
  for (const OutputPort& port : spec.outputs) {
    if (!is_name(port.name)) return "its output '" + port.name + "' is not [a-z][a-z0-9_]*";
    if (std::ranges::count(spec.outputs, port.name, &OutputPort::name) > 1)
      return "it declares the output '" + port.name + "' twice";
  }
  if (spec.lists) {
    if (spec.scope != Scope::map || *spec.lists == Scope::map)
      return "a listing stage has map scope, lists tiles or images";
    const bool tiles = *spec.lists == Scope::tile;
    const std::type_index list = tiles ? typeid(std::vector<Tile>) : typeid(std::vector<ImageItem>);
    if (std::ranges::count(spec.outputs, list, &OutputPort::type) != 1)
      return fmt::format("a stage that lists {}s writes one {}", to_string(*spec.lists), readable_type(list));
  }
  if (spec.halo < 0 || (spec.halo > 0 && spec.scope != Scope::tile))
    return "only a tile has a halo, >= 0 cells";
  return {};
}

}  // namespace

void Registry::add(std::unique_ptr<Step> step) {
  const StageSpec& spec = step->spec();
  if (const std::string problem = contradiction(spec); !problem.empty())
    throw std::logic_error(fmt::format("stage '{}': {}", spec.name, problem));
  const std::string name = spec.name;
  if (!steps_.emplace(name, std::move(step)).second) throw std::logic_error("two stages named " + name);
}

void Registry::take(Registry&& other) {
  for (const auto& [name, step] : other.steps_)
    if (steps_.contains(name)) throw std::logic_error("two stages named " + name);
  steps_.merge(other.steps_);
}

std::vector<std::string> Registry::names() const {
  std::vector<std::string> all;
  for (const auto& [name, step] : steps_) all.push_back(name);
  return all;
}

const Step& Registry::at(std::string_view name) const {
  if (const auto found = steps_.find(name); found != steps_.end()) return *found->second;
  const std::string near = nearest_name(name, names());
  throw Error(ErrorCode::usage,
              fmt::format("there is no stage '{}'{}", name,
                          near.empty() ? "" : fmt::format("; did you mean '{}'?", near)),
              {}, fmt::format("stages: {}", fmt::join(names(), ", ")));
}

}  // namespace waymark::pipeline
