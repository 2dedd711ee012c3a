// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>
namespace waymark::exporters {

/// Consecutive tiles of equal content, or a leaf directory if `run` is 0.
struct PmtilesEntry {
  std::uint64_t id = 0;      ///< of the first tile
  std::uint64_t offset = 0;  ///< in the section of tiles, or of leaf directories
  std::uint32_t length = 0;  ///< bytes, > 0
  std::uint32_t run = 1;     ///< number of tiles
};

/// What the header of an archive says of its tiles.
struct PmtilesHeader {
  enum class Tiles : std::uint8_t { vector = 1, png = 2 };
  Tiles tiles = Tiles::vector;
  bool gzipped = true;  ///< the content of each tile
  int min_zoom = 0, max_zoom = 0;
  std::array<double, 4> bounds{-180, -85.0511, 180, 85.0511};  ///< west, south, east, north; degrees
  std::array<double, 2> centre{0, 0};                          ///< degrees
  int centre_zoom = 0;
  std::string metadata = "{}";  ///< a JSON object
};

/// Archive of tiles for servers of plain files with range requests (PMTiles 3).
/// - Tiles are streamed: memory is about 200 bytes per tile. Equal tiles are stored once.
/// - Directories and metadata follow the tiles, which the format allows; the root directory is in the first
///   16,384 bytes.
class PmtilesFile {
 public:
  /// Throws Error{output} if `file`, which lies aside, cannot be made; `output` is what messages name.
  PmtilesFile(const std::filesystem::path& file, std::filesystem::path output);

  /// Appends a tile that is not empty; ids ascend.
  void add(std::uint64_t id, std::string_view content);
  /// Writes directories, metadata and header. Throws Error{output} if not all of the file could be written.
  void finish(const PmtilesHeader& header);

  std::uint64_t tile_count() const { return tiles_; }

 private:
  void check();

  std::filesystem::path output_;
  std::ofstream file_;
  std::vector<PmtilesEntry> entries_;
  std::unordered_map<std::string, std::uint64_t> offsets_;  ///< by SHA-256 of the content
  std::uint64_t bytes_ = 0, tiles_ = 0, contents_ = 0;
};

}  // namespace waymark::exporters
