// SPDX-License-Identifier: Apache-2.0
#include "workflows/training/model_source.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exporters/staging_folder.hpp"

namespace waymark::workflows {
std::string model_as_source(const std::string& text, const ModelSource& source) {
  std::string code = fmt::format(
      "// SPDX-License-Identifier: Apache-2.0\n"
      "// Made by `{}`; do not edit.\n"
      "// clang-format off\n"
      "#include \"{}\"\n\nnamespace waymark {{\n\n"
      "const {}& {}() {{\n"
      "  static const {} model = {}(\n",
      source.made_by, source.header, source.type, source.name, source.type, source.parse);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t line = text.find('\n', begin);
    const std::size_t end = std::min(begin + source.line, line == std::string::npos ? text.size() : line);
    const bool ends_line = end == line;
    code += fmt::format("      \"{}{}\"\n", text.substr(begin, end - begin), ends_line ? "\\n" : "");
    begin = ends_line ? end + 1 : end;
  }
  return code +
         fmt::format("      , \"{}\");\n  return model;\n}}\n\n}}  // namespace waymark\n", source.where);
}

void write_model(const std::string& path, const std::string& text, const ModelSource& source) {
  exporters::write_file(path, path.ends_with(".cpp") ? model_as_source(text, source) : text);
}

}  // namespace waymark::workflows
