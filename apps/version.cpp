// SPDX-License-Identifier: Apache-2.0
#include "apps/version.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "workflows/build_details.hpp"
#include "workflows/provenance.hpp"

namespace waymark::apps {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::string version_as_text() {
  const workflows::BuildDetails build = workflows::build_details();
  std::string text = workflows::program_version() + "\n";
  const auto line = [&](const std::string& name, const std::string& value) {
    text += fmt::format("  {:<10} {}\n", name, value);
  };
  line("compiler",
       fmt::format("{}, {}, {}", build.compiler,
                   build.build_type.empty() ? "no build type" : build.build_type, build.processor));
  for (const auto& [name, version] : build.libraries) line(name, version.empty() ? "no" : version);
  for (const auto& [name, is_there] : build.decompressors) line(name, is_there ? "yes" : "no");
  return text;
}

std::string version_as_json() {
  const workflows::BuildDetails build = workflows::build_details();
  Json libraries = Json::object(), decompressors = Json::object();
  for (const auto& [name, version] : build.libraries)
    libraries[name] = version.empty() ? Json(nullptr) : Json(version);
  for (const auto& [name, is_there] : build.decompressors) decompressors[name] = is_there;
  const Json all{{"version", build.version},       {"compiler", build.compiler},
                 {"build_type", build.build_type}, {"processor", build.processor},
                 {"libraries", libraries},         {"decompressors", decompressors}};
  return all.dump(2) + "\n";
}

}  // namespace waymark::apps
