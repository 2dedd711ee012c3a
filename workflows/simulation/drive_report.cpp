// SPDX-License-Identifier: Apache-2.0
#include "workflows/simulation/drive_report.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "localization/robot_log.hpp"
#include "planning/belief.hpp"

namespace waymark::workflows {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kChi2 = 13.816;      // 99.9 % of two dimensions
constexpr double kEllipse95 = 2.448;  // sd that hold 95 % of two dimensions
constexpr double kWindow = 20;        // s

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// Rounded to what a reader can use: six significant digits would differ between machines.
double four_digits(double value) {
  return std::round(value * 1e4) / 1e4;
}

}  // namespace

void score_drive(DriveReport& report, const localization::Track& track,
                 const std::vector<localization::StampedPose>& truth) {
  struct Sample {
    double t, square;
  };
  std::vector<Sample> samples;
  double sum = 0, lost = 0, wrong = 0, inside = 0;
  for (const localization::TrackRow& row : track.rows) {
    const auto pose = localization::pose_at(truth, row.t);
    if (!pose) continue;
    const Eigen::Vector2d error = row.at.pose.at() - pose->at();
    const double square = error.squaredNorm(), norm = std::sqrt(square);
    samples.push_back({row.t, square});
    sum += square;
    report.worst_error = std::max(report.worst_error, norm);
    report.worst_sd =
        std::max(report.worst_sd, planning::position_sd(planning::symmetric(row.at.covariance)));
    const Eigen::Matrix2d p = row.at.covariance.topLeftCorner<2, 2>() + 1e-9 * Eigen::Matrix2d::Identity();
    if (row.lost)
      ++lost;
    else if (norm > 1 && error.dot(p.ldlt().solve(error)) > kChi2)
      ++wrong;
    if (report.limit_sigma > 0 && norm <= kEllipse95 * report.limit_sigma) ++inside;
  }
  if (samples.empty()) return;
  const double n = static_cast<double>(samples.size());
  report.rms_error = std::sqrt(sum / n), report.lost = lost / n, report.wrong_and_sure = wrong / n;
  if (report.limit_sigma > 0) {
    report.inside_95 = inside / n;
    report.limit_kept = report.worst_sd <= report.limit_sigma;
  }
  double within = 0;
  for (std::size_t first = 0, i = 0; i < samples.size(); ++i) {
    within += samples[i].square;
    while (samples[first].t < samples[i].t - kWindow) within -= samples[first++].square;
    report.worst_rms =
        std::max(report.worst_rms, std::sqrt(std::max(0.0, within) / static_cast<double>(i - first + 1)));
  }
}

std::int64_t touched_rock(const testbed::Scene& scene, const localization::Pose2& pose,
                          const planning::Vehicle& vehicle) {
  double half_length = 0, half_width = 0;
  for (const planning::Support& s : vehicle.supports) {
    half_length = std::max(half_length, std::abs(s.x.value) + s.diameter.value / 2);
    half_width = std::max(half_width, std::abs(s.y.value) + s.width.value / 2);
  }
  const localization::Pose2 robot_from_grid = localization::inverse(pose);
  for (std::size_t i = 0; i < scene.rocks.size(); ++i) {
    const testbed::TrueRock& rock = scene.rocks[i];
    if (!(rock.height > vehicle.obstacle_height())) continue;
    const Eigen::Vector2d to =
        (robot_from_grid * localization::Pose2{rock.position.x(), rock.position.y(), 0}).at();
    const Eigen::Vector2d outside = (to.cwiseAbs() - Eigen::Vector2d(half_length, half_width)).cwiseMax(0.0);
    if (outside.norm() < rock.width / 2) return static_cast<std::int64_t>(i);
  }
  return -1;
}

std::string drive_report_json(const DriveReport& r) {
  Json json{{"waymark_drive", 1},
            {"reached", r.reached},
            {"ended", r.ended},
            {"seconds", four_digits(r.seconds)},
            {"driven", four_digits(r.driven)},
            {"goal_distance", four_digits(r.goal_distance)},
            {"planned_length", four_digits(r.planned_length)},
            {"planned_worst_sd", four_digits(r.planned_sd)},
            {"worst_sd", four_digits(r.worst_sd)},
            {"rms_error", four_digits(r.rms_error)},
            {"worst_error", four_digits(r.worst_error)},
            {"worst_rms_20s", four_digits(r.worst_rms)},
            {"lost", four_digits(r.lost)},
            {"wrong_and_sure", four_digits(r.wrong_and_sure)},
            {"limit_sigma", r.limit_sigma > 0 ? Json(r.limit_sigma) : Json(nullptr)},
            {"limit_kept", or_null(r.limit_kept)},
            {"within_95_of_limit", or_null(r.inside_95)},
            {"keep_out_metres", or_null(r.keep_out)},
            {"contact", or_null(r.contact)},
            {"replans", r.replans},
            {"stops", r.stops}};
  Json& events = json["events"] = Json::array();
  for (const DriveEvent& e : r.events)
    events.push_back({{"t", four_digits(e.t)},
                      {"x", four_digits(e.at.x())},
                      {"y", four_digits(e.at.y())},
                      {"kind", e.kind},
                      {"reason", e.reason}});
  return json.dump(1) + "\n";
}

}  // namespace waymark::workflows
