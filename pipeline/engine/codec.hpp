// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <string_view>
namespace waymark::pipeline {

/// Serialization of an artifact of type T. Specialise it next to T; only the stage that writes a T needs it:
///   static std::string encode(const T&);        equal values give equal bytes
///   static T decode(std::string_view bytes);    throws on malformed bytes
/// If the layout changes, raise the version of every stage that writes T.
template <class T>
struct Codec;

/// Encoded parts of a value that does not fit into memory (pipeline/engine/parts.hpp).
struct EncodedParts;

/// Type-erased Codec.
struct ErasedCodec {
  std::string (*encode)(const void* value);
  std::shared_ptr<const void> (*decode)(std::string_view bytes);
  /// Of a Parts<T>, which is stored and read part by part; null for all other values.
  const EncodedParts& (*parts)(const void* value) = nullptr;
  std::shared_ptr<const void> (*from_parts)(EncodedParts parts) = nullptr;
};

/// Access to the parts of a value; specialised for Parts<T>.
template <class T>
struct PartAccess {
  static constexpr decltype(ErasedCodec::parts) parts = nullptr;
  static constexpr decltype(ErasedCodec::from_parts) from_parts = nullptr;
};

/// Returns the codec of a type behind void pointers.
template <class T>
const ErasedCodec& erased_codec() {
  static constexpr ErasedCodec codec{
      [](const void* value) { return Codec<T>::encode(*static_cast<const T*>(value)); },
      [](std::string_view bytes) -> std::shared_ptr<const void> {
        return std::make_shared<T>(Codec<T>::decode(bytes));
      },
      PartAccess<T>::parts, PartAccess<T>::from_parts};
  return codec;
}

}  // namespace waymark::pipeline
