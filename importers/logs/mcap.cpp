// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <map>
#include <stdexcept>

#include "core/error.hpp"
#include "importers/logs/bag_file.hpp"
#include "importers/logs/mcap_chunk.hpp"
#include "importers/vsi_file.hpp"

namespace waymark::importers {
namespace {

constexpr std::uint64_t kRecordHead = 9;  // opcode and length
enum Opcode : unsigned char { kSchema = 3, kChannel = 4, kMessage = 5, kChunk = 6, kDataEnd = 15 };

static_assert(std::endian::native == std::endian::little, "numbers of MCAP are little-endian");

/// Fields of a record. Throws std::runtime_error if it ends too early.
class McapFields {
 public:
  explicit McapFields(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  T number() {
    T value;
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  std::string_view text() { return bytes(number<std::uint32_t>()); }
  std::string_view bytes(std::uint64_t size) {
    if (size > rest_.size()) throw std::runtime_error("a record ends too early");
    const std::string_view taken = rest_.substr(0, static_cast<std::size_t>(size));
    rest_.remove_prefix(taken.size());
    return taken;
  }
  std::string_view rest() const { return rest_; }

 private:
  std::string_view rest_;
};

class McapReader {
 public:
  explicit McapReader(const BagVisitor& visit) : visit_(visit) {}

  void record(unsigned char opcode, std::string_view content, bool in_chunk) {
    McapFields fields(content);
    if (opcode == kSchema) {
      const auto id = fields.number<std::uint16_t>();
      schemas_[id] = fields.text();
    } else if (opcode == kChannel) {
      channel(fields);
    } else if (opcode == kMessage) {
      message(fields);
    } else if (opcode == kChunk) {
      if (in_chunk) throw std::runtime_error("a chunk contains a chunk");
      chunk(fields);
    }
  }

 private:
  struct Channel {
    std::string topic, type;
  };

  void channel(McapFields& fields) {
    const auto id = fields.number<std::uint16_t>(), schema = fields.number<std::uint16_t>();
    const std::string_view topic = fields.text(), encoding = fields.text();
    const auto type = schemas_.find(schema);
    Channel& channel = channels_[id];
    channel = {std::string(topic), type == schemas_.end() ? "" : type->second};
    if (encoding != "cdr") channel.type += fmt::format(" (encoded as {})", encoding);
  }

  void message(McapFields& fields) {
    const auto channel = channels_.find(fields.number<std::uint16_t>());
    if (channel == channels_.end()) throw std::runtime_error("a message has no channel");
    fields.number<std::uint32_t>();  // sequence
    const auto received = fields.number<std::uint64_t>();
    fields.number<std::uint64_t>();  // published
    visit_({.topic = channel->second.topic,
            .type = channel->second.type,
            .received = static_cast<std::int64_t>(received),
            .bytes = fields.rest()});
  }

  void chunk(McapFields& fields) {
    fields.bytes(16);  // first and last time
    const auto size = fields.number<std::uint64_t>();
    fields.bytes(4);  // CRC
    const std::string_view compression = fields.text();
    std::string_view content = fields.bytes(fields.number<std::uint64_t>());
    std::string unpacked;
    if (!compression.empty() && !content.empty())
      content = unpacked = unpacked_chunk(compression, content, size);
    McapFields records(content);
    while (!records.rest().empty()) {
      const auto opcode = records.number<unsigned char>();
      record(opcode, records.bytes(records.number<std::uint64_t>()), true);
    }
  }

  const BagVisitor& visit_;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Channel> channels_;
};

}  // namespace

std::vector<std::string> visit_mcap(const std::filesystem::path& file, const BagVisitor& visit) {
  VsiFile in(file.string());
  const std::uint64_t size = in.size();
  const auto read = [&](std::uint64_t offset, std::string& into) {
    return in.read(offset, into.data(), into.size()) == into.size();
  };
  std::string content(kMcapMagic.size(), '\0');
  if (!read(0, content) || content != kMcapMagic)
    throw Error(ErrorCode::input, "the file does not begin like an MCAP file", file.string(),
                "check the path; MCAP of format version 0 is read");
  McapReader reader(visit);
  std::string head(kRecordHead, '\0');
  std::uint64_t at = kMcapMagic.size();
  while (size - at >= kRecordHead && read(at, head)) {
    McapFields fields(head);
    const auto opcode = fields.number<unsigned char>();
    const auto length = fields.number<std::uint64_t>();
    if (opcode == kDataEnd) return {};
    if (length > size - at - kRecordHead) break;
    content.resize(static_cast<std::size_t>(length));
    if (!read(at + kRecordHead, content)) break;
    try {
      reader.record(opcode, content, false);
    } catch (const std::runtime_error& problem) {
      throw Error(ErrorCode::input,
                  fmt::format("the MCAP record at byte {} cannot be read: {}", at, problem.what()),
                  file.string(),
                  "chunks compressed by zstd and lz4 are read; `mcap recover` writes a copy without damage");
    }
    at += kRecordHead + length;
  }
  return {fmt::format("{} is cut off after byte {}; what is before is read", file.filename().string(), at)};
}

}  // namespace waymark::importers
