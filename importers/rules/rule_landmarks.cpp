// SPDX-License-Identifier: Apache-2.0
#include "importers/rules/rule_landmarks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "core/error.hpp"
#include "geo/local_frame.hpp"
#include "importers/rules/bound_rule.hpp"
#include "importers/rules/line_joints.hpp"
#include "importers/rules/shared_outlines.hpp"
#include "importers/tables/plausible_landmark.hpp"
#include "importers/tables/table_positions.hpp"

namespace waymark::importers {
namespace {

constexpr double kFrameReach = 1000;  // m from the origin of a frame; north differs by less than 0.02 deg
constexpr std::size_t kTagsShown = 8;
// Margins in which ends that may touch a wall are looked for; they exceed 5 cm on Earth and in feet.
constexpr double kTouchDegrees = 5e-6, kTouchUnits = 0.2;

/// Returns whether a vertex has coordinates that are no numbers.
bool is_broken(const MapElement& element) {
  const auto broken = [](const Eigen::Vector3d& v) {
    return !(std::abs(v.x()) < 1e9 && std::abs(v.y()) < 1e9);
  };
  return std::ranges::any_of(
      element.parts, [&](const GeometryPart& part) { return std::ranges::any_of(part.vertices, broken); });
}

/// Converts positions of a file to metres near an element, and back.
class NearbyFrame {
 public:
  explicit NearbyFrame(const Crs& crs) : crs_(crs) {}

  void move_to(const Eigen::Vector3d& vertex) {
    const Point<MapCrs> at{{vertex.x(), vertex.y(), 0}};
    if (frame_ && frame_->map_frame_from_crs(at).xyz.head<2>().norm() < kFrameReach) return;
    frame_.emplace(crs_, at);
  }
  Eigen::Vector3d metres(const Eigen::Vector3d& vertex) const {
    const Eigen::Vector3d flat = frame_->map_frame_from_crs({{vertex.x(), vertex.y(), 0}}).xyz;
    return {flat.x(), flat.y(), vertex.z()};
  }
  Eigen::Vector3d back(const Eigen::Vector3d& metres) const {
    const Eigen::Vector3d at = frame_->crs_from_map_frame({{metres.x(), metres.y(), 0}}).xyz;
    return {at.x(), at.y(), metres.z()};
  }

 private:
  Crs crs_;
  std::optional<LocalFrame> frame_;
};

class RuleImport {
 public:
  RuleImport(ElementSource& source, const std::string& path, const TypeRegistry& types,
             const ImportRules& rules, const std::string& table_crs, const std::string& map_crs,
             const std::function<void(Landmark&&)>& take, const std::string& aoi)
      : source_(source),
        types_(types),
        take_(take),
        header_(described(source, path)),
        positions_(header_, table_crs, map_crs, false),
        crs_(table_crs.empty() ? source.crs().value_or(positions_.map_crs()) : Crs::from_text(table_crs)),
        frame_(crs_) {
    choose_unit(rules.unit);
    positions_.keep_inside(aoi);
    std::size_t number = 0;
    for (const ImportRule& rule : rules.rules) rules_.push_back(bind_rule(rule, types, ++number));
    result_.crs = positions_.map_crs();
    for (const BoundRule& rule : rules_)
      if (const std::string& name = types[rule.type].name;
          std::ranges::find(result_.types, name) == result_.types.end())
        result_.types.push_back(name);
  }

  ImportedTable run() {
    collect_shared();
    MapElement element;
    while (next(element)) add(element);
    for (const BoundRule& rule : rules_)
      result_.bindings.push_back(
          fmt::format("{}: {} elements, {} landmarks", rule.rule->title(), rule.elements, rule.landmarks));
    const std::vector<std::string> warnings = positions_.warnings();
    result_.warnings.insert(result_.warnings.end(), warnings.begin(), warnings.end());
    refuse_empty();
    return std::move(result_);
  }

 private:
  static TableHeader described(const ElementSource& source, const std::string& path) {
    TableHeader header;
    header.path = path;
    header.row_word = "element";
    header.crs = source.crs();
    return header;
  }

  /// Chooses the unit of coordinates. Those of a CRS have its unit; local ones that given, else the file's.
  void choose_unit(const std::string& given) {
    const bool local = crs_.kind() == CrsKind::local;
    if (!given.empty() && !local)
      throw Error(ErrorCode::usage, fmt::format("coordinates in {} have its unit", crs_.id()), "--unit",
                  "leave it out, or pass --map-crs local");
    if (!local) return;
    const auto stated = source_.unit();
    if (!given.empty()) {
      metres_ = drawing_unit(given).metres;
    } else if (stated && stated->metres != 1) {
      metres_ = stated->metres;
      result_.warnings.push_back(fmt::format(
          "the header of the drawing states {} ($INSUNITS): coordinates are multiplied by {}; --unit m takes "
          "them as metres",
          stated->name, metres_));
    }
  }

  /// Reads the next element, in metres if its coordinates are local.
  bool next(MapElement& element) {
    if (!source_.next(element)) return false;
    if (metres_ != 1)
      for (GeometryPart& part : element.parts)
        for (Eigen::Vector3d& vertex : part.vertices) vertex *= metres_;
    return true;
  }

  static bool compares_outlines(const ShapeOptions& shape) {
    return shape.open == OpenSide::outside &&
           (shape.shape == ShapeOf::corners || shape.shape == ShapeOf::walls);
  }
  static bool joins_lines(const ShapeOptions& shape) {
    return shape.shape == ShapeOf::corners || shape.shape == ShapeOf::ends;
  }

  /// Returns the first rule for an element whose shapes need what other elements have.
  const BoundRule* first_rule(bool (*needs)(const ShapeOptions&), const MapElement& element) const {
    for (const BoundRule& bound : rules_)
      if (needs(bound.rule->shape) && bound.rule->matches(element)) return &bound;
    return nullptr;
  }

  /// Passes the element as its rule takes it, without a copy if that is the element itself.
  static void pass_as_taken(const MapElement& element, const BoundRule& rule, const auto& take) {
    if (rule.rule->of_outlines)
      take(rule.rule->taken(element));
    else
      take(element);
  }

  void collect_shared() {
    const auto any = [&](bool (*needs)(const ShapeOptions&)) {
      return std::ranges::any_of(rules_, [&](const BoundRule& bound) { return needs(bound.rule->shape); });
    };
    if (!any(compares_outlines) && !any(joins_lines)) return;
    MapElement element;
    while (next(element)) {
      if (is_broken(element)) continue;  // counted as rejected by add()
      if (const BoundRule* rule = first_rule(compares_outlines, element))
        pass_as_taken(element, *rule, [&](const MapElement& taken) { shared_.add(taken); });
      if (const BoundRule* rule = first_rule(joins_lines, element))
        pass_as_taken(element, *rule, [&](const MapElement& taken) { joints_.add(taken); });
    }
    joints_.find_touching_ends(
        [this](const Eigen::Vector2d& near, const Eigen::Vector2d& at) {
          frame_.move_to({near.x(), near.y(), 0});
          return Eigen::Vector2d(frame_.metres({at.x(), at.y(), 0}).head<2>());
        },
        crs_.kind() == CrsKind::geographic ? kTouchDegrees : kTouchUnits);
    source_.restart();
  }

  /// Returns what other elements share with this one, in metres of its frame.
  std::vector<std::vector<SharedVertex>> shared_with(const MapElement& element,
                                                     const ShapeOptions& shape) const {
    std::vector<std::vector<SharedVertex>> shared;
    if (compares_outlines(shape)) shared = shared_.of(element);
    if (!joins_lines(shape)) return shared;
    joints_.mark(element, shared);
    for (auto& part : shared)
      for (SharedVertex& vertex : part) {
        const auto convert = [&](Eigen::Vector2d& at) { at = frame_.metres({at.x(), at.y(), 0}).head<2>(); };
        if (vertex.next) convert(*vertex.next);
        for (auto& wedge : vertex.wedges) std::ranges::for_each(wedge, convert);
      }
    return shared;
  }

  void add(const MapElement& element) {
    ++elements_;
    for (const auto& [tag, value] : element.tags) ++tag_counts_[tag];
    std::set<TypeId> done;
    for (BoundRule& rule : rules_)
      if (!done.contains(rule.type) && rule.rule->matches(element)) {
        done.insert(rule.type);
        ++rule.elements;
        pass_as_taken(element, rule, [&](const MapElement& taken) { add(taken, rule); });
      }
  }

  void add(const MapElement& element, BoundRule& rule) {
    std::vector<GeometryPart> parts = element.parts;
    if (is_broken(element)) return reject(element, "coordinates that are no numbers", 1);
    if (!parts.empty()) frame_.move_to(parts[0].vertices[0]);
    for (GeometryPart& part : parts)
      for (Eigen::Vector3d& vertex : part.vertices) vertex = frame_.metres(vertex);
    const DerivedShapes derived =
        derive_shapes(parts, rule.rule->shape, shared_with(element, rule.rule->shape));
    for (const auto& [reason, count] : derived.omitted) reject(element, reason, count);
    for (const DerivedShape& shape : derived.shapes) add(element, rule, shape);
  }

  void add(const MapElement& element, BoundRule& rule, const DerivedShape& shape) {
    ++result_.rows;
    Landmark landmark = landmark_of_shape(element, rule, types_[rule.type], shape);
    // A point keeps its coordinates to the last bit.
    landmark.position.xyz = rule.rule->shape.shape == ShapeOf::point && element.parts.size() == 1
                                ? element.parts[0].vertices[0]
                                : frame_.back(shape.at);
    if (rule.z) landmark.position.xyz.z() = rule.z->value(element.tags);
    if (std::isnan(landmark.position.xyz.z())) landmark.position.xyz.z() = 0;
    std::string reason =
        positions_.transform_to_map(landmark, types_[rule.type].features, AngleReference::true_north);
    if (reason.empty()) reason = find_implausibility(types_[rule.type], landmark);
    if (!reason.empty()) {
      ++result_.rejected_by_reason[reason];
      note_first(element, reason);
      return;
    }
    ++rule.landmarks;
    ++result_.landmarks;
    take_(std::move(landmark));
  }

  void reject(const MapElement& element, const std::string& reason, int count) {
    result_.rows += count;
    result_.rejected_by_reason[reason] += count;
    note_first(element, reason);
  }

  void note_first(const MapElement& element, const std::string& reason) {
    if (!result_.first_rejection.empty()) return;
    const auto id = std::ranges::find_if(element.tags, [](const auto& tag) {
      return tag.first == "osm_id" || tag.first == "osm_way_id" || tag.first == "id" || tag.first == "@id";
    });
    result_.first_rejection =
        fmt::format("{}, layer {}, feature {}{}: {}", header_.path, element.layer, element.number,
                    id == element.tags.end() ? "" : fmt::format(" ({} {})", id->first, id->second), reason);
  }

  std::string usual_tags() const {
    std::vector<std::pair<std::int64_t, std::string>> counts;
    for (const auto& [tag, count] : tag_counts_)
      if (tag != "osm_id" && tag != "osm_way_id" && tag != "z_order") counts.emplace_back(-count, tag);
    std::ranges::sort(counts);
    std::vector<std::string> shown;
    for (const auto& [count, tag] : counts)
      if (shown.size() < kTagsShown) shown.push_back(fmt::format("{} ({})", tag, -count));
    return shown.empty() ? "none" : fmt::format("{}", fmt::join(shown, ", "));
  }

  void refuse_empty() const {
    if (elements_ == 0)
      throw Error(ErrorCode::input, "the file has no elements with tags or columns", header_.path,
                  "`ogrinfo -al -so` shows its content; OSM nodes and ways without tags have no meaning");
    if (result_.rows == 0)
      throw Error(ErrorCode::input, fmt::format("none of the {} elements matches a rule", elements_),
                  header_.path,
                  fmt::format("tags and columns of the file: {}; write rules for them", usual_tags()));
    if (result_.landmarks > 0) return;
    std::string reasons;
    for (const auto& [reason, count] : result_.rejected_by_reason)
      reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", count, reason);
    if (const auto outside = result_.rejected_by_reason.find(kOutsideArea);
        outside != result_.rejected_by_reason.end() && outside->second == result_.rows)
      throw Error(ErrorCode::input,
                  fmt::format("none of the {} shapes lies in the area of interest", result_.rows),
                  header_.path, "check the CRSs of the file and of the area");
    throw Error(ErrorCode::input,
                fmt::format("none of the {} shapes is plausible: {}", result_.rows, reasons), header_.path,
                "lengths are metres; a file in degrees without a CRS needs --crs EPSG:4326");
  }

  ElementSource& source_;
  const TypeRegistry& types_;
  const std::function<void(Landmark&&)>& take_;
  TableHeader header_;
  TablePositions positions_;
  Crs crs_;  // of the file's positions
  NearbyFrame frame_;
  double metres_ = 1;  // of a unit of local coordinates
  std::vector<BoundRule> rules_;
  SharedOutlines shared_;
  LineJoints joints_;
  std::int64_t elements_ = 0;
  std::map<std::string, std::int64_t> tag_counts_;
  ImportedTable result_;
};

}  // namespace

ImportedTable import_by_rules(ElementSource& source, const std::string& path, const TypeRegistry& types,
                              const ImportRules& rules, const std::string& table_crs,
                              const std::string& map_crs, const std::function<void(Landmark&&)>& take,
                              const std::string& aoi) {
  return RuleImport(source, path, types, rules, table_crs, map_crs, take, aoi).run();
}

}  // namespace waymark::importers
