// SPDX-License-Identifier: Apache-2.0
#include "importers/logs/graph_file.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "core/error.hpp"
#include "core/text_file.hpp"

namespace waymark::importers {
namespace {

namespace fs = std::filesystem;

/// One line of a graph file: a word and numbers. Messages name the line.
struct Line {
  const fs::path* file;
  std::size_t number = 0;
  std::string_view word;
  std::vector<std::string_view> rest;

  [[noreturn]] void fail(const std::string& problem, const std::string& hint = {}) const {
    throw Error(ErrorCode::input, problem, fmt::format("{}, line {}", file->string(), number), hint);
  }
  double real(std::size_t i) const {
    std::string_view text = rest[i];
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      fail(fmt::format("'{}' of {} is no number", rest[i], word));
    return value;
  }
  std::int64_t id(std::size_t i) const {
    const double value = real(i);
    if (value != std::floor(value) || !(std::abs(value) < 1e15))
      fail(fmt::format("'{}' of {} is no id", rest[i], word), "ids are whole numbers");
    return static_cast<std::int64_t>(value);
  }
  localization::Pose2 pose(std::size_t i) const { return {real(i), real(i + 1), real(i + 2)}; }
  /// Throws unless the line has exactly `count` numbers.
  void needs(std::size_t count, std::size_t or_else = 0) const {
    if (rest.size() == count || (or_else && rest.size() == or_else)) return;
    fail(fmt::format("{} has {} numbers, not {}", word, rest.size(), count), "is the line cut off?");
  }
};

/// Calls visit for each line that is neither empty nor a comment.
void for_each_line(const fs::path& file, const std::string& text, const auto& visit) {
  Line line{.file = &file, .word = {}, .rest = {}};
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    ++line.number;
    line.rest.clear();
    line.word = {};
    for (std::size_t i = from; i < end;) {
      if (static_cast<unsigned char>(text[i]) <= ' ') {
        ++i;
        continue;
      }
      std::size_t stop = i;
      while (stop<end&& static_cast<unsigned char>(text[stop])> ' ') ++stop;
      const auto token = std::string_view(text).substr(i, stop - i);
      if (line.word.empty())
        line.word = token;
      else
        line.rest.push_back(token);
      i = stop;
    }
    from = end + 1;
    if (!line.word.empty() && line.word[0] != '#' && line.word[0] != '%' && !visit(line)) return;
  }
}

class Reader {
 public:
  explicit Reader(std::string format) : isam_(format == "isam"), toro_(format == "toro") {}

  bool read(const Line& line) {
    const std::string_view w = line.word;
    if (w == "VERTEX_SE2" || w == "VERTEX2" || w == "VERTEX")
      vertex(line);
    else if (w == "VERTEX_XY")
      landmark_vertex(line);
    else if (w == "EDGE_SE2" || w == "EDGE2" || w == "EDGE" || w == "ODOMETRY")
      step(line);
    else if (w == "EDGE_SE2_XY" || w == "LANDMARK")
      sighting(line);
    else if (w == "EDGE_BEARING_SE2_XY")
      bearing(line);
    else if (w == "EDGE_PRIOR_SE2")
      prior(line);
    else if (w == "FIX")
      for (std::size_t i = 0; i < line.rest.size(); ++i) fixed_.emplace_back(line.id(i), line);
    else if (w.find("SE3") != w.npos || w == "EDGE3" || w == "VERTEX3" || w.find("TRACKXYZ") != w.npos)
      line.fail(fmt::format("{}: this graph is three-dimensional", w), "only planar graphs can be read");
    else
      ++unknown_[std::string(w)];
    return true;
  }

  ImportedGraph take(const fs::path& file) {
    if (steps_.empty() && sightings_.empty()) {
      std::string words;
      for (const auto& [word, count] : unknown_) words += (words.empty() ? "" : ", ") + word;
      throw Error(ErrorCode::input, "the graph has no edges", file.string(),
                  words.empty() ? "docs/how_to/optimize_a_pose_graph.md says what is read"
                                : "these words are not known: " + words);
    }
    number();
    for (const auto& [word, count] : unknown_)
      out_.remarks.push_back(fmt::format("{} lines '{}' are skipped", count, word));
    return std::move(out_);
  }

 private:
  template <class T>
  struct Of {
    std::int64_t a, b;
    T edge;
    Line line;
  };

  void vertex(const Line& line) {
    line.needs(4);
    const localization::Pose2 at = line.pose(1);
    if (!poses_.emplace(line.id(0), at).second || (!isam_ && landmarks_.contains(line.id(0))))
      line.fail(fmt::format("vertex {} is defined twice", line.id(0)));
  }
  void landmark_vertex(const Line& line) {
    line.needs(3);
    const Eigen::Vector2d at(line.real(1), line.real(2));
    if (!landmarks_.emplace(line.id(0), at).second || (!isam_ && poses_.contains(line.id(0))))
      line.fail(fmt::format("vertex {} is defined twice", line.id(0)));
  }

  template <class Matrix>
  Matrix root(const Line& line, const Matrix& upper) const {
    if (isam_) {
      if (upper.diagonal().cwiseAbs().minCoeff() > 0) return upper;
    } else {
      try {
        return localization::information_root(Matrix(upper.template selfadjointView<Eigen::Upper>()));
      } catch (const std::invalid_argument&) {
      }
    }
    line.fail(fmt::format("the information of {} is not positive definite", line.word),
              "is --log-format right? isam, g2o and toro order it differently");
  }
  Eigen::Matrix3d root3(const Line& line, std::size_t first) const {
    Eigen::Matrix3d upper = Eigen::Matrix3d::Identity();
    if (line.rest.size() <= first) return upper;
    std::array<double, 6> v;
    for (std::size_t i = 0; i < 6; ++i) v[i] = line.real(first + i);
    if (toro_)
      upper << v[0], v[1], v[4], 0, v[2], v[5], 0, 0, v[3];
    else
      upper << v[0], v[1], v[2], 0, v[3], v[4], 0, 0, v[5];
    return root(line, upper);
  }

  void step(const Line& line) {
    line.needs(11, isam_ ? 5 : 0);
    if (line.id(0) == line.id(1)) line.fail(fmt::format("{} connects {} to itself", line.word, line.id(0)));
    steps_.push_back({line.id(0), line.id(1), {.step = line.pose(2), .root = root3(line, 5)}, line});
  }
  void sighting(const Line& line) {
    line.needs(7, isam_ ? 4 : 0);
    localization::SightingEdge edge;
    edge.value = {line.real(2), line.real(3)};
    if (line.rest.size() > 4) {
      // Not as a list of Eigen's: one that an error leaves unfinished ends a debug build.
      const std::array v{line.real(4), line.real(5), line.real(6)};
      edge.root = root(line, Eigen::Matrix2d{{v[0], v[1]}, {0, v[2]}});
    }
    sightings_.push_back({line.id(0), line.id(1), edge, line});
  }
  void bearing(const Line& line) {
    line.needs(4);
    const double information = line.real(3);
    if (!(information > 0)) line.fail("the information of a bearing must be above 0");
    localization::SightingEdge edge;
    edge.kind = localization::SightingKind::bearing;
    edge.value = {0, line.real(2)};
    edge.root = Eigen::Matrix2d::Identity() * std::sqrt(information);
    sightings_.push_back({line.id(0), line.id(1), edge, line});
  }
  void prior(const Line& line) {
    line.needs(10);
    priors_.push_back({line.id(0), 0, {.at = line.pose(1), .root = root3(line, 4)}, line});
  }

  /// Returns the index of an id. Throws if the file declares vertices, but not this one.
  template <class Ids>
  static std::size_t index(const Ids& ids, std::int64_t id, const Line& line, const char* what) {
    const auto found = ids.find(id);
    if (found == ids.end())
      line.fail(fmt::format("{} names {} {}, which the graph does not have", line.word, what, id),
                "is a vertex or an odometry edge missing?");
    return found->second;
  }

  void number() {
    std::map<std::int64_t, std::size_t> pose_index, landmark_index;
    const bool declared = !poses_.empty();
    for (const auto& [id, at] : poses_) pose_index[id];
    for (const auto& [id, at] : landmarks_) landmark_index[id];
    if (!declared) {
      for (const auto& s : steps_) pose_index[s.a], pose_index[s.b];
      if (steps_.empty())
        for (const auto& s : sightings_) pose_index[s.a];
    }
    if (landmarks_.empty())
      for (const auto& s : sightings_) landmark_index[s.b];
    localization::PoseGraph& g = out_.graph;
    for (auto& [id, index] : pose_index) {
      index = g.poses.size();
      const auto at = poses_.find(id);
      g.poses.push_back({.id = id,
                         .t = static_cast<double>(id),
                         .at = at == poses_.end() ? localization::Pose2{} : at->second,
                         .given = at != poses_.end()});
    }
    for (auto& [id, index] : landmark_index) {
      index = g.landmarks.size();
      const auto at = landmarks_.find(id);
      g.landmarks.push_back({.id = id,
                             .at = at == landmarks_.end() ? Eigen::Vector2d(0, 0) : at->second,
                             .given = at != landmarks_.end()});
    }
    for (auto& s : steps_) {
      s.edge.from = index(pose_index, s.a, s.line, "pose");
      s.edge.to = index(pose_index, s.b, s.line, "pose");
      g.steps.push_back(s.edge);
    }
    for (auto& s : sightings_) {
      s.edge.pose = index(pose_index, s.a, s.line, "pose");
      s.edge.landmark = index(landmark_index, s.b, s.line, "landmark");
      g.sightings.push_back(s.edge);
    }
    for (auto& p : priors_) {
      p.edge.pose = index(pose_index, p.a, p.line, "pose");
      g.pose_priors.push_back(p.edge);
    }
    for (const auto& [id, line] : fixed_) g.poses[index(pose_index, id, line, "pose")].fixed = true;
  }

  bool isam_, toro_;
  std::map<std::int64_t, localization::Pose2> poses_;
  std::map<std::int64_t, Eigen::Vector2d> landmarks_;
  std::vector<Of<localization::StepEdge>> steps_;
  std::vector<Of<localization::SightingEdge>> sightings_;
  std::vector<Of<localization::PosePrior>> priors_;
  std::vector<std::pair<std::int64_t, Line>> fixed_;
  std::map<std::string, std::size_t> unknown_;
  ImportedGraph out_;
};

}  // namespace

std::string graph_format(const fs::path& file) {
  if (!fs::is_regular_file(file)) return {};
  const std::string text = read_text(file, "the file");
  std::string format;
  bool may_be_toro = true, may_be_isam = true, edges = false;
  std::size_t looked_at = 0;
  for_each_line(file, text, [&](const Line& line) {
    const std::string_view w = line.word;
    if (w == "ODOMETRY") format = "isam";
    if (w == "VERTEX2" || w == "VERTEX" || w == "VERTEX3" || w == "EDGE3") format = "toro";
    if (w.starts_with("VERTEX_") || w.starts_with("EDGE_") || w.starts_with("PARAMS_")) format = "g2o";
    if (w == "EDGE2" && line.rest.size() >= 11) {
      edges = true;
      may_be_toro &= line.rest[7] != "0" && line.real(7) > 0 && line.real(8) > 0;
      may_be_isam &= line.real(8) > 0 && line.real(10) > 0;
    } else if (w == "EDGE2" || w == "LANDMARK") {
      edges = true;
    }
    return format.empty() && ++looked_at < 1000 && (edges || looked_at < 10);
  });
  if (!format.empty() || !edges) return format;
  return may_be_toro && !may_be_isam ? "toro" : "isam";
}

ImportedGraph import_graph(const fs::path& file, const std::string& format) {
  const std::string text = read_text(file, "the file");
  Reader reader(format);
  for_each_line(file, text, [&](const Line& line) { return reader.read(line); });
  ImportedGraph graph = reader.take(file);
  graph.format = format;
  return graph;
}

}  // namespace waymark::importers
