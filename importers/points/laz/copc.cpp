// SPDX-License-Identifier: Apache-2.0
#include "importers/points/laz/copc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "core/error.hpp"
#include "importers/vsi_file.hpp"

namespace waymark::importers {
namespace {

constexpr std::size_t kInfoBytes = 160, kEntryBytes = 32;
constexpr int kMaxLevel = 30;
constexpr std::int32_t kPage = -1;  // number of points of an entry that names a page of more entries

struct Entry {
  std::array<std::int32_t, 4> key{};  // level, x, y, z
  std::uint64_t offset = 0;
  std::int32_t bytes = 0, points = 0;
};
static_assert(sizeof(Entry) == kEntryBytes);

struct Page {
  std::uint64_t offset = 0, bytes = 0;
};

[[noreturn]] void refuse_hierarchy(const LasHeader& header, const std::string& problem) {
  throw Error(ErrorCode::input, "the hierarchy of the COPC file is damaged: " + problem, header.path,
              "copy or download it again");
}

std::vector<Entry> entries_of(VsiFile& file, const Page& page, const LasHeader& header) {
  const std::uint64_t size = file.size();
  if (page.bytes == 0 || page.bytes % kEntryBytes != 0 || page.offset > size ||
      page.bytes > size - page.offset)
    refuse_hierarchy(header, fmt::format("a page of {} bytes at {} of {}", page.bytes, page.offset, size));
  std::vector<Entry> entries(static_cast<std::size_t>(page.bytes / kEntryBytes));
  if (file.read(page.offset, entries.data(), static_cast<std::size_t>(page.bytes)) != page.bytes)
    refuse_hierarchy(header, "a page ends early");
  return entries;
}

void check_entry(const Entry& entry, std::uint64_t size, const LasHeader& header) {
  const auto& [level, x, y, z] = entry.key;
  bool inside = level >= 0 && level <= kMaxLevel;
  for (const std::int32_t i : {x, y, z}) inside = inside && i >= 0 && i < std::int64_t{1} << level;
  if (!inside) refuse_hierarchy(header, fmt::format("no node {}-{}-{}-{} exists", level, x, y, z));
  const bool room = entry.bytes >= 0 && entry.offset <= size &&
                    static_cast<std::uint64_t>(entry.bytes) <= size - entry.offset;
  const bool holds =
      entry.points <= 0 || (entry.bytes >= header.point_length && entry.offset >= header.first_point);
  if (entry.points < kPage || !room || !holds)
    refuse_hierarchy(header, fmt::format("node {}-{}-{}-{} would have {} points in {} bytes at {} of {}",
                                         level, x, y, z, entry.points, entry.bytes, entry.offset, size));
}

CopcNode node_of(const Entry& entry, const LasHeader& header) {
  CopcNode node;
  node.chunk = {entry.offset, static_cast<std::uint64_t>(entry.bytes),
                static_cast<std::uint64_t>(entry.points)};
  node.level = entry.key[0];
  const CopcRecord& copc = *header.copc;
  const double side = std::ldexp(2 * copc.half_side, -node.level);
  for (std::size_t i = 0; i < 3; ++i) {
    node.low[i] = copc.centre[i] - copc.half_side + side * entry.key[i + 1];
    node.high[i] = node.low[i] + side;
  }
  return node;
}

}  // namespace

std::optional<CopcRecord> copc_record(const std::vector<unsigned char>& body) {
  if (body.size() < kInfoBytes) return std::nullopt;
  CopcRecord record;
  std::memcpy(record.centre.data(), body.data(), sizeof record.centre);
  std::memcpy(&record.half_side, body.data() + 24, sizeof record.half_side);
  std::memcpy(&record.root_offset, body.data() + 40, sizeof record.root_offset);
  std::memcpy(&record.root_bytes, body.data() + 48, sizeof record.root_bytes);
  return record;
}

std::vector<CopcNode> read_copc_nodes(const LasHeader& header) {
  const CopcRecord& copc = *header.copc;
  bool finite = std::isfinite(copc.half_side) && copc.half_side > 0;
  for (const double c : copc.centre) finite = finite && std::isfinite(c);
  if (!finite) refuse_hierarchy(header, fmt::format("its cube has a half side of {}", copc.half_side));
  VsiFile file(header.path);
  std::vector<CopcNode> nodes;
  std::vector<Page> pages{{copc.root_offset, copc.root_bytes}};
  std::set<std::uint64_t> seen{copc.root_offset};
  std::set<std::array<std::int32_t, 4>> keys;
  std::uint64_t points = 0;
  while (!pages.empty()) {
    const Page page = pages.back();
    pages.pop_back();
    for (const Entry& entry : entries_of(file, page, header)) {
      check_entry(entry, file.size(), header);
      if (entry.points == kPage) {
        if (!seen.insert(entry.offset).second) refuse_hierarchy(header, "a page is named twice");
        pages.push_back({entry.offset, static_cast<std::uint64_t>(entry.bytes)});
        continue;
      }
      if (!keys.insert(entry.key).second)
        refuse_hierarchy(header, fmt::format("node {}-{}-{}-{} is named twice", entry.key[0], entry.key[1],
                                             entry.key[2], entry.key[3]));
      points += static_cast<std::uint64_t>(entry.points);
      if (entry.points > 0) nodes.push_back(node_of(entry, header));
    }
  }
  if (points != header.points)
    refuse_hierarchy(header,
                     fmt::format("its nodes hold {} points, the header states {}", points, header.points));
  std::ranges::sort(nodes, [](const CopcNode& a, const CopcNode& b) {
    return std::pair(a.level, a.chunk.offset) < std::pair(b.level, b.chunk.offset);
  });
  return nodes;
}

}  // namespace waymark::importers
