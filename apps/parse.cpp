// SPDX-License-Identifier: Apache-2.0
#include "apps/parse.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <sstream>
#include <system_error>

#include "core/error.hpp"
#include "core/text_file.hpp"
#include "workflows/parse_number.hpp"

namespace waymark::apps {
namespace {

constexpr int kAnyNumber = CLI::detail::expected_max_vector_size;

int words_of(const Argument& argument) {
  return 1 + static_cast<int>(std::ranges::count(argument.value, ' '));
}

bool repeatable(const Argument& argument) {
  return std::holds_alternative<std::vector<std::string>*>(argument.into);
}

std::string one_of(const Argument& argument, const std::string& word) {
  if (argument.choices.empty() || std::ranges::count(argument.choices, word)) return word;
  std::string all;
  for (const auto& choice : argument.choices) all += (all.empty() ? "" : ", ") + choice;
  const std::string nearest = nearest_name(word, argument.choices);
  throw Error(ErrorCode::usage, display_name(argument) + " must be one of " + all + ", is '" + word + "'", "",
              nearest.empty() ? "" : "did you mean '" + nearest + "'?");
}

/// Returns the lines of FILE for a word @FILE, the word itself if a file has this very name. Lines are names
/// of files, never options: the list may be another person's.
std::vector<std::string> listed_files(const std::string& word) {
  std::error_code unknown;
  if (word.size() < 2 || word[0] != '@' || std::filesystem::exists(word, unknown)) return {word};
  std::istringstream lines(read_text(word.substr(1), "the list of files", ErrorCode::usage));
  std::vector<std::string> files;
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with('\r')) line.pop_back();
    if (!line.empty()) files.push_back(std::move(line));
  }
  if (files.empty())
    throw Error(ErrorCode::usage, "the list of files is empty", word.substr(1), "one name a line");
  return files;
}

struct Store {
  const Argument& argument;
  const std::vector<std::string>& words;

  void operator()(bool* flag) const { *flag = true; }
  void operator()(std::int64_t* into) const {
    *into = workflows::parse_integer(display_name(argument), words[0]);
  }
  void operator()(double* into) const { *into = workflows::parse_number(display_name(argument), words[0]); }
  void operator()(std::string* into) const { *into = one_of(argument, words[0]); }
  void operator()(std::vector<double>* into) const {
    into->clear();
    for (const auto& word : words) into->push_back(workflows::parse_number(display_name(argument), word));
  }
  void operator()(std::vector<std::string>* into) const {
    for (const auto& word : words) {
      if (!takes_list(argument)) {
        into->push_back(one_of(argument, word));
        continue;
      }
      const std::vector<std::string> files = listed_files(word);
      into->insert(into->end(), files.begin(), files.end());
    }
  }
};

void store(const Argument& argument, const std::vector<std::string>& words) {
  const auto wanted = static_cast<std::size_t>(words_of(argument));
  const bool many = repeatable(argument) || argument.value.ends_with("...");
  if (!argument.flag() && !many && words.size() != wanted)
    throw Error(ErrorCode::usage, display_name(argument) + " takes " + std::to_string(wanted) +
                                      (wanted == 1 ? " value (" : " values (") + argument.value + "), has " +
                                      std::to_string(words.size()));
  std::visit(Store{argument, words}, argument.into);
}

std::vector<std::string> names_of(const Argument& argument) {
  return CLI::detail::split(argument.names, ',');
}

/// Matches GDAL's `-of`, which CLI11 would read as `-o f`.
bool gdal_style(const std::string& name) {
  return name.size() > 2 && name[0] == '-' && name[1] != '-';
}

std::string name_for_cli11(const Argument& argument) {
  std::string all;
  for (const auto& name : names_of(argument))
    all += (all.empty() ? "" : ",") + (gdal_style(name) ? "-" + name : name);
  if (!argument.alias.empty()) all += "," + argument.alias;
  return all;
}

void add(CLI::App& app, const Argument& argument) {
  if (argument.flag()) {
    app.add_flag_callback(name_for_cli11(argument), [&argument] { store(argument, {}); })
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    return;
  }
  const auto callback = [&argument](const CLI::results_t& words) {
    store(argument, words);
    return true;
  };
  const bool many_words = argument.value.ends_with("...");
  app.add_option(
         argument.positional() ? "word" + std::to_string(app.get_options().size()) : name_for_cli11(argument),
         callback)
      ->type_name(argument.value)
      ->expected(1, many_words || repeatable(argument) ? kAnyNumber : words_of(argument))
      ->allow_extra_args(many_words || words_of(argument) > 1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

std::vector<std::string> option_names(std::span<const Argument> arguments) {
  std::vector<std::string> names;
  for (const Argument& argument : arguments)
    if (!argument.positional())
      for (const auto& name : names_of(argument)) names.push_back(name);
  return names;
}

/// Returns the words that CLI11 did not recognise.
std::vector<std::string> leftover(CLI::App& app, std::span<const Argument> arguments,
                                  std::vector<std::string> words) {
  const std::vector<std::string> names = option_names(arguments);
  for (auto& word : words)
    if (gdal_style(word) && std::ranges::count(names, word)) word = "-" + word;
  app.set_help_flag();
  for (const Argument& argument : arguments) add(app, argument);
  std::ranges::reverse(words);  // CLI11 takes them from the back
  try {
    app.parse(words);
  } catch (const CLI::ParseError& problem) {
    throw Error(ErrorCode::usage, problem.what());
  }
  return app.remaining();
}

/// Replaces the former names of options by their present ones. Returns a warning for each.
std::vector<std::string> rename_options(std::span<const Argument> arguments,
                                        std::vector<std::string>& words) {
  std::vector<std::string> warnings;
  for (std::string& word : words) {
    const std::size_t end = std::min(word.find('='), word.size());
    const std::string name = word.substr(0, end);
    const auto renamed = std::ranges::find_if(
        arguments, [&](const Argument& argument) { return !name.empty() && argument.former == name; });
    if (renamed == arguments.end()) continue;
    word = display_name(*renamed) + word.substr(end);
    warnings.push_back(name + " was renamed: use " + display_name(*renamed));
  }
  return warnings;
}

[[noreturn]] void refuse_unknown(const std::string& who, std::span<const Argument> arguments,
                                 const std::string& word) {
  if (!word.starts_with('-') || word == "-") {
    // A file in the place of an option's: `waymark trees points.laz`.
    std::string inputs;
    for (const Argument& one : arguments)
      if (one.offer == Offer::file && !one.positional() && display_name(one) != "--output")
        inputs += (inputs.empty() ? "" : ", ") + display_name(one);
    std::error_code unknown;
    const bool is_file = !inputs.empty() && std::filesystem::exists(word, unknown);
    throw Error(ErrorCode::usage, who + " has no use for the word '" + word + "'", "",
                is_file ? "files are given by " + inputs : "`" + who + " --help` shows what it takes");
  }
  const std::string name = word.substr(0, word.find('='));
  const std::string nearest = nearest_name(name, option_names(arguments));
  throw Error(ErrorCode::usage, who + " has no option '" + name + "'", "",
              nearest.empty() ? "`" + who + " --help` lists them" : "did you mean '" + nearest + "'?");
}

bool empty(const Target& into) {
  if (const auto* text = std::get_if<std::string*>(&into)) return (*text)->empty();
  if (const auto* texts = std::get_if<std::vector<std::string>*>(&into)) return (*texts)->empty();
  return false;
}

}  // namespace

std::vector<std::string> parse_leading(std::span<const Argument> options,
                                       const std::vector<std::string>& words) {
  CLI::App app;
  app.prefix_command();
  std::vector<std::string> rest = leftover(app, options, words);
  if (!rest.empty() && rest[0].starts_with('-')) refuse_unknown("waymark", options, rest[0]);
  return rest;
}

std::vector<std::string> parse(const std::string& name, std::span<const Argument> arguments,
                               std::vector<std::string> words) {
  const std::vector<std::string> warnings = rename_options(arguments, words);
  CLI::App app;
  app.allow_extras();
  const std::vector<std::string> rest = leftover(app, arguments, words);
  if (rest.empty()) return warnings;
  const auto option = std::ranges::find_if(rest, [](const auto& word) { return word.starts_with("-"); });
  refuse_unknown("waymark " + name, arguments, option != rest.end() ? *option : rest[0]);
}

void require(const std::string& name, std::span<const Argument> arguments) {
  for (const Argument& argument : arguments)
    if (const auto* flag = std::get_if<bool*>(&argument.into); flag && **flag && argument.waives_required)
      return;
  for (const Argument& argument : arguments)
    if (argument.required && empty(argument.into))
      throw Error(ErrorCode::usage, "waymark " + name + " needs " + synopsis(argument), "",
                  argument.help + "; `waymark " + name + " --help` shows examples");
}

std::string synopsis(const Argument& argument) {
  if (argument.positional()) return argument.required ? argument.value : "[" + argument.value + "]";
  std::string text = argument.names.substr(0, argument.names.find(','));
  if (!argument.flag()) text += " " + argument.value;
  if (!argument.required) text = "[" + text + "]";
  return repeatable(argument) && !argument.value.ends_with("...") ? text + "..." : text;
}

bool takes_list(const Argument& argument) {
  return argument.value.ends_with("...") && argument.offer != Offer::nothing && argument.choices.empty();
}

std::string display_name(const Argument& argument) {
  return argument.positional() ? argument.value : argument.names.substr(argument.names.rfind(',') + 1);
}

}  // namespace waymark::apps
