// SPDX-License-Identifier: Apache-2.0
#include "exporters/web/pmtiles_directory.hpp"

#include <algorithm>

#include "exporters/web/gzip.hpp"
#include "exporters/web/varint.hpp"

namespace waymark::exporters {
namespace {

constexpr std::size_t kMaxPlainRoot = 16384;  // entries; more never fit into the bytes of a root
constexpr std::size_t kLeafEntries = 4096;    // at first

PmtilesDirectories with_leaves(const std::vector<PmtilesEntry>& entries, std::size_t per_leaf) {
  PmtilesDirectories made;
  std::vector<PmtilesEntry> root;
  for (std::size_t first = 0; first < entries.size(); first += per_leaf) {
    const auto part = std::span(entries).subspan(first, std::min(per_leaf, entries.size() - first));
    const std::string leaf = gzip(encode_directory(part));
    root.push_back({part.front().id, made.leaves.size(), static_cast<std::uint32_t>(leaf.size()), 0});
    made.leaves += leaf;
  }
  made.root = gzip(encode_directory(root));
  return made;
}

}  // namespace

std::string encode_directory(std::span<const PmtilesEntry> entries) {
  std::string bytes;
  append_varint(bytes, entries.size());
  std::uint64_t previous = 0;
  for (const PmtilesEntry& entry : entries) {
    append_varint(bytes, entry.id - previous);
    previous = entry.id;
  }
  for (const PmtilesEntry& entry : entries) append_varint(bytes, entry.run);
  for (const PmtilesEntry& entry : entries) append_varint(bytes, entry.length);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    // 0: directly after the content of the previous entry.
    const bool follows = i > 0 && entries[i].offset == entries[i - 1].offset + entries[i - 1].length;
    append_varint(bytes, follows ? 0 : entries[i].offset + 1);
  }
  return bytes;
}

PmtilesDirectories make_directories(const std::vector<PmtilesEntry>& entries, std::size_t max_root) {
  if (entries.size() < kMaxPlainRoot) {
    PmtilesDirectories plain{.root = gzip(encode_directory(entries)), .leaves = {}};
    if (plain.root.size() <= max_root) return plain;
  }
  for (std::size_t per_leaf = kLeafEntries;; per_leaf += per_leaf / 4) {
    PmtilesDirectories made = with_leaves(entries, per_leaf);
    if (made.root.size() <= max_root) return made;
  }
}

}  // namespace waymark::exporters
