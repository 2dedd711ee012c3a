// SPDX-License-Identifier: Apache-2.0
#include "apps/registry_reference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "pipeline/engine/stage_pages.hpp"

namespace waymark::apps {
namespace {

const std::string& form(const ReferenceEntry& one, const std::string& as) {
  return as == "json" ? one.json : as == "schema" ? one.schema : as == "markdown" ? one.markdown : one.text;
}

std::string with_end(const std::string& text) {
  return text.ends_with('\n') ? text : text + '\n';
}

const ReferenceEntry& find(std::span<const ReferenceEntry> all, const std::string& kind,
                           const std::string& name) {
  std::vector<std::string> names;
  for (const ReferenceEntry& one : all) {
    if (one.name == name) return one;
    names.push_back(one.name);
  }
  const std::string nearest = nearest_name(name, names);
  throw Error(ErrorCode::usage, "there is no " + kind + " '" + name + "'", "",
              nearest.empty() ? "without a name all are listed" : "did you mean '" + nearest + "'?");
}

std::string list(std::span<const ReferenceEntry> all) {
  std::size_t width = 0;
  for (const ReferenceEntry& one : all) width = std::max(width, one.name.size());
  std::string text;
  for (const ReferenceEntry& one : all) text += fmt::format("{:<{}}  {}\n", one.name, width, one.summary);
  return text;
}

std::string everything(std::span<const ReferenceEntry> all, const std::string& as) {
  if (as == "text") return list(all);
  if (as == "markdown") {
    std::string pages;
    for (const ReferenceEntry& one : all) pages += (pages.empty() ? "" : "\n") + with_end(one.markdown);
    return pages;
  }
  auto by_name = nlohmann::ordered_json::object();
  for (const ReferenceEntry& one : all) by_name[one.name] = nlohmann::ordered_json::parse(form(one, as));
  return by_name.dump(2) + "\n";
}

}  // namespace

std::vector<ReferenceEntry> registry_reference(const pipeline::Registry& stages) {
  std::vector<ReferenceEntry> all;
  for (const std::string& name : stages.names()) {
    const pipeline::Step& step = stages.at(name);
    all.push_back({name, step.spec().summary, pipeline::stage_as_text(step), pipeline::stage_as_json(step),
                   pipeline::stage_as_schema(step), pipeline::stage_as_markdown(step)});
  }
  return all;
}

std::vector<Argument> reference_arguments(ReferenceRequest& what, std::vector<std::string> names) {
  return {Argument{"", "NAME", &what.name, "Only this one, in full"}.offering(std::move(names)),
          Argument{"--format", "FORMAT", &what.format, "How to print it"}
              .one_of({"text", "json", "schema", "markdown"})
              .or_else("text")
              .also("--as")};
}

void print_reference(std::span<const ReferenceEntry> all, const std::string& kind,
                     const ReferenceRequest& what) {
  std::cout << with_end(what.name.empty() ? everything(all, what.format)
                                          : form(find(all, kind, what.name), what.format));
}

}  // namespace waymark::apps
