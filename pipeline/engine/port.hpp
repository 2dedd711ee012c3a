// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <typeindex>
#include "pipeline/engine/codec.hpp"
namespace waymark::pipeline {

/// Declares an input: an artifact that an earlier stage writes under the same name and type.
template <class T>
struct In {
  const char* name;
};

/// Declares a gathered input: the artifacts of every earlier stage that writes this name and type, of the
/// same item or of all items.
/// Items of failed units are left out with a warning; the result is then not kept in the work folder.
template <class T>
struct Gather {
  const char* name;
};

/// Declares an input of a map-scope stage that is read item by item (StageContext::visit), so that not all of
/// a tile's artifacts are in memory.
template <class T>
struct Stream {
  const char* name;
};

/// Declares a gathered input of a map-scope stage that is read item by item, as a Stream.
template <class T>
struct GatherStream {
  const char* name;
};

/// Declares an output. T needs a Codec. Several stages may write one name if all its readers gather it.
template <class T>
struct Out {
  const char* name;
};

/// In<T>, Gather<T>, Stream<T> or GatherStream<T> as listed by StageSpec.
struct InputPort {
  std::string name;
  std::type_index type;
  bool gathers = false;
  bool streams = false;

  template <class T>
  InputPort(In<T> port) : name(port.name), type(typeid(T)) {}
  template <class T>
  InputPort(Gather<T> port) : name(port.name), type(typeid(T)), gathers(true) {}
  template <class T>
  InputPort(Stream<T> port) : name(port.name), type(typeid(T)), streams(true) {}
  template <class T>
  InputPort(GatherStream<T> port) : name(port.name), type(typeid(T)), gathers(true), streams(true) {}
};

/// Out<T> as listed by StageSpec.
struct OutputPort {
  std::string name;
  std::type_index type;
  const ErasedCodec* codec;  ///< never null

  template <class T>
  OutputPort(Out<T> port) : name(port.name), type(typeid(T)), codec(&erased_codec<T>()) {}
};

/// Returns the readable name of a type without namespaces and allocators: "vector<Landmark>".
std::string readable_type(std::type_index type);

}  // namespace waymark::pipeline
