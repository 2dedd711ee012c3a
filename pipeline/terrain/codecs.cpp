// SPDX-License-Identifier: Apache-2.0
#include "pipeline/terrain/codecs.hpp"

#include <stdexcept>

#include "core/bytes.hpp"

namespace waymark::pipeline {
namespace {

// Each layout is defined once for both directions: `io` is a ByteWriter or a ByteReader.

void layout(auto& io, auto& node) requires requires {
  node.portal;
}
{ io(node.cell), io(node.height), io(node.contact), io(node.portal); }
void layout(auto& io, auto& saddle) requires requires {
  saddle.a;
}
{ io(saddle.cell), io(saddle.height), io(saddle.a), io(saddle.b); }
void layout(auto& io, auto& border) requires requires {
  border.node;
}
{ io(border.cell), io(border.height), io(border.node); }
void layout(auto& io, auto& window) requires requires {
  window.columns;
}
{ io(window.column), io(window.row), io(window.columns), io(window.rows); }
void layout(auto& io, auto& summit) requires requires {
  summit.prominence_low;
}
{
  io(summit.cell), io(summit.height), io(summit.prominence), io(summit.prominence_low);
  io(summit.saddle), io(summit.saddle_height), io(summit.parent);
}

void layout(auto& io, auto& voids) requires requires {
  voids.faults;
}
{
  io(voids.empty), io(voids.rim), io(voids.faults.filled), io(voids.faults.implausible);
  io(voids.faults.height), io(voids.faults.column), io(voids.faults.row);
}

template <class T>
void write_all(ByteWriter& out, const std::vector<T>& items) {
  out(static_cast<std::uint64_t>(items.size()));
  for (const T& item : items) layout(out, item);
}
template <class T>
std::vector<T> read_all(ByteReader& in) {
  std::vector<T> items(in.length(8));
  for (T& item : items) layout(in, item);
  return items;
}

void write_optional(ByteWriter& out, const std::optional<double>& value) {
  out(value.has_value());
  out(value.value_or(0));
}
std::optional<double> read_optional(ByteReader& in) {
  const bool known = in.get<bool>();
  const double value = in.get<double>();
  return known ? std::optional(value) : std::nullopt;
}

}  // namespace

std::string Codec<DivideTree>::encode(const DivideTree& tree) {
  ByteWriter out;
  layout(out, tree.window);
  write_all(out, tree.nodes);
  write_all(out, tree.saddles);
  write_all(out, tree.border);
  out(tree.cells), out(tree.maxima), out(tree.min_prominence), out(tree.lowest), out(tree.highest);
  layout(out, tree.voids);
  return out.take();
}

DivideTree Codec<DivideTree>::decode(std::string_view bytes) {
  ByteReader in(bytes);
  DivideTree tree;
  layout(in, tree.window);
  tree.nodes = read_all<DivideTree::Node>(in);
  tree.saddles = read_all<DivideTree::Saddle>(in);
  tree.border = read_all<DivideTree::Border>(in);
  in(tree.cells), in(tree.maxima), in(tree.min_prominence), in(tree.lowest), in(tree.highest);
  layout(in, tree.voids);
  in.expect_end();
  return tree;
}

std::string Codec<BlockRelief>::encode(const BlockRelief& relief) {
  ByteWriter out;
  layout(out, relief.blocks);
  out(relief.highest), out(relief.voids);
  return out.take();
}

BlockRelief Codec<BlockRelief>::decode(std::string_view bytes) {
  ByteReader in(bytes);
  BlockRelief relief;
  layout(in, relief.blocks);
  in(relief.highest), in(relief.voids);
  in.expect_end();
  return relief;
}

// Stores the finest level row by row, so that no copy of the whole is needed; the others are computed from
// it.
std::string Codec<ReliefPyramid>::encode(const ReliefPyramid& pyramid) {
  ByteWriter out;
  out(pyramid.columns()), out(pyramid.rows());
  const std::int64_t rows = pyramid.finest_rows();
  for (std::int64_t r = 0; r < rows; ++r) {
    const BlockRelief row = pyramid.finest_row(r);
    out(std::vector<float>(row.highest.begin(), row.highest.end())), out(row.voids);
  }
  return out.take();
}

ReliefPyramid Codec<ReliefPyramid>::decode(std::string_view bytes) {
  ByteReader in(bytes);
  const auto columns = in.get<std::int64_t>(), rows = in.get<std::int64_t>();
  const double blocks =
      static_cast<double>(columns) * static_cast<double>(rows) / (kReliefBlock * kReliefBlock);
  if (columns < 0 || rows < 0 || blocks > static_cast<double>(bytes.size()))
    throw std::runtime_error("artifact has a relief larger than itself");
  ReliefPyramid pyramid(columns, rows);
  std::vector<float> highest;
  BlockRelief row;
  for (std::int64_t r = 0; r < pyramid.finest_rows(); ++r) {
    in(highest), in(row.voids);
    row.highest.assign(highest.begin(), highest.end());
    row.blocks = {0, r, std::ssize(row.highest), 1};
    if (row.voids.size() != row.highest.size() || row.blocks.columns != pyramid.finest_columns())
      throw std::runtime_error("artifact has a row of another length");
    pyramid.add(row);
  }
  in.expect_end();
  pyramid.build_levels();
  return pyramid;
}

std::string Codec<std::vector<Summit>>::encode(const std::vector<Summit>& summits) {
  ByteWriter out;
  write_all(out, summits);
  return out.take();
}

std::vector<Summit> Codec<std::vector<Summit>>::decode(std::string_view bytes) {
  ByteReader in(bytes);
  auto summits = read_all<Summit>(in);
  in.expect_end();
  return summits;
}

std::string Codec<std::vector<Isolation>>::encode(const std::vector<Isolation>& isolations) {
  ByteWriter out;
  out(static_cast<std::uint64_t>(isolations.size()));
  for (const Isolation& i : isolations) {
    write_optional(out, i.metres), write_optional(out, i.metres_low);
    out(i.higher.column), out(i.higher.row);
  }
  return out.take();
}

std::vector<Isolation> Codec<std::vector<Isolation>>::decode(std::string_view bytes) {
  ByteReader in(bytes);
  std::vector<Isolation> isolations(in.length(8));
  for (Isolation& i : isolations) {
    i.metres = read_optional(in), i.metres_low = read_optional(in);
    in(i.higher.column), in(i.higher.row);
  }
  in.expect_end();
  return isolations;
}

}  // namespace waymark::pipeline
