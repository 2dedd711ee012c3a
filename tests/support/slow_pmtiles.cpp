// SPDX-License-Identifier: Apache-2.0
#include "slow_pmtiles.hpp"

#include <cpl_vsi.h>
#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

namespace waymark::test {
namespace {

/// Reads a message from front to end.
struct Reader {
  std::string bytes;
  std::size_t at = 0;

  bool ended() const { return at >= bytes.size(); }
  std::uint64_t varint() {
    std::uint64_t value = 0, factor = 1;
    while (true) {
      const auto byte = static_cast<unsigned char>(bytes.at(at++));
      value += factor * (byte % 128);
      if (byte < 128) return value;
      factor *= 128;
    }
  }
  std::string take(std::size_t size) {
    if (at + size > bytes.size()) throw std::runtime_error("the message ends too early");
    at += size;
    return bytes.substr(at - size, size);
  }
  template <class T>
  T plain() {
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
};

std::int64_t unzigzag(std::uint64_t n) {
  return n % 2 == 0 ? static_cast<std::int64_t>(n / 2) : -static_cast<std::int64_t>(n / 2) - 1;
}

/// Decodes the rings of a polygon, section 4.3.4.4 of the specification of vector tiles.
std::vector<std::vector<std::pair<std::int64_t, std::int64_t>>> rings_of(
    const std::vector<std::uint64_t>& geometry) {
  std::vector<std::vector<std::pair<std::int64_t, std::int64_t>>> rings;
  std::int64_t x = 0, y = 0;
  for (std::size_t at = 0; at < geometry.size();) {
    EXPECT_EQ(geometry.at(at++), 9u);  // move to, once
    rings.emplace_back();
    const auto add = [&] {
      x += unzigzag(geometry.at(at++)), y += unzigzag(geometry.at(at++));
      rings.back().emplace_back(x, y);
    };
    add();
    const std::uint64_t line = geometry.at(at++);
    EXPECT_EQ(line % 8, 2u);  // line to
    EXPECT_GE(line / 8, 2u);
    for (std::uint64_t n = line / 8; n > 0; --n) add();
    EXPECT_EQ(geometry.at(at++), 15u);  // close
  }
  return rings;
}

struct Entry {
  std::uint64_t id, run, length, offset;
};

std::vector<Entry> read_directory(const std::string& content) {
  Reader in{content};
  std::vector<Entry> entries(in.varint());
  std::uint64_t id = 0;
  for (Entry& entry : entries) entry.id = id += in.varint();
  for (Entry& entry : entries) entry.run = in.varint();
  for (Entry& entry : entries) entry.length = in.varint();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::uint64_t offset = in.varint();
    entries[i].offset = offset > 0 ? offset - 1 : entries.at(i - 1).offset + entries.at(i - 1).length;
  }
  EXPECT_TRUE(in.ended());
  return entries;
}

TileKey key_of(std::uint64_t id) {
  int zoom = 0;
  std::uint64_t first = 0;
  while (id >= first + (std::uint64_t{1} << (2 * zoom))) first += std::uint64_t{1} << (2 * zoom++);
  const std::uint64_t on_curve = id - first;
  std::uint32_t x = 0, y = 0;
  // From the innermost pair of bits outwards, as the textbook's d2xy.
  for (std::uint64_t side = 1, rest = on_curve; side < (std::uint64_t{1} << zoom); side *= 2, rest /= 4) {
    const std::uint64_t right = 1 & (rest / 2), down = 1 & (rest ^ right);
    if (down == 0) {
      if (right == 1) {
        x = static_cast<std::uint32_t>(side) - 1 - x;
        y = static_cast<std::uint32_t>(side) - 1 - y;
      }
      std::swap(x, y);
    }
    x += static_cast<std::uint32_t>(side * right);
    y += static_cast<std::uint32_t>(side * down);
  }
  return {zoom, x, y};
}

std::variant<double, std::string> read_value(const std::string& message) {
  Reader in{message};
  const std::uint64_t tag = in.varint();
  switch (tag) {
    case 1 << 3 | 2:
      return in.take(in.varint());
    case 2 << 3 | 5:
      return double(in.plain<float>());
    case 3 << 3 | 1:
      return in.plain<double>();
    case 6 << 3:
      return double(unzigzag(in.varint()));
    default:
      throw std::runtime_error("a value of kind " + std::to_string(tag));
  }
}

}  // namespace

std::string gunzip(const std::string& content) {
  VSIFCloseL(VSIFileFromMemBuffer(
      "/vsimem/slow.gz", reinterpret_cast<GByte*>(const_cast<char*>(content.data())), content.size(), FALSE));
  VSILFILE* file = VSIFOpenL("/vsigzip//vsimem/slow.gz", "r");
  std::string plain;
  char part[65536];
  for (std::size_t n; file && (n = VSIFReadL(part, 1, sizeof part, file)) > 0;) plain.append(part, n);
  if (file) VSIFCloseL(file);
  VSIUnlink("/vsimem/slow.gz");
  VSIUnlink("/vsimem/slow.gz.properties");
  return plain;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> draw_hilbert(int order) {
  if (order == 0) return {{0, 0}};
  const std::uint32_t half = 1u << (order - 1);
  const auto smaller = draw_hilbert(order - 1);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> cells;
  for (const auto& [x, y] : smaller) cells.emplace_back(y, x);
  for (const auto& [x, y] : smaller) cells.emplace_back(x, half + y);
  for (const auto& [x, y] : smaller) cells.emplace_back(half + x, half + y);
  for (const auto& [x, y] : smaller) cells.emplace_back(half + half - 1 - y, half - 1 - x);
  return cells;
}

SlowArchive read_archive(const std::string& file) {
  SlowArchive archive;
  EXPECT_EQ(file.substr(0, 8), std::string("PMTiles\3"));
  Reader head{file.substr(0, 127), 8};
  for (const char* name : {"root_offset", "root_length", "metadata_offset", "metadata_length", "leaf_offset",
                           "leaf_length", "tile_offset", "tile_length", "addressed", "entries", "contents"})
    archive.header[name] = head.plain<std::uint64_t>();
  for (const char* name : {"clustered", "internal", "compression", "type", "min_zoom", "max_zoom"})
    archive.header[name] = head.plain<std::uint8_t>();
  for (double* degrees : {&archive.west, &archive.south, &archive.east, &archive.north})
    *degrees = 1e-7 * head.plain<std::int32_t>();
  auto& h = archive.header;
  EXPECT_LE(h["root_offset"] + h["root_length"], 16384u);
  EXPECT_EQ(h["internal"], 2u);
  archive.metadata = gunzip(file.substr(h["metadata_offset"], h["metadata_length"]));

  std::vector<Entry> entries;
  for (const Entry& entry : read_directory(gunzip(file.substr(h["root_offset"], h["root_length"])))) {
    if (entry.run > 0) {
      entries.push_back(entry);
      continue;
    }
    ++archive.leaves;
    EXPECT_LE(entry.offset + entry.length, h["leaf_length"]);
    for (const Entry& leaf :
         read_directory(gunzip(file.substr(h["leaf_offset"] + entry.offset, entry.length))))
      entries.push_back(leaf);
  }
  std::uint64_t next = 0;
  for (const Entry& entry : entries) {
    EXPECT_GE(entry.id, next);
    EXPECT_LE(entry.offset + entry.length, h["tile_length"]);
    next = entry.id + entry.run;
    for (std::uint64_t id = entry.id; id < next; ++id)
      archive.tiles[key_of(id)] = file.substr(h["tile_offset"] + entry.offset, entry.length);
  }
  EXPECT_EQ(archive.tiles.size(), h["addressed"]);
  EXPECT_EQ(entries.size(), h["entries"]);
  return archive;
}

std::map<std::string, std::vector<TileFeature>> read_vector_tile(const std::string& message) {
  std::map<std::string, std::vector<TileFeature>> layers;
  for (Reader tile{message}; !tile.ended();) {
    EXPECT_EQ(tile.varint(), 3u << 3 | 2);
    Reader in{tile.take(tile.varint())};
    std::string name;
    std::vector<std::string> features, keys;
    std::vector<std::variant<double, std::string>> values;
    std::uint64_t version = 0, extent = 0;
    while (!in.ended()) {
      const std::uint64_t tag = in.varint();
      if (tag == (15 << 3)) {
        version = in.varint();
      } else if (tag == (5 << 3)) {
        extent = in.varint();
      } else {
        const std::string part = in.take(in.varint());
        if (tag == (1 << 3 | 2)) name = part;
        if (tag == (2 << 3 | 2)) features.push_back(part);
        if (tag == (3 << 3 | 2)) keys.push_back(part);
        if (tag == (4 << 3 | 2)) values.push_back(read_value(part));
      }
    }
    EXPECT_EQ(version, 2u);
    EXPECT_EQ(extent, 4096u);
    EXPECT_FALSE(layers.contains(name)) << name;
    for (const std::string& part : features) {
      TileFeature feature;
      std::vector<std::uint64_t> tags, geometry;
      std::uint64_t type = 0;
      for (Reader f{part}; !f.ended();) {
        const std::uint64_t tag = f.varint();
        if (tag == (1 << 3)) {
          feature.id = f.varint();
        } else if (tag == (3 << 3)) {
          type = f.varint();
        } else {
          for (Reader packed{f.take(f.varint())}; !packed.ended();)
            (tag == (2 << 3 | 2) ? tags : geometry).push_back(packed.varint());
        }
      }
      if (type == 3) {
        feature.rings = rings_of(geometry);
      } else {
        EXPECT_EQ(type, 1u);
        EXPECT_EQ(geometry.size(), 3u);
        EXPECT_EQ(geometry.at(0), 9u);  // move to, once
        feature.x = unzigzag(geometry.at(1));
        feature.y = unzigzag(geometry.at(2));
      }
      for (std::size_t i = 0; i + 1 < tags.size(); i += 2)
        EXPECT_TRUE(feature.properties.emplace(keys.at(tags[i]), values.at(tags[i + 1])).second);
      layers[name].push_back(feature);
    }
  }
  return layers;
}

}  // namespace waymark::test
