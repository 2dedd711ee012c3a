// SPDX-License-Identifier: Apache-2.0
#include "workflows/call_resources.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <set>
#include <sstream>

#include "core/error.hpp"
#include "workflows/parse_number.hpp"

namespace waymark::workflows {
namespace {

using pipeline::CallResources;

[[noreturn]] void refuse_resources(const std::string& problem, const std::string& text) {
  throw Error(ErrorCode::usage, problem, "--resources " + text,
              "write [STAGE:]cpus=2,memory=8G,time=90 (minutes; or time=2h)");
}

/// Returns a positive number of units; the suffix selects the unit.
std::int64_t amount(const std::string& name, std::string word, const std::map<char, std::int64_t>& units,
                    const std::string& text) {
  std::int64_t unit = 1;
  if (!word.empty() && units.contains(word.back())) {
    unit = units.at(word.back());
    word.pop_back();
  } else if (!units.contains(' ')) {
    refuse_resources(fmt::format("{}={} has no unit", name, word), text);
  }
  const std::int64_t number = parse_integer(name, word);
  if (number < 1 || number > 1'000'000'000 / unit)
    refuse_resources(fmt::format("{}={} is no amount", name, word), text);
  return number * unit;
}

CallResources parse_words(const std::string& words, CallResources asked, const std::string& text) {
  std::istringstream rest(words);
  for (std::string word; std::getline(rest, word, ',');) {
    const std::string name = word.substr(0, word.find('='));
    const std::string value = name.size() < word.size() ? word.substr(name.size() + 1) : "";
    if (name == "cpus")
      asked.processors = static_cast<int>(amount(name, value, {{' ', 1}}, text));
    else if (name == "memory")
      asked.megabytes = amount(name, value, {{'M', 1}, {'G', 1000}}, text);
    else if (name == "time")
      asked.minutes = amount(name, value, {{' ', 1}, {'h', 60}}, text);
    else
      refuse_resources(fmt::format("'{}' is no resource", name), text);
  }
  return asked;
}

void replace_named(CallResources& resources, const CallResources& named) {
  if (named.processors > 0) resources.processors = named.processors;
  if (named.megabytes > 0) resources.megabytes = named.megabytes;
  if (named.minutes > 0) resources.minutes = named.minutes;
}

}  // namespace

std::map<std::string, CallResources> parse_resources(std::span<const std::string> texts,
                                                     std::span<const std::string> stages,
                                                     std::map<std::string, CallResources> measured) {
  std::map<std::string, CallResources> all;
  for (const bool of_stages : {false, true})
    for (const std::string& text : texts) {
      const std::size_t colon = text.find(':');
      if ((colon != std::string::npos) != of_stages) continue;
      const std::string stage = of_stages ? text.substr(0, colon) : "";
      if (of_stages && stage != "map" && std::ranges::find(stages, stage) == stages.end())
        refuse_resources(
            fmt::format("the job has no stage '{}'; it has {}, map", stage, fmt::join(stages, ", ")), text);
      const CallResources general = all.contains("") ? all.at("") : CallResources{};
      if (!all.emplace(stage, parse_words(of_stages ? text.substr(colon + 1) : text, general, text)).second)
        refuse_resources(of_stages ? fmt::format("'{}' is given twice", stage) : "all calls are given twice",
                         text);
    }
  for (auto& [stage, resources] : measured) {
    const auto own = all.contains(stage) ? all.find(stage) : all.find("");
    if (own != all.end()) replace_named(resources, own->second);
    all[stage] = resources;
  }
  return all;
}

}  // namespace waymark::workflows
