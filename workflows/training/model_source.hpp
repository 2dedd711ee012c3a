// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <string>
namespace waymark::workflows {

/// Names in the source file that a trained model is written as.
struct ModelSource {
  std::string made_by;     ///< the command, for people
  std::string header;      ///< that declares the function
  std::string type;        ///< what the function returns a reference to
  std::string name;        ///< of the function
  std::string parse;       ///< function that parses the model's text
  std::string where;       ///< name of the text in error messages
  std::size_t line = 140;  ///< characters of the text per line: a source file has at most 300 lines
};

/// Returns the source of a function that parses `text` once.
std::string model_as_source(const std::string& text, const ModelSource& source);

/// Writes a model, as source if the name ends in .cpp. Throws Error{output}.
void write_model(const std::string& path, const std::string& text, const ModelSource& source);

}  // namespace waymark::workflows
