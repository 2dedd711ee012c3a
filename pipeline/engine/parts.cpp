// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/parts.hpp"

#include "core/bytes.hpp"

namespace waymark::pipeline {

std::string encode_parts(const EncodedParts& parts) {
  std::vector<std::uint64_t> lengths;
  for (const EncodedParts::Part& part : parts.all) lengths.push_back(part.bytes);
  ByteWriter header;
  header(lengths);
  std::string bytes = header.take();
  for (const EncodedParts::Part& part : parts.all) bytes += part.read();
  return bytes;
}

EncodedParts decode_parts(std::string_view bytes) {
  std::vector<std::uint64_t> lengths;
  ByteReader in(bytes);
  in(lengths);
  bytes.remove_prefix((1 + lengths.size()) * sizeof(std::uint64_t));
  EncodedParts parts;
  for (const std::uint64_t length : lengths) {
    if (length > bytes.size()) throw std::runtime_error("artifact ends too early");
    parts.all.push_back({length, [held = std::string(bytes.substr(0, length))] { return held; }});
    bytes.remove_prefix(length);
  }
  if (!bytes.empty())
    throw std::runtime_error("artifact has " + std::to_string(bytes.size()) + " bytes too many");
  return parts;
}

}  // namespace waymark::pipeline
