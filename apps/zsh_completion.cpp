// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <sstream>

#include "apps/shell_completion.hpp"

namespace waymark::apps {
namespace {

// Escapes text for a specification of _arguments within single quotes.
std::string zsh_text(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\'')
      safe += "'\\''";
    else if (c == '[' || c == ']' || c == ':' || c == '\\')
      safe += std::string("\\") + c;
    else
      safe += c;
  }
  return safe;
}

std::string zsh_action(const Argument& argument) {
  const auto& words = argument.choices.empty() ? argument.suggestions : argument.choices;
  if (!words.empty()) return fmt::format("({})", zsh_text(fmt::format("{}", fmt::join(words, " "))));
  if (argument.offer == Offer::file) return "_files";
  return argument.offer == Offer::folder ? "_files -/" : " ";
}

// Returns ":WORD:action" for each value of an argument.
std::string zsh_values(const Argument& argument) {
  std::string text;
  std::istringstream words(argument.value);
  for (std::string word; words >> word;) text += ":" + zsh_text(word) + ":" + zsh_action(argument);
  return text;
}

std::string zsh_option(const Argument& argument) {
  const std::string values = argument.flag() ? "" : zsh_values(argument);
  std::string text;
  std::istringstream names(argument.names);
  for (std::string name; std::getline(names, name, ',');)
    text += fmt::format(" \\\n        '*{}[{}]{}'", name, zsh_text(argument.help), values);
  return text;
}

std::string zsh_arguments(std::span<const Argument> own, std::span<const Argument> globals) {
  std::string text = "_arguments -s";
  int position = 0;
  for (const Argument& argument : own) {
    if (!argument.positional()) {
      text += zsh_option(argument);
      continue;
    }
    const bool many = argument.value.ends_with("...");
    text += fmt::format(" \\\n        '{}:{}:{}'", many ? "*" : std::to_string(++position),
                        zsh_text(argument.value), zsh_action(argument));
  }
  for (const Argument& argument : globals) text += zsh_option(argument);
  return text;
}

}  // namespace

std::string zsh_completion(std::span<const CommandSpec> commands, std::span<const Argument> globals) {
  std::string text =
      "#compdef waymark\n# zsh completion for waymark, written by `waymark completion zsh`\n"
      "_waymark() {\n  local context state state_descr line\n  typeset -A opt_args\n  _arguments -C -s";
  for (const Argument& argument : globals) text += zsh_option(argument);
  text +=
      " \\\n        '1:command:->command' '*::argument:->argument'\n  case $state in\n    command)\n"
      "      local -a commands=(\n";
  for (const CommandSpec& command : commands)
    text += fmt::format("        '{}:{}'\n", command.name, zsh_text(command.summary));
  text +=
      "      )\n      _describe -t commands command commands ;;\n    argument)\n      case $words[1] in\n";
  for (const CommandSpec& command : commands)
    text += fmt::format("      {}) {} ;;\n", command.name, zsh_arguments(command.arguments, globals));
  return text +
         "      esac ;;\n  esac\n}\nif [[ $funcstack[1] == _waymark ]]; then\n  _waymark \"$@\"\nelse\n"
         "  compdef _waymark waymark\nfi\n";
}

}  // namespace waymark::apps
