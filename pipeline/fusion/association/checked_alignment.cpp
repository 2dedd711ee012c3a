// SPDX-License-Identifier: Apache-2.0
#include "pipeline/fusion/association/checked_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/median.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kFreeGsds = 8;      // standard deviation, in ground sample distances, that leaves poses free
constexpr double kExactGsds = 0.25;  // corrections below this are the noise of the detections

/// Medians over the images that have a pose: ground sample distance and distance to the ground, metres.
struct ViewScale {
  double gsd = 0, distance = 0;
};

ViewScale view_scale(const std::vector<ImageView>& images) {
  std::vector<double> gsds, distances;
  for (const ImageView& image : images) {
    if (!image.view || !(image.gsd > 0)) continue;
    gsds.push_back(image.gsd);
    distances.push_back(image.gsd * image.view->camera.fx);
  }
  return {median(std::move(gsds)), median(std::move(distances))};
}

/// Alignment with less certain poses.
struct Attempt {
  Alignment alignment;
  Repetition found;
  double position_sd = 0, rotation_sd = 0;  // added, metres and radians
  bool unstated = false;                    // only where the poses state none
};

bool has_no_position_sd(const ImageView& image) {
  return image.view && image.view->covariance.diagonal().tail<3>().isZero(0);
}

bool has_no_rotation_sd(const ImageView& image) {
  return image.view && image.view->covariance.diagonal().head<3>().isZero(0);
}

/// Root mean square shift, metres, of the images whose pose lacks an uncertainty.
double shift_of_unstated(const std::vector<ImageView>& images, const std::vector<double>& shifts) {
  double squares = 0, count = 0;
  for (std::size_t i = 0; i < images.size(); ++i)
    if (lacks_uncertainty(images[i])) squares += shifts[i] * shifts[i], ++count;
  return std::sqrt(squares / std::max(count, 1.0));
}

}  // namespace

bool lacks_uncertainty(const ImageView& image) {
  return has_no_position_sd(image) || has_no_rotation_sd(image);
}

CheckedAlignment align_and_check(const std::vector<Observation>& observations,
                                 const std::vector<ImageView>& images, const Terrain& terrain,
                                 const TypeRegistry& types, const Crs& crs,
                                 const CheckedAlignmentRules& rules) {
  using Verdict = CheckedAlignment::Verdict;
  CheckedAlignment made;
  made.alignment = align_images(observations, images, terrain, types, crs, rules.alignment);
  const auto measure = [&](const Alignment& alignment) {
    return measure_repetition(alignment.observations, alignment.images, types, crs, rules.repetition);
  };
  made.stated = made.aligned = measure(made.alignment);
  if (made.stated.expected < rules.min_expected || made.alignment.too_many) return made;
  made.verdict = Verdict::sound;

  const ViewScale scale = view_scale(images);
  const auto widen = [&](double position_sd, bool unstated) {
    AlignmentRules wider = rules.alignment;
    wider.added_position_sd = position_sd;
    wider.added_rotation_sd = position_sd / scale.distance;
    wider.added_where_unstated = unstated;
    return align_images(observations, images, terrain, types, crs, wider);
  };
  const auto keep = [&](Attempt attempt) {
    made.alignment = std::move(attempt.alignment);
    made.aligned = attempt.found;
    made.added_position_sd = attempt.position_sd;
    made.added_rotation_sd = attempt.rotation_sd;
    made.unstated = attempt.unstated;
    made.verdict = Verdict::widened;
  };
  if (!(scale.gsd > 0)) return made;
  const bool no_positions = std::ranges::any_of(images, has_no_position_sd),
             no_rotations = std::ranges::any_of(images, has_no_rotation_sd);
  if (no_positions || no_rotations) {
    // Unknown is not zero: the corrections of poses left free show how large their errors are.
    const double sd = shift_of_unstated(images, widen(kFreeGsds * scale.gsd, true).shifts);
    Attempt attempt{widen(sd, true), {}, no_positions ? sd : 0, no_rotations ? sd / scale.distance : 0, true};
    attempt.found = measure(attempt.alignment);
    if (sd > kExactGsds * scale.gsd && attempt.found.found() > made.stated.found() - rules.step_gain)
      keep(std::move(attempt));
  }
  if (made.aligned.found() < rules.certain) {
    std::optional<Attempt> best;
    for (int k = 0; k < rules.widenings; ++k) {
      const double position_sd = scale.gsd * std::exp2(k);
      Attempt attempt{widen(position_sd, false), {}, position_sd, position_sd / scale.distance};
      attempt.found = measure(attempt.alignment);
      if (attempt.found.expected < rules.min_expected) continue;
      if (!best || attempt.found.found() > best->found.found() + rules.step_gain) best = std::move(attempt);
    }
    if (best && best->found.found() > made.aligned.found() + rules.min_gain) keep(std::move(*best));
  }
  if (made.stated.found() < rules.certain) {
    const double needed =
        std::max(made.stated.found() + rules.min_gain, made.aligned.found() - rules.cause_loss);
    made.causes = find_common_errors(observations, images, terrain, types, crs,
                                     {.alignment = rules.alignment, .repetition = rules.repetition});
    std::erase_if(made.causes,
                  [&](const CommonGeometryError& cause) { return cause.found.found() < needed; });
  }
  const double found = made.aligned.found();
  if (found < rules.sound) made.verdict = found < rules.wrong ? Verdict::wrong : Verdict::doubtful;
  if (!made.causes.empty() && made.stated.found() < rules.sound) made.verdict = Verdict::wrong;
  return made;
}

}  // namespace waymark::pipeline
