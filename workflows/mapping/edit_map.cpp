// SPDX-License-Identifier: Apache-2.0
#include "workflows/mapping/edit_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "core/options/option_reader.hpp"
#include "geodb/update_map.hpp"
#include "importers/hash.hpp"
#include "landmarks/semantic_map.hpp"
#include "workflows/output_path.hpp"
#include "workflows/parse_number.hpp"
#include "workflows/provenance.hpp"

namespace waymark::workflows {
namespace {

constexpr double kNotStated = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kEditNames[] = {"accept", "reject", "add", "move"};

struct OutlineCircle {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 0;
};

/// Returns the circle through three points. Throws Error{usage} if they lie on a line.
OutlineCircle circle_through(const std::vector<double>& points) {
  const Eigen::Vector2d a(points[0], points[1]), b(points[2], points[3]), c(points[4], points[5]);
  const Eigen::Vector2d ab = b - a, ac = c - a;
  const double cross = ab.x() * ac.y() - ab.y() * ac.x();
  if (!(std::abs(cross) > 1e-6 * ab.norm() * ac.norm()))
    throw Error(ErrorCode::usage, "the three points of --rim lie on a line", "",
                "take them a third of the outline apart");
  const Eigen::Vector2d from_a = Eigen::Vector2d(ac.y() * ab.squaredNorm() - ab.y() * ac.squaredNorm(),
                                                 ab.x() * ac.squaredNorm() - ac.x() * ab.squaredNorm()) /
                                 (2 * cross);
  return {a + from_a, from_a.norm()};
}

void check_edit(const EditRequest& request) {
  if (!request.result.empty()) check_map_output(request.result);
  const auto refuse = [](const std::string& problem, const std::string& hint) {
    throw Error(ErrorCode::usage, problem, "", hint);
  };
  const bool adds = request.edit == MapEdit::add, moves = request.edit == MapEdit::move;
  if (!adds && request.uids.empty()) refuse("no landmark is named", "`waymark query MAP` prints their uids");
  if (moves && request.uids.size() != 1) refuse("one landmark is moved at a time", "give one uid");
  if (adds && !request.uids.empty()) refuse("a new landmark has no uid yet", "leave out the uid");
  if (adds && request.type.empty()) refuse("the type of the new landmark is missing", "pass --type TYPE");
  const auto only_of = [&](bool is_given, const char* option, bool applies, const char* actions) {
    if (is_given && !applies) refuse(fmt::format("{} is an option of {}", option, actions), "leave it out");
  };
  only_of(!request.type.empty(), "--type", adds, "add");
  only_of(!request.features.empty(), "--feature", adds, "add");
  only_of(!request.rim.empty(), "--rim", adds, "add");
  only_of(!request.at.empty(), "--at", adds || moves, "add and move");
  only_of(request.z.has_value(), "--z", adds || moves, "add and move");
  only_of(request.position_sd != 0, "--position-sd", adds || moves, "add and move");
  only_of(request.confidence != EditRequest{}.confidence, "--confidence",
          adds || request.edit == MapEdit::accept, "accept and add");
  const bool rim = !request.rim.empty();
  if ((adds || moves) && request.at.empty() != rim)
    refuse("a position is needed, once",
           adds ? "pass --at X Y, or --rim X1 Y1 X2 Y2 X3 Y3" : "pass --at X Y");
  if (rim && request.rim.size() != 6)
    refuse("--rim takes the x and y of three points of a new landmark", "e.g. --rim 10 0 0 10 -10 0");
  if (!request.at.empty() && request.at.size() != 2) refuse("--at takes X Y", "e.g. --at 431.5 -20.25");
  check_number("--confidence", request.confidence, "",
               {.help = "Of accepted and new landmarks; `reject` takes back what does not exist",
                .min = 1e-6,
                .max = 1});
  check_number("--position-sd", request.position_sd, "m",
               {.help = "Standard deviation of the position; 0: not known", .min = 0});
}

Eigen::Matrix3d stated_covariance(double sd) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Constant(kNotStated);
  if (sd > 0) covariance.topLeftCorner<2, 2>() = Eigen::Matrix2d::Identity() * sd * sd;
  return covariance;
}

void set_feature(Landmark& landmark, const LandmarkType& type, const std::string& name, double value) {
  const auto feature = std::ranges::find(type.features, name, &FeatureSpec::name);
  if (feature == type.features.end()) {
    std::vector<std::string> names;
    for (const FeatureSpec& f : type.features) names.push_back(f.name);
    const std::string nearest = nearest_name(name, names);
    throw Error(ErrorCode::usage, fmt::format("{} has no feature '{}'", type.name, name), "",
                nearest.empty() ? fmt::format("`waymark types {}` lists them", type.name)
                                : fmt::format("did you mean '{}'?", nearest));
  }
  check_number(fmt::format("{} of a {}", name, type.name), value, feature->unit,
               {.help = "", .min = feature->min_value, .max = feature->max_value});
  landmark.features[static_cast<std::size_t>(feature - type.features.begin())] = {value, 0, 1};
}

void set_position(const EditRequest& request, Landmark& landmark) {
  landmark.position.xyz.head<2>() = Eigen::Vector2d(request.at[0], request.at[1]);
  landmark.position.xyz.z() = request.z.value_or(landmark.position.xyz.z());
  landmark.covariance = stated_covariance(request.position_sd);
}

std::string unused_uid(const geodb::MapStore& map, std::string uid) {
  std::string candidate = uid;
  for (int n = 2; map.find(candidate); ++n) candidate = fmt::format("{}-{}", uid, n);
  return candidate;
}

Landmark new_landmark(const EditRequest& request, const geodb::MapStore& map) {
  const TypeRegistry& types = map.types();
  const LandmarkType* type = types.find(request.type);
  if (type == nullptr)
    throw Error(ErrorCode::usage, fmt::format("the map has no landmarks of type '{}'", request.type),
                request.map, fmt::format("it has {}", fmt::join(types.names(), ", ")));
  Landmark landmark;
  landmark.type = types.id(request.type);
  landmark.features.resize(type->features.size());
  landmark.attributes.resize(type->attributes.size());
  landmark.quality.feature_confidences.resize(type->features.size());
  landmark.confidence = request.confidence;
  landmark.observations = 0;
  landmark.position.xyz.setZero();
  if (request.rim.empty()) {
    set_position(request, landmark);
  } else {
    if (map.crs().kind() == CrsKind::geographic || type->body.feature.empty())
      throw Error(ErrorCode::usage,
                  type->body.feature.empty() ? fmt::format("a {} has no extent, so it has no rim", type->name)
                                             : "--rim needs a map in metres, this one is in degrees",
                  request.map, "pass --at X Y, and its features by --feature");
    const double unit = map.crs().kind() == CrsKind::projected ? map.crs().metres_per_unit() : 1;
    const OutlineCircle circle = circle_through(request.rim);
    landmark.position.xyz << circle.centre, request.z.value_or(0);
    landmark.covariance = stated_covariance(request.position_sd);
    set_feature(landmark, *type, type->body.feature, circle.radius * unit / type->body.radius_per_value);
  }
  for (const std::string& text : request.features) {
    const auto [name, value] = parse_feature_value("--feature", text);
    set_feature(landmark, *type, name, value);
  }
  landmark.uid = unused_uid(map, make_uid(*type, map.crs(), landmark.position));
  return landmark;
}

Landmark find_landmark(const geodb::MapStore& map, const std::string& uid) {
  auto found = map.find(uid);
  if (!found)
    throw Error(ErrorCode::usage, fmt::format("the map has no landmark '{}'", uid), map.path().string(),
                "`waymark query MAP` prints the uids");
  return std::move(*found);
}

geodb::RunRecord edit_record(const EditRequest& request, const std::vector<std::string>& uids) {
  geodb::RunRecord run = make_run_record(request.command_line, std::chrono::system_clock::now());
  using RunJson = nlohmann::ordered_json;
  RunJson job{{"edit", kEditNames[static_cast<int>(request.edit)]}, {"landmarks", uids}};
  if (!request.reason.empty()) job["reason"] = request.reason;
  run.job_json = job.dump();
  run.report_json = RunJson{{"changed", uids.size()}}.dump();
  run.inputs = {importers::hash_file(request.map)};
  return run;
}

}  // namespace

std::vector<std::string> edit_map(const EditRequest& request, const Callbacks& callbacks) {
  check_edit(request);
  std::vector<std::string> uids = request.uids;
  const std::string result = request.result.empty() ? request.map : request.result;
  geodb::update_map(request.map, result, [&](geodb::MapEditor& editor) {
    if (request.edit == MapEdit::add) {
      const Landmark added = new_landmark(request, editor.map());
      uids = {added.uid};
      editor.insert(added);
    }
    for (const std::string& uid : request.uids) {
      Landmark landmark = find_landmark(editor.map(), uid);
      if (request.edit == MapEdit::reject) {
        editor.remove(uid);
        continue;
      }
      if (request.edit == MapEdit::accept) landmark.confidence = request.confidence;
      if (request.edit == MapEdit::move) set_position(request, landmark);
      editor.update(landmark);
    }
    editor.add_run(edit_record(request, uids));
  });
  callbacks.summary(
      fmt::format("{}: {} {}\n", result, kEditNames[static_cast<int>(request.edit)], fmt::join(uids, ", ")));
  return uids;
}

}  // namespace waymark::workflows
