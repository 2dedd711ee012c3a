// SPDX-License-Identifier: Apache-2.0
#include "apps/detection_help.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace waymark::apps {
namespace {

using workflows::DetectionMethod;
using workflows::ImageDetectorSpec;
using workflows::ImageDetectorTable;

/// Returns "a, b or c".
std::string joined_by_or(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 < words.size() ? ", " : " or ") + words[i];
  return text;
}

/// Joins clauses by commas, and by semicolons next to a clause that has commas of its own.
std::string joined_clauses(const std::vector<std::string>& clauses) {
  std::string text;
  bool has_comma = false;
  for (const std::string& clause : clauses) {
    const bool with_comma = clause.find(',') != std::string::npos;
    text += (text.empty() ? "" : has_comma || with_comma ? "; " : ", ") + clause;
    has_comma = with_comma;
  }
  return text;
}

std::string methods_of(const ImageDetectorSpec& detector) {
  std::vector<std::string> words;
  for (const DetectionMethod& method : detector.methods)
    words.push_back(method.name + (method.remark.empty() ? "" : " (" + method.remark + ")"));
  return fmt::format("{} for {}", joined_by_or(words), detector.name);
}

/// Returns "craters by bowl: " and the help of a setting.
std::string setting_help(const ImageDetectorSpec& detector, const OptionRow& row) {
  const auto methods = workflows::use_of_setting(detector, row.name).methods;
  return fmt::format("{}{}: {}", detector.name,
                     methods.empty() ? "" : fmt::format(" by {}", fmt::join(methods, " or ")),
                     row.field.help);
}

/// Returns a default that is no empty text.
std::string default_of(const OptionRow& row) {
  if (const auto* number = std::get_if<double>(&row.value)) return fmt::format("{:g}", *number);
  if (const auto* count = std::get_if<std::int64_t>(&row.value)) return std::to_string(*count);
  if (const auto* flag = std::get_if<bool>(&row.value)) return *flag ? "true" : "false";
  const auto* text = std::get_if<std::string>(&row.value);
  return text ? *text : "";
}

}  // namespace

DetectionHelp detection_help(const ImageDetectorTable& detectors) {
  std::vector<std::string> methods, defaults, chosen, smallest, largest,
      confidences{fmt::format("{:g}", workflows::kUsualConfidence)};
  DetectionHelp help;
  for (const ImageDetectorSpec& one : detectors) {
    methods.push_back(methods_of(one));
    for (const DetectionMethod& method : one.methods)
      if (std::ranges::count(help.method_names, method.name) == 0) help.method_names.push_back(method.name);
    if (one.method_by.empty())
      defaults.push_back(one.methods[0].name);
    else
      chosen.push_back(fmt::format("of {} {}", one.name, one.method_by));
    if (one.lists_sizes) {
      smallest.push_back(fmt::format("{:g} for {}", one.search.min_diameter, one.name));
      const std::string largest_text = !one.max_diameter_text.empty()
                                           ? one.max_diameter_text
                                           : fmt::format("{:g}", one.search.max_diameter);
      largest.push_back(fmt::format("{} for {}", largest_text, one.name));
    }
    if (!one.confidence_text.empty()) confidences.push_back(one.confidence_text);
  }
  chosen.insert(chosen.begin(), fmt::format("{}", fmt::join(defaults, ", ")));
  help.kinds = joined_by_or(detectors.names());
  help.methods = joined_clauses(methods);
  help.default_method = fmt::format("{}", fmt::join(chosen, "; "));
  help.min_diameter = fmt::format("{}", fmt::join(smallest, ", "));
  help.max_diameter = fmt::format("{}", fmt::join(largest, ", "));
  help.min_confidence = fmt::format("{}", fmt::join(confidences, "; "));
  return help;
}

std::vector<Argument> setting_arguments(const ImageDetectorTable& detectors,
                                        workflows::DetectRequest& request) {
  std::vector<Argument> all;
  for (const ImageDetectorSpec& one : detectors)
    for (const OptionRow& row : workflows::settings_of(one)) {
      std::string option = "--" + row.name;
      std::ranges::replace(option, '_', '-');
      const auto same = std::ranges::find(all, option, &Argument::names);
      if (same != all.end()) {
        same->help += "; " + setting_help(one, row);
        continue;
      }
      const auto use = workflows::use_of_setting(one, row.name);
      Argument argument{option, use.value, &request.settings[row.name], setting_help(one, row)};
      argument.otherwise = default_of(row);
      argument.suggestions = row.field.choices;
      if (use.is_file) argument.offer = Offer::file;
      all.push_back(std::move(argument));
    }
  return all;
}

}  // namespace waymark::apps
