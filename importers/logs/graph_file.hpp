// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <string>
#include <vector>
#include "localization/slam/graph.hpp"
namespace waymark::importers {

/// A pose graph from a file.
struct ImportedGraph {
  localization::PoseGraph graph;  ///< poses and landmarks by ascending id; t of a pose is its id
  std::string format;
  std::vector<std::string> remarks;  ///< skipped lines, for people
};

/// Recognises the format of a graph file: "isam", "g2o", "toro", or empty for another file. isam and toro
/// share the word EDGE2; the positions of the zeros among its six numbers decide.
std::string graph_format(const std::filesystem::path& file);

/// Reads a plane pose graph with or without landmarks. Records by `format`:
/// - isam: ODOMETRY or EDGE2 (from to x y yaw), LANDMARK (pose landmark x y), then the square root of the
///   information. That is the upper triangle by rows, which may be missing. Landmarks have numbers of their
///   own.
/// - g2o: VERTEX_SE2, VERTEX_XY, EDGE_SE2, EDGE_SE2_XY, EDGE_BEARING_SE2_XY, EDGE_PRIOR_SE2, FIX, with the
///   upper triangle of the information by rows.
/// - toro: VERTEX2, EDGE2 (information I11 I12 I22 I33 I13 I23), LANDMARK as g2o's EDGE_SE2_XY.
/// Throws Error{input} with the line for:
/// - a line that is cut off, no number, information that is not positive definite;
/// - an edge of a vertex that is not there, a vertex twice, a graph in space, a file without edges.
ImportedGraph import_graph(const std::filesystem::path& file, const std::string& format);

}  // namespace waymark::importers
