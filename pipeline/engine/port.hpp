// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <typeindex>
#include "pipeline/engine/codec.hpp"
namespace waymark {

/// What a stage reads: an artifact that an earlier stage writes under the same name and type.
template <class T>
struct In {
  const char* name;
};

/// What a stage gathers: the artifacts of every earlier stage that writes this name and type, of the same
/// item or of all. Items whose unit failed are left out, with a warning; a result made without them is not
/// kept in the work folder.
template <class T>
struct Gather {
  const char* name;
};

/// What a stage writes. T needs a Codec. Several stages may write one name where all readers gather it.
template <class T>
struct Out {
  const char* name;
};

/// An In<T> or a Gather<T> as StageSpec lists it.
struct InputPort {
  std::string name;
  std::type_index type;
  bool gathers = false;

  template <class T>
  InputPort(In<T> port) : name(port.name), type(typeid(T)) {}
  template <class T>
  InputPort(Gather<T> port) : name(port.name), type(typeid(T)), gathers(true) {}
};

/// An Out<T> as StageSpec lists it.
struct OutputPort {
  std::string name;
  std::type_index type;
  const ErasedCodec* codec;  ///< never null

  template <class T>
  OutputPort(Out<T> port) : name(port.name), type(typeid(T)), codec(&erased_codec<T>()) {}
};

/// The type as a person writes it: "vector<Landmark>", without namespaces and allocators.
std::string readable_type(std::type_index type);

}  // namespace waymark
