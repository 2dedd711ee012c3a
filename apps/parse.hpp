// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>
#include "apps/command.hpp"
namespace waymark::apps {

/// Reads the options at the head of `words` and returns the words from the first that is none of them.
std::vector<std::string> parse_leading(std::span<const Argument> options,
                                       const std::vector<std::string>& words);

/// Reads all words of the command `name` into the targets of its arguments. Returns a warning for each option
/// that is given by its former name.
/// Throws Error{usage} for an unknown option (with the nearest name), a surplus word, or a value that is no
/// number or none of the choices.
[[nodiscard]] std::vector<std::string> parse(const std::string& name, std::span<const Argument> arguments,
                                             std::vector<std::string> words);

/// Throws Error{usage} naming the first required argument that has no value.
void require(const std::string& name, std::span<const Argument> arguments);

/// Returns an argument in a synopsis: "MAP.gpkg", "-o MAP.gpkg", "[--type T]...".
std::string synopsis(const Argument& argument);

/// Returns whether an argument takes any number of files, and so @FILE for the files that a text file lists.
bool takes_list(const Argument& argument);

/// Returns the long name, else the short one, else the placeholder of a positional word.
std::string display_name(const Argument& argument);

}  // namespace waymark::apps
