// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/lens_ladder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pipeline/reconstruction/adjustment/left_out_points.hpp"

namespace waymark::pipeline {
namespace {

using Group = std::vector<std::string>;

std::vector<Group> groups_of(const Camera& camera) {
  std::vector<Group> groups{{"f"}, {"k1"}, {"k2"}, {"cx", "cy"}};
  if (camera.lens == Camera::Lens::brown) groups.push_back({"p1", "p2"});
  return groups;
}

bool contains(const std::vector<std::string>& all, const std::string& name) {
  return std::ranges::count(all, name) > 0;
}

// Difference of an estimate from the prior that is part of it, as a normal variable.
double deviation_from_prior(double value, double sd, const LensPrior& prior) {
  const double variance = prior.sd * prior.sd - sd * sd;
  return variance > 0 ? std::abs(value - prior.value) / std::sqrt(variance) : 0;
}

/// Climbs the ladder with a scene whose left-out points are set apart.
class Ladder {
 public:
  Ladder(Reconstruction& scene, const Observations& observations, AdjustmentOptions options,
         const LadderOptions& limits)
      : scene_(scene), seen_(observations), options_(std::move(options)), limits_(limits) {
    options_.free_lens_parameters.resize(scene.lenses.size());
    add_priors();
    SplitPoints split = split_points(scene);
    left_out_ = std::move(split.left_out);
    best_ = scene;
    best_.points = std::move(split.kept);
    kept_ = best_.points;
  }

  CalibratedAdjustment climb() {
    adjust(best_, seen_, options_);
    residual_ = left_out_residual(best_, left_out_);
    for (std::size_t lens = 0; lens < scene_.lenses.size(); ++lens)
      while (climb_once(lens)) {
      }
    scene_.lenses = best_.lenses;
    for (std::size_t i = 0; i < scene_.images.size(); ++i)
      if (best_.images[i].world_from_camera) {
        scene_.images[i].world_from_camera = best_.images[i].world_from_camera;
        scene_.images[i].motion = best_.images[i].motion;
      }
    out_.adjustment = adjust(scene_, seen_, options_);
    out_.priors = seen_.lenses;
    for (LadderStep& step : out_.steps) {
      for (const LensParameter& p : out_.adjustment.lenses[step.lens])
        if (step.admitted && p.name == step.parameter) step.value = p.value, step.sd = p.sd;
    }
    return std::move(out_);
  }

 private:
  void add_priors() {
    for (std::size_t lens = 0; lens < scene_.lenses.size(); ++lens) {
      const Camera& camera = scene_.lenses[lens].camera;
      const auto model = lens_model(camera);
      const Eigen::VectorXd values = model->parameters(camera);
      for (const Group& group : groups_of(camera))
        for (const std::string& name : group) {
          const auto given = std::ranges::any_of(
              seen_.lenses, [&](const LensPrior& p) { return p.lens == lens && p.parameter == name; });
          const auto index = std::ranges::find(model->names(), name) - model->names().begin();
          if (!given) seen_.lenses.push_back(default_prior(camera, lens, name, values[index]));
        }
    }
  }

  std::size_t prior_index(std::size_t lens, const std::string& name) const {
    const auto found = std::ranges::find_if(
        seen_.lenses, [&](const LensPrior& p) { return p.lens == lens && p.parameter == name; });
    return static_cast<std::size_t>(found - seen_.lenses.begin());
  }
  const LensPrior& prior(std::size_t lens, const std::string& name) const {
    return seen_.lenses[prior_index(lens, name)];
  }

  // Returns whether a term was refused although another one entered after it: the refusal may no longer hold.
  // The focal length, tried first, can fit worse as long as the distortion is not modelled.
  bool climb_once(std::size_t lens) {
    bool refused = false, again = false;
    for (const Group& group : groups_of(scene_.lenses[lens].camera)) {
      if (is_free(lens, group)) continue;
      const bool admitted = try_group(lens, group);
      if (limits_.progress) limits_.progress();
      again = again || (admitted && refused);
      refused = refused || !admitted;
    }
    return again;
  }

  bool is_free(std::size_t lens, const Group& group) const {
    return std::ranges::all_of(
        group, [&](const std::string& n) { return contains(options_.free_lens_parameters[lens], n); });
  }

  // Admits a group as a whole, or not at all. Returns whether it was admitted.
  bool try_group(std::size_t lens, const Group& group) {
    auto& free = options_.free_lens_parameters[lens];
    const std::vector<std::string> already = free;
    for (const std::string& name : group)
      if (!contains(free, name)) free.push_back(name);
    // From the best poses, but with all marks: what a worse lens rejected may fit now.
    Reconstruction trial = best_;
    trial.points = kept_;
    const AdjustmentResult result = adjust(trial, seen_, options_);
    const double after = left_out_residual(trial, left_out_);
    std::vector<LadderStep> steps;
    for (const std::string& name : group) steps.push_back(judge(trial, result, lens, name, already, after));
    const auto refused = std::ranges::find_if(steps, [](const LadderStep& s) { return !s.reason.empty(); });
    for (LadderStep& step : steps) {
      step.admitted = refused == steps.end();
      if (!step.admitted && step.reason.empty())
        step.reason = fmt::format("it enters together with {}", refused->parameter);
      if (!step.admitted) step.value = prior(lens, step.parameter).value;
      std::erase_if(out_.steps, [&](const LadderStep& earlier) {
        return earlier.lens == step.lens && earlier.parameter == step.parameter;
      });
      out_.steps.push_back(step);
    }
    if (refused != steps.end()) {
      free = already;
      return false;
    }
    drop_contradicted_priors(trial, result, lens);
    best_ = std::move(trial);
    residual_ = after;
    return true;
  }

  // Priors that the images contradict would still pull at them. Those of terms that entered earlier are
  // judged again, since a later one can move them.
  void drop_contradicted_priors(const Reconstruction& trial, const AdjustmentResult& result,
                                std::size_t lens) {
    const AdjustedLens& adjusted = trial.lenses[lens];
    for (LadderStep& step : out_.steps) {
      if (step.lens != lens || !step.admitted) continue;
      const auto at = std::ranges::find(adjusted.parameters, step.parameter) - adjusted.parameters.begin();
      const double value = result.lenses[lens][static_cast<std::size_t>(at)].value;
      const double sd = std::sqrt(adjusted.covariance(at, at));
      LensPrior& before = seen_.lenses[prior_index(lens, step.parameter)];
      if (deviation_from_prior(value, sd, before) <= limits_.max_deviation) continue;
      before.sd = std::max(before.sd, std::abs(value - before.value));
      step.contradicts = true;
    }
  }

  LadderStep judge(const Reconstruction& trial, const AdjustmentResult& result, std::size_t lens,
                   const std::string& name, const std::vector<std::string>& already, double after) const {
    LadderStep step{.lens = lens,
                    .parameter = name,
                    .prior_value = prior(lens, name).value,
                    .prior_sd = prior(lens, name).sd,
                    .left_out_before = residual_,
                    .left_out_after = after};
    const AdjustedLens& adjusted = trial.lenses[lens];
    const auto place = std::ranges::find(adjusted.parameters, name);
    if (!result.determined || place == adjusted.parameters.end() || adjusted.covariance.size() == 0) {
      step.reason = "the images do not determine it";
      return step;
    }
    const auto at = place - adjusted.parameters.begin();
    step.value = result.lenses[lens][static_cast<std::size_t>(at)].value;
    step.sd = std::sqrt(adjusted.covariance(at, at));
    for (std::size_t i = 0; i < adjusted.parameters.size(); ++i) {
      const auto other = static_cast<Eigen::Index>(i);
      if (other == at || !contains(already, adjusted.parameters[i])) continue;
      const double r = std::abs(adjusted.covariance(at, other)) /
                       std::sqrt(adjusted.covariance(at, at) * adjusted.covariance(other, other));
      if (r > step.correlation) step.correlation = r, step.correlated_with = adjusted.parameters[i];
    }
    if (!(step.sd < limits_.max_sd * step.prior_sd))
      step.reason =
          fmt::format("its standard deviation of {:.3g} is more than {:.2g} of that known before, {:.3g}",
                      step.sd, limits_.max_sd, step.prior_sd);
    else if (!(step.correlation <= limits_.max_correlation))
      step.reason = fmt::format("its correlation to {} is {:.3f}, more than {:.2f}", step.correlated_with,
                                step.correlation, limits_.max_correlation);
    else if (const double off = deviation_from_prior(step.value, step.sd, prior(lens, name));
             !(off <= limits_.max_deviation || after <= (1 - limits_.min_fall) * residual_))
      step.reason = fmt::format(
          "its estimate of {:.6g} is {:.1f} standard deviations from what is known, but the residuals of "
          "left-out "
          "points hardly fall, from {:.3f} to {:.3f} sd: unmodelled errors (rolling shutter), or a wrong "
          "focal length "
          "in the metadata",
          step.value, off, residual_, after);
    else if (!(after < residual_))
      step.reason = fmt::format("the residuals of left-out points do not fall: {:.4f}, then {:.4f} sd",
                                residual_, after);
    return step;
  }

  Reconstruction& scene_;
  Observations seen_;
  AdjustmentOptions options_;
  const LadderOptions& limits_;
  Reconstruction best_;
  std::vector<TiePoint> kept_, left_out_;
  double residual_ = 0;
  CalibratedAdjustment out_;
};

}  // namespace

std::size_t ladder_groups(const Camera& camera) {
  return groups_of(camera).size();
}

LensPrior default_prior(const Camera& camera, std::size_t lens, const std::string& parameter, double value) {
  LensPrior prior{lens, parameter, value, 0.2};
  if (parameter == "f") prior.sd = 0.1 * value;
  if (parameter == "cx" || parameter == "cy") prior.sd = 0.02 * static_cast<double>(camera.columns);
  if (parameter == "p1" || parameter == "p2") prior.sd = 0.005;
  return prior;
}

CalibratedAdjustment adjust_with_ladder(Reconstruction& scene, const Observations& observations,
                                        AdjustmentOptions options, const LadderOptions& ladder) {
  return Ladder(scene, observations, std::move(options), ladder).climb();
}

}  // namespace waymark::pipeline
