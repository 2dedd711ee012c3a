// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/engine/codec.hpp"
#include "pipeline/terrain/divide_tree.hpp"
#include "pipeline/terrain/isolation.hpp"
#include "pipeline/terrain/prominence.hpp"
#include "pipeline/terrain/relief_pyramid.hpp"
namespace waymark::pipeline {

// Serialization of the artifacts of the mountain-top stages: numbers, member by member (core/bytes.hpp).

template <>
struct Codec<DivideTree> {
  static std::string encode(const DivideTree& tree);
  static DivideTree decode(std::string_view bytes);
};
template <>
struct Codec<BlockRelief> {
  static std::string encode(const BlockRelief& relief);
  static BlockRelief decode(std::string_view bytes);
};
template <>
struct Codec<ReliefPyramid> {
  static std::string encode(const ReliefPyramid& pyramid);
  static ReliefPyramid decode(std::string_view bytes);
};
template <>
struct Codec<std::vector<Summit>> {
  static std::string encode(const std::vector<Summit>& summits);
  static std::vector<Summit> decode(std::string_view bytes);
};
template <>
struct Codec<std::vector<Isolation>> {
  static std::string encode(const std::vector<Isolation>& isolations);
  static std::vector<Isolation> decode(std::string_view bytes);
};

}  // namespace waymark::pipeline
