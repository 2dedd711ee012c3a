// SPDX-License-Identifier: Apache-2.0
#include "tests/support/laz_writer.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "tests/support/laz_chunk.hpp"

namespace waymark::test {
namespace {

template <class T>
void put_at(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}
template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string record_of(const char* owner, std::uint16_t id, const std::string& body) {
  std::string record(54, '\0');
  std::memcpy(record.data() + 2, owner, std::strlen(owner));
  put_at(record, 18, id), put_at(record, 20, static_cast<std::uint16_t>(body.size()));
  return record + body;
}

std::string crs_record(int epsg) {
  std::string keys;
  for (const int k : {1, 1, 0, 1, 3072, 0, 1, epsg}) append(keys, static_cast<std::uint16_t>(k));
  return record_of("LASF_Projection", 34735, keys);
}

std::string compression_record(const LazFile& file) {
  const bool layered = file.format >= 6;
  struct Item {
    int type, size, version;
  };
  std::vector<Item> items{layered ? Item{10, 30, 3} : Item{6, 20, 2}};
  const int f = file.format;
  if (!layered && f != 0 && f != 2) items.push_back({7, 8, 2});
  if (f == 2 || f == 3 || f == 5) items.push_back({8, 6, 2});
  if (f == 7) items.push_back({11, 6, 3});
  if (f == 8 || f == 10) items.push_back({12, 8, 3});
  if (f == 4 || f == 5) items.push_back({9, 29, 1});
  if (f == 9 || f == 10) items.push_back({13, 29, 3});
  if (file.extra_bytes > 0) items.push_back({layered ? 14 : 0, file.extra_bytes, layered ? 3 : 2});
  std::string body(34, '\0');
  put_at(body, 0, static_cast<std::uint16_t>(layered ? 3 : file.whole ? 1 : 2));
  put_at(body, 4, std::uint32_t{0x03});
  const std::size_t usual = file.chunks.empty() ? 50000 : file.chunks[0].size();
  put_at(body, 12, file.variable ? 0xFFFFFFFFU : static_cast<std::uint32_t>(usual));
  put_at(body, 16, std::int64_t{-1}), put_at(body, 24, std::int64_t{-1});
  put_at(body, 32, static_cast<std::uint16_t>(items.size()));
  for (const Item& item : items)
    for (const int n : {item.type, item.size, item.version}) append(body, static_cast<std::uint16_t>(n));
  return record_of("laszip encoded", 22204, body);
}

// Returns the header and the records before the points.
std::string head_of(const LazFile& file, const std::vector<std::string>& records, bool compressed) {
  const bool extended = file.format >= 6;
  std::string h(extended ? 375 : 227, '\0');
  std::memcpy(h.data(), "LASF", 4);
  h[24] = 1, h[25] = extended ? 4 : 2;
  put_at(h, 94, static_cast<std::uint16_t>(h.size()));
  h[104] = static_cast<char>(file.format | (compressed ? 0x80 : 0));
  put_at(h, 105, static_cast<std::uint16_t>(point_length(file.format, file.extra_bytes)));
  std::uint64_t count = 0, first_returns = 0;
  std::array<double, 3> low, high;
  low.fill(1e300), high.fill(-1e300);
  for (const auto& chunk : file.chunks)
    for (const RawPoint& p : chunk) {
      ++count, first_returns += p.number == 1;
      for (std::size_t i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], file.origin[i] + file.scale * p.at[i]);
        high[i] = std::max(high[i], file.origin[i] + file.scale * p.at[i]);
      }
    }
  for (std::size_t i = 0; i < 3; ++i) {
    put_at(h, 131 + 8 * i, file.scale), put_at(h, 155 + 8 * i, file.origin[i]);
    put_at(h, 179 + 16 * i, high[i]), put_at(h, 187 + 16 * i, low[i]);
  }
  if (extended) put_at(h, 247, count), put_at(h, 255, first_returns);
  if (!extended)
    put_at(h, 107, static_cast<std::uint32_t>(count)),
        put_at(h, 111, static_cast<std::uint32_t>(first_returns));
  put_at(h, 100, static_cast<std::uint32_t>(records.size()));
  for (const std::string& record : records) h += record;
  put_at(h, 96, static_cast<std::uint32_t>(h.size()));
  return h;
}

// Appends the position of the table, the chunks and the table.
void append_chunks(std::string& bytes, const LazFile& file) {
  if (file.whole) {
    bytes += laz_chunk(file.chunks.at(0), file.format, file.extra_bytes);
    return;
  }
  const std::size_t first = bytes.size();
  append(bytes, std::int64_t{-1});
  std::vector<std::uint32_t> sizes, counts;
  for (const auto& chunk : file.chunks) {
    const std::string one = laz_chunk(chunk, file.format, file.extra_bytes);
    sizes.push_back(static_cast<std::uint32_t>(one.size()));
    counts.push_back(static_cast<std::uint32_t>(chunk.size()));
    bytes += one;
  }
  const auto table = static_cast<std::int64_t>(bytes.size());
  append(bytes, std::uint32_t{0}), append(bytes, static_cast<std::uint32_t>(file.chunks.size()));
  bytes += laz_table(sizes, counts, file.variable);
  file.table_at_end ? append(bytes, table) : put_at(bytes, first, table);
}

using Key = std::array<std::int32_t, 4>;  // level, x, y, z
struct Node {
  std::uint64_t offset = 0;
  std::int32_t bytes = 0, points = 0;
};

std::string entry_of(const Key& key, const Node& node) {
  std::string entry;
  for (const std::int32_t k : key) append(entry, k);
  append(entry, node.offset), append(entry, node.bytes), append(entry, node.points);
  return entry;
}

}  // namespace

int point_length(int format, int extra_bytes) {
  constexpr std::array<int, 11> kLength{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  return kLength.at(static_cast<std::size_t>(format)) + extra_bytes;
}

std::string las_record(const RawPoint& p, int format, int extra_bytes) {
  std::string r(static_cast<std::size_t>(point_length(format, extra_bytes)), '\0');
  for (std::size_t i = 0; i < 3; ++i) put_at(r, 4 * i, p.at[i]);
  put_at(r, 12, p.intensity);
  if (format >= 6) {
    r[14] = static_cast<char>(p.number | p.returns << 4);
    r[15] = static_cast<char>((p.flags & 15) | p.channel << 4 | (p.flags >> 4) << 6);
    r[16] = static_cast<char>(p.classification), r[17] = static_cast<char>(p.user_data);
    put_at(r, 18, p.angle), put_at(r, 20, p.source), put_at(r, 22, p.time);
    return r;
  }
  r[14] = static_cast<char>(p.number | p.returns << 3 | (p.flags >> 4) << 6);
  r[15] = static_cast<char>((p.classification & 31) | (p.flags & 7) << 5);
  r[16] = static_cast<char>(p.angle), r[17] = static_cast<char>(p.user_data);
  put_at(r, 18, p.source);
  if (format != 0 && format != 2) put_at(r, 20, p.time);
  return r;
}

std::string laz_bytes(const LazFile& file) {
  std::string bytes = head_of(file, {crs_record(file.epsg), compression_record(file)}, true);
  append_chunks(bytes, file);
  return bytes;
}

std::string las_bytes(const LazFile& file) {
  std::string bytes = head_of(file, {crs_record(file.epsg)}, false);
  for (const auto& chunk : file.chunks)
    for (const RawPoint& p : chunk) bytes += las_record(p, file.format, file.extra_bytes);
  return bytes;
}

std::string copc_bytes(const LazFile& file, int levels) {
  LazFile tree = file;
  tree.variable = true;
  tree.chunks.clear();
  std::int64_t most = 1;
  std::vector<RawPoint> all;
  for (const auto& chunk : file.chunks) all.insert(all.end(), chunk.begin(), chunk.end());
  for (const RawPoint& p : all)
    for (const std::int32_t c : p.at) most = std::max<std::int64_t>(most, std::abs(std::int64_t{c}) + 1);
  std::map<Key, std::vector<RawPoint>> nodes;
  for (std::size_t i = 0; i < all.size(); ++i) {
    int level = 0;  // one point in 4^levels stays at the root
    for (std::size_t turn = i % (std::size_t{1} << 2 * (levels - 1)); turn > 0; turn /= 4) ++level;
    Key key{level};
    const std::int64_t cells = std::int64_t{1} << level;
    for (std::size_t axis = 0; axis < 3; ++axis)
      key[axis + 1] = static_cast<std::int32_t>((all[i].at[axis] + most) * cells / (2 * most));
    nodes[key].push_back(all[i]);
  }
  for (const auto& [key, points] : nodes) tree.chunks.push_back(points);

  std::string info(160, '\0');
  for (std::size_t i = 0; i < 3; ++i) put_at(info, 8 * i, file.origin[i]);
  put_at(info, 24, static_cast<double>(most) * file.scale);
  put_at(info, 32, static_cast<double>(most) * file.scale / 64);
  std::string bytes =
      head_of(tree, {record_of("copc", 1, info), crs_record(file.epsg), compression_record(tree)}, true);
  std::uint64_t offset = bytes.size() + 8;
  append_chunks(bytes, tree);

  std::map<Key, std::string> pages;  // by the node of level 1 that they belong to; the root's own
  const Key root{0, 0, 0, 0};
  for (const auto& [key, points] : nodes) {
    const auto size = laz_chunk(points, tree.format, tree.extra_bytes).size();
    Key page = root;
    if (key[0] > 0) page = {1, key[1] >> (key[0] - 1), key[2] >> (key[0] - 1), key[3] >> (key[0] - 1)};
    pages[page] +=
        entry_of(key, {offset, static_cast<std::int32_t>(size), static_cast<std::int32_t>(points.size())});
    offset += size;
  }
  bytes += std::string(60, '\0');  // head of the extended record
  for (const auto& [key, page] : pages)
    if (key != root) {
      pages[root] += entry_of(key, {bytes.size(), static_cast<std::int32_t>(page.size()), -1});
      bytes += page;
    }
  put_at(bytes, 375 + 54 + 40, std::uint64_t{bytes.size()});
  put_at(bytes, 375 + 54 + 48, std::uint64_t{pages[root].size()});
  return bytes + pages[root];
}

}  // namespace waymark::test
