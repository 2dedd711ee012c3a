// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include "pipeline/engine/codec.hpp"
#include "pipeline/engine/store/scratch_file.hpp"
namespace waymark::pipeline {

/// Encoded parts of a value that does not fit into memory.
struct EncodedParts {
  struct Part {
    std::uint64_t bytes = 0;
    std::function<std::string()> read;  ///< owns what it reads from
  };
  std::vector<Part> all;
};

/// Sequence of T on disk, which is read part by part, any number of times. T needs a Codec. The artifact of a
/// map-scope stage whose result would not fit into memory. Copies share the parts.
template <class T>
class Parts {
 public:
  Parts() = default;
  explicit Parts(EncodedParts parts) : encoded_(std::move(parts)) {}

  std::size_t count() const { return encoded_.all.size(); }
  /// Returns one part, decoded at each call. Thread-safe.
  T read(std::size_t part) const { return Codec<T>::decode(encoded_.all.at(part).read()); }
  const EncodedParts& encoded() const { return encoded_; }

 private:
  EncodedParts encoded_;
};

/// Writes the parts of a value to a temporary file, which lives as long as the parts.
template <class T>
class PartsWriter {
 public:
  explicit PartsWriter(std::shared_ptr<ScratchFile> file) : file_(std::move(file)) {}

  void add(const T& part) { replace(parts_.all.size(), part); }
  /// Writes a part once more, or the next one. The bytes of the old one stay on the disk.
  void replace(std::size_t number, const T& part) {
    std::string bytes = Codec<T>::encode(part);
    if (number == parts_.all.size()) parts_.all.emplace_back();
    parts_.all.at(number).bytes = bytes.size();
    parts_.all[number].read = [file = file_, read = file_->put(std::move(bytes))] { return read(); };
  }
  /// Returns what is written so far.
  Parts<T> parts() const { return Parts<T>(parts_); }

 private:
  std::shared_ptr<ScratchFile> file_;
  EncodedParts parts_;
};

/// Returns all parts as one text: their number, their lengths, then their bytes.
std::string encode_parts(const EncodedParts& parts);
/// Throws std::runtime_error on malformed bytes.
EncodedParts decode_parts(std::string_view bytes);

/// For a value that must be one text; the store does without (pipeline/engine/store/parts_file.hpp).
template <class T>
struct Codec<Parts<T>> {
  static std::string encode(const Parts<T>& value) { return encode_parts(value.encoded()); }
  static Parts<T> decode(std::string_view bytes) { return Parts<T>(decode_parts(bytes)); }
};

template <class T>
struct PartAccess<Parts<T>> {
  static const EncodedParts& parts(const void* value) {
    return static_cast<const Parts<T>*>(value)->encoded();
  }
  static std::shared_ptr<const void> from_parts(EncodedParts parts) {
    return std::make_shared<Parts<T>>(std::move(parts));
  }
};

}  // namespace waymark::pipeline
