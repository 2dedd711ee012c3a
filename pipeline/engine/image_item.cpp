// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/image_item.hpp"

#include <fmt/format.h>

#include "core/bytes.hpp"

namespace waymark::pipeline {

std::string Codec<std::vector<ImageItem>>::encode(const std::vector<ImageItem>& images) {
  ByteWriter write;
  write(static_cast<std::uint64_t>(images.size()));
  for (const auto& [index, name, file, content] : images) {
    write(index);
    write(name);
    write(file);
    write(content);
  }
  return write.take();
}

std::vector<ImageItem> Codec<std::vector<ImageItem>>::decode(std::string_view bytes) {
  ByteReader read(bytes);
  std::vector<ImageItem> images(read.length(sizeof(std::int64_t)));
  for (auto& [index, name, file, content] : images) {
    read(index);
    read(name);
    read(file);
    read(content);
  }
  read.expect_end();
  return images;
}

std::string unit_item(const ImageItem& image) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_";
  std::string item = "image_";
  for (const char c : image.name)
    item += kPlain.find(c) == std::string_view::npos ? fmt::format("%{:02X}", static_cast<unsigned char>(c))
                                                     : std::string(1, c);
  return item;
}

}  // namespace waymark::pipeline
