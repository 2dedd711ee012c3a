// SPDX-License-Identifier: Apache-2.0
#include "exporters/report/script_policy.hpp"

#include <fmt/format.h>

#include <charconv>

#include "exporters/report/base64.hpp"
#include "pipeline/engine/sha256.hpp"

namespace waymark::exporters {

std::string script_policy(std::string_view script) {
  const std::string hex = pipeline::sha256(script);
  std::string hash;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    unsigned byte = 0;
    std::from_chars(hex.data() + i, hex.data() + i + 2, byte, 16);
    hash += static_cast<char>(byte);
  }
  return fmt::format(
      "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'; script-src 'sha256-{}'; "
      "style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none';\">",
      base64(hash));
}

std::string script_data(std::string_view json) {
  std::string data;
  data.reserve(json.size());
  for (const char c : json)
    if (c == '<')
      data += "\\u003c";
    else
      data += c;
  return data;
}

}  // namespace waymark::exporters
