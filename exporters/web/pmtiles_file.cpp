// SPDX-License-Identifier: Apache-2.0
#include "exporters/web/pmtiles_file.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

#include "core/output_error.hpp"
#include "exporters/web/gzip.hpp"
#include "exporters/web/varint.hpp"
#include "pipeline/engine/sha256.hpp"

namespace waymark::exporters {
namespace {

constexpr std::size_t kHeader = 127, kFirstPart = 16384;  // bytes; the root directory lies in the first part

constexpr std::size_t kMaxPlainRoot = 16384;  // entries; more never fit into the bytes of a root
constexpr std::size_t kLeafEntries = 4096;    // at first

void put_number(std::string& bytes, std::uint64_t value, int size) {
  for (int i = 0; i < size; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xff);
}

void append_degrees(std::string& bytes, double degrees) {
  put_number(bytes, static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(degrees * 1e7))), 4);
}

/// Directories of an archive, both compressed by gzip.
struct PmtilesDirectories {
  std::string root, leaves;
};

/// Returns one directory (PMTiles 3, section 4), not compressed.
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

/// Divides entries, ascending by id, into a root directory of at most `max_root` bytes and leaf directories;
/// without leaves if the root can hold all.
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

}  // namespace

PmtilesFile::PmtilesFile(const std::filesystem::path& file, std::filesystem::path output)
    : output_(std::move(output)), file_(file, std::ios::binary) {
  check();
  file_ << std::string(kFirstPart, '\0');
}

void PmtilesFile::check() {
  if (!file_) fail_output(output_, "the tiles were not written");
}

void PmtilesFile::add(std::uint64_t id, std::string_view content) {
  assert(!content.empty() && (entries_.empty() || id >= entries_.back().id + entries_.back().run));
  ++tiles_;
  const auto [known, is_new] = offsets_.try_emplace(pipeline::sha256(content), bytes_);
  const auto length = static_cast<std::uint32_t>(content.size());
  if (is_new) {
    file_.write(content.data(), static_cast<std::streamsize>(content.size()));
    check();
    bytes_ += length;
    ++contents_;
  } else if (PmtilesEntry& last = entries_.back(); last.offset == known->second && id == last.id + last.run) {
    ++last.run;
    return;
  }
  entries_.push_back({id, known->second, length, 1});
}

void PmtilesFile::finish(const PmtilesHeader& header) {
  const PmtilesDirectories directories = make_directories(entries_, kFirstPart - kHeader);
  const std::string metadata = gzip(header.metadata);
  file_ << directories.leaves << metadata;
  std::string head = "PMTiles";
  head += '\3';
  const std::uint64_t leaves = kFirstPart + bytes_, about = leaves + directories.leaves.size();
  for (const std::uint64_t number :
       {std::uint64_t{kHeader}, std::uint64_t{directories.root.size()}, about, std::uint64_t{metadata.size()},
        leaves, std::uint64_t{directories.leaves.size()}, std::uint64_t{kFirstPart}, bytes_, tiles_,
        std::uint64_t{entries_.size()}, contents_})
    put_number(head, number, 8);
  constexpr int clustered = 1, none = 1, gzipped = 2;
  for (const int byte : {clustered, gzipped, header.gzipped ? gzipped : none, static_cast<int>(header.tiles),
                         header.min_zoom, header.max_zoom})
    put_number(head, static_cast<std::uint64_t>(byte), 1);
  for (const double degrees : header.bounds) append_degrees(head, degrees);
  put_number(head, static_cast<std::uint64_t>(header.centre_zoom), 1);
  for (const double degrees : header.centre) append_degrees(head, degrees);
  file_.seekp(0);
  file_ << head << directories.root;
  file_.close();
  check();
}

}  // namespace waymark::exporters
