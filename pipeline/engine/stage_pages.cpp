// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/stage_pages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "pipeline/engine/step_options.hpp"

namespace waymark::pipeline {
namespace {

using Json = nlohmann::ordered_json;

Json as_json(const OptionValue& value) {
  return std::visit([](const auto& v) { return Json(v); }, value);
}

/// Returns the default value as it is typed.
std::string readable_default(const OptionRow& row) {
  if (const auto* text = std::get_if<std::string>(&row.value)) return text->empty() ? "none" : *text;
  if (const auto* texts = std::get_if<std::vector<std::string>>(&row.value))
    return texts->empty() ? "none" : fmt::format("{}", fmt::join(*texts, ", "));
  if (const auto* number = std::get_if<double>(&row.value))
    return fmt::format("{}{}{}", *number, row.unit.empty() ? "" : " ", row.unit);
  return as_json(row.value).dump();
}

std::string readable_values(const OptionRow& row) {
  if (!row.field.choices.empty()) return fmt::format("{}", fmt::join(row.field.choices, ", "));
  if (const std::string range = readable_range(row); !range.empty()) return range;
  static constexpr const char* kWords[] = {"any number", "any whole number", "true or false", "text",
                                           "list of texts"};
  return kWords[row.value.index()];
}

/// Returns the ports as text, "divide_tree (DivideTree), tiles (vector<Tile>)", or "none".
template <class Ports>
std::string readable_ports(const Ports& ports) {
  std::string text;
  for (const auto& port : ports)
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", port.name, readable_type(port.type));
  return text.empty() ? "none" : text;
}

std::string readable_scope(const StageSpec& spec) {
  if (spec.lists)
    return fmt::format("the whole map; runs while planning and decides the {}s", to_string(*spec.lists));
  if (spec.scope == Scope::map) return "the whole map";
  if (spec.scope == Scope::image) return "one image";
  return spec.halo == 0 ? "one tile" : fmt::format("one tile and {} cells around it", spec.halo);
}

Json options_schema(const Step& step) {
  return Json::parse(option_schemas(option_table(step)));
}

template <class Ports>
Json ports_json(const Ports& ports) {
  Json list = Json::array();
  for (const auto& port : ports) list.push_back({{"name", port.name}, {"type", readable_type(port.type)}});
  return list;
}

/// Escapes the text of a cell of a Markdown table.
std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

}  // namespace

std::string stage_as_text(const Step& step) {
  const StageSpec& spec = step.spec();
  std::string text =
      fmt::format("{}: {}\n\n  works on  {}\n  reads     {}\n  writes    {}\n", spec.name, spec.summary,
                  readable_scope(spec), readable_ports(spec.inputs), readable_ports(spec.outputs));
  const auto rows = option_table(step);
  if (!rows.empty()) text += "\nOptions:\n";
  for (const OptionRow& row : rows)
    text += fmt::format("  {:<20} {}{}\n  {:<20} {}; default: {}\n", row.name, row.field.help,
                        former_name_remark(row), "", readable_values(row), readable_default(row));
  return text;
}

std::string stage_as_markdown(const Step& step) {
  const StageSpec& spec = step.spec();
  std::string page = fmt::format(
      "# {}\n\n{}\n\n| | |\n|---|---|\n| version | {} |\n| works on | {} |\n| reads | {} |\n| writes | {} "
      "|\n",
      spec.name, spec.summary, spec.version, readable_scope(spec), cell(readable_ports(spec.inputs)),
      cell(readable_ports(spec.outputs)));
  const auto rows = option_table(step);
  if (!rows.empty()) page += "\n| option | effect | values | default |\n|---|---|---|---|\n";
  for (const OptionRow& row : rows)
    page += fmt::format("| `{}` | {}{}{} | {} | {} |\n", row.name, cell(row.field.help),
                        row.field.affects_result ? "" : " (does not change the result)",
                        former_name_remark(row), cell(readable_values(row)), cell(readable_default(row)));
  page += fmt::format("\nIn a job file:\n\n```json\n{{\"stage\": \"{}\"", spec.name);
  for (const OptionRow& row : rows) page += fmt::format(", \"{}\": {}", row.name, as_json(row.value).dump());
  return page + "}\n```\n";
}

std::string stage_as_schema(const Step& step) {
  Json properties{{"stage", {{"const", step.spec().name}}}};
  properties.update(options_schema(step));
  return Json{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", step.spec().name},
              {"description", step.spec().summary},
              {"type", "object"},
              {"properties", properties},
              {"required", {"stage"}},
              {"additionalProperties", false}}
      .dump(2);
}

std::string stage_as_json(const Step& step) {
  const StageSpec& spec = step.spec();
  return Json{{"name", spec.name},
              {"summary", spec.summary},
              {"version", spec.version},
              {"scope", to_string(spec.scope)},
              {"lists", spec.lists ? Json(to_string(*spec.lists)) : Json(nullptr)},
              {"halo", spec.halo},
              {"inputs", ports_json(spec.inputs)},
              {"outputs", ports_json(spec.outputs)},
              {"finds", spec.finds},
              {"options", options_schema(step)}}
      .dump(2);
}

}  // namespace waymark::pipeline
