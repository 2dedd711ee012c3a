// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "apps/registry_reference.hpp"
#include "core/options/option_table.hpp"

namespace waymark::apps {
namespace {

using Object = nlohmann::ordered_json;
using workflows::DetectionMethod;
using workflows::ImageDetectorSpec;

std::string entry_name(const ImageDetectorSpec& detector) {
  return "image_" + detector.name;
}

/// Returns "imagery (image), peaks (heights)".
std::string methods_with_records(const ImageDetectorSpec& detector) {
  std::string text;
  for (const DetectionMethod& method : detector.methods)
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", method.name, method.record);
  return text;
}

std::string image_detector_text(const ImageDetectorSpec& detector) {
  std::string text = fmt::format(
      "{}: {}\n\nCommand     waymark detect {}\nMakes       {}\nMethods     {}, each with what it reads\n",
      entry_name(detector), detector.summary, detector.name, detector.type, methods_with_records(detector));
  const std::vector<OptionRow> settings = workflows::settings_of(detector);
  return settings.empty() ? text : text + "\nSettings:\n" + options_as_text(settings);
}

std::string image_detector_markdown(const ImageDetectorSpec& detector) {
  std::string text = fmt::format(
      "# {}\n\n{}.\n\n| | |\n|---|---|\n| command | `waymark detect {}` |\n| makes | {} |\n| methods, each "
      "with "
      "what it reads | {} |\n",
      entry_name(detector), detector.summary, detector.name, detector.type, methods_with_records(detector));
  for (const OptionRow& row : settings_of(detector))
    text += fmt::format("| `{}` | {} |\n", row.name, row.field.help);
  return text;
}

std::string image_detector_json(const ImageDetectorSpec& detector) {
  Object object{{"name", entry_name(detector)},
                {"summary", detector.summary},
                {"command", "detect " + detector.name},
                {"types", {detector.type}},
                {"methods", Object::object()}};
  for (const DetectionMethod& method : detector.methods) object["methods"][method.name] = method.record;
  object["settings"] = Object::parse(option_schemas(settings_of(detector)));
  return object.dump(2);
}

std::string image_detector_schema(const ImageDetectorSpec& detector) {
  return Object{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                {"title", entry_name(detector)},
                {"description", detector.summary},
                {"type", "object"},
                {"properties", Object::parse(option_schemas(settings_of(detector)))}}
      .dump(2);
}

}  // namespace

std::vector<ReferenceEntry> registry_reference(const workflows::ImageDetectorTable& detectors) {
  std::vector<ReferenceEntry> all;
  for (const ImageDetectorSpec& one : detectors)
    all.push_back({entry_name(one), one.summary, image_detector_text(one), image_detector_json(one),
                   image_detector_schema(one), image_detector_markdown(one)});
  return all;
}

}  // namespace waymark::apps
