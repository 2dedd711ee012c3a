// SPDX-License-Identifier: Apache-2.0
#include "apps/command.hpp"

#include "core/error.hpp"

namespace waymark::apps {

Argument Argument::needed() const {
  Argument same = *this;
  same.required = true;
  return same;
}

Argument Argument::alone() const {
  Argument same = *this;
  same.waives_required = true;
  return same;
}

Argument Argument::one_of(std::vector<std::string> only) const {
  Argument same = *this;
  same.choices = std::move(only);
  return same;
}

Argument Argument::offering(std::vector<std::string> words) const {
  Argument same = *this;
  same.suggestions = std::move(words);
  return same;
}

Argument Argument::offering(Offer paths) const {
  Argument same = *this;
  same.offer = paths;
  return same;
}

Argument Argument::or_else(std::string value_not_given) const {
  Argument same = *this;
  same.otherwise = std::move(value_not_given);
  return same;
}

Argument Argument::formerly(std::string name) const {
  Argument same = *this;
  same.former = std::move(name);
  return same;
}

Argument Argument::also(std::string name) const {
  Argument same = *this;
  same.alias = std::move(name);
  return same;
}

Argument format_option(std::string* into) {
  return Argument{"--format", "FORMAT", into, "Form of standard output"}
      .one_of({"text", "json"})
      .or_else("text");
}

Argument file_word(std::string placeholder, Target into, std::string help) {
  return Argument{"", std::move(placeholder), into, std::move(help)}.needed().offering(Offer::file);
}

Command& CommandTable::find(std::string_view name) const {
  std::vector<std::string> names;
  for (const auto& command : commands_) {
    names.push_back(command->describe().name);
    if (names.back() == name) return *command;
  }
  const std::string nearest = nearest_name(name, names);
  throw Error(ErrorCode::usage, "waymark has no command '" + std::string(name) + "'", "",
              nearest.empty() ? "`waymark --help` lists them" : "did you mean '" + nearest + "'?");
}

std::vector<CommandSpec> CommandTable::describe() const {
  std::vector<CommandSpec> all;
  for (const auto& command : commands_) all.push_back(command->describe());
  return all;
}

}  // namespace waymark::apps
