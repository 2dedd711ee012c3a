// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>
#include "pipeline/engine/codec.hpp"
#include "pipeline/forest/find_trees.hpp"
namespace waymark::pipeline {

/// Crown of a tree as a polygon on the map. Crowns of one canopy model do not overlap.
struct CrownShape {
  std::string uid;                                ///< of the tree's landmark; empty before name_crowns
  std::string source;                             ///< its canopy model, as Observation::source
  Eigen::Vector2d top = Eigen::Vector2d::Zero();  ///< treetop in the map CRS: Observation::position.xyz.xy
  std::vector<Eigen::Vector2d>
      ring;             ///< outline in the map CRS, counter-clockwise; the first is not repeated
  double height = 0;    ///< of the tree, m
  double area = 0;      ///< projected crown area, m2
  double diameter = 0;  ///< of the circle of that area, m
};

/// Compact table of crowns. Outlines follow cell edges, so a corner is a step of one or two bytes from the
/// previous one: a crown of 40 corners takes 90 bytes, as a CrownShape 800.
class CrownTable {
 public:
  /// Registers the cell grid of a canopy model and returns its number, with which crowns are added.
  std::uint32_t add_survey(const CanopySource& canopy);
  void add(std::uint32_t survey, const DetectedTree& tree);
  /// Adds a crown of another table under a uid.
  void add(const CrownTable& from, std::size_t row, std::string_view uid);

  std::size_t size() const { return crowns_.size(); }
  /// Returns the unpacked crown.
  CrownShape at(std::size_t row) const;
  std::string_view uid(std::size_t row) const;
  std::string_view source(std::size_t row) const { return surveys_[crowns_[row].survey].source; }
  Eigen::Vector2d top(std::size_t row) const;
  bool has_outline(std::size_t row) const { return crowns_[row].cells > 0; }  ///< has an outline
  /// Releases memory reserved for further crowns.
  void shrink_to_fit();

 private:
  friend struct Codec<CrownTable>;
  struct Survey {
    std::string source;
    double x0 = 0, y0 = 0, dx = 1, dy = -1;  ///< as Georeference, in the CRS of the map
    double width = 1, height = 1;            ///< of a cell, metres
    friend bool operator==(const Survey&, const Survey&) = default;
  };
  struct Packed {
    std::int32_t column = 0, row = 0;  ///< of the top
    float height = 0;
    std::uint32_t cells = 0, survey = 0, corners = 0;
    std::uint64_t begins = 0;  ///< offset in bytes_: length and letters of the uid, then the outline
  };
  std::uint32_t number_of(const Survey& survey);

  std::vector<Survey> surveys_;
  std::vector<Packed> crowns_;
  std::string bytes_;
};

/// The artifact `crowns`.
template <>
struct Codec<CrownTable> {
  static std::string encode(const CrownTable& crowns);
  static CrownTable decode(std::string_view bytes);
};

}  // namespace waymark::pipeline
