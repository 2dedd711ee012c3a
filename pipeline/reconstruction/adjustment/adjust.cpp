// SPDX-License-Identifier: Apache-2.0
#include "pipeline/reconstruction/adjustment/adjust.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "pipeline/reconstruction/adjustment/build_network.hpp"
#include "pipeline/reconstruction/adjustment/covariance.hpp"
#include "pipeline/reconstruction/adjustment/frame_changes.hpp"
#include "pipeline/reconstruction/adjustment/motion_scales.hpp"
#include "pipeline/reconstruction/adjustment/outliers.hpp"
#include "pipeline/reconstruction/adjustment/report_adjustment.hpp"
#include "pipeline/reconstruction/adjustment/shutter_motion.hpp"
#include "pipeline/reconstruction/adjustment/solve_network.hpp"

namespace waymark::pipeline {
namespace {

constexpr double kCauchyWidth = 2;  // standard deviations
constexpr int kRounds = 50;         // of removals; each removes at least one observation

/// Solves, removes what does not fit, and solves again.
class Adjustment {
 public:
  Adjustment(Reconstruction& scene, const Observations& observations, const AdjustmentOptions& options)
      : scene_(scene), seen_(observations), options_(options) {
    left_out_ = {
        std::vector<bool>(seen_.control.size()),   std::vector<bool>(seen_.positions.size()),
        std::vector<bool>(seen_.attitudes.size()), std::vector<bool>(seen_.ups.size()),
        std::vector<bool>(seen_.heights.size()),   std::vector<bool>(seen_.heights_above_ground.size()),
        std::vector<bool>(scene_.images.size())};
  }

  AdjustmentResult run() {
    expect_motions(scene_);
    build();
    while (remove(marks_behind(built_.network))) build();
    if (options_.robust) {
      solve_with(kCauchyWidth);
      leave_out_gross();
      remove(outlying_marks(built_.network, options_.outlier_limit));
      build();
    }
    for (int round = 0; round < kRounds; ++round) {
      solve_with(0);
      if (options_.covariance)
        covariance_ = covariance(built_.network);
      else
        covariance_.free_datum = static_cast<int>(free_frame_changes(built_.network).cols());
      if (round + 1 == kRounds) break;
      if (update_motion_scales(round)) {
        build();
        continue;
      }
      if (!options_.robust) break;
      // A wrong coordinate bends its marks: it goes first.
      const double sigma0 = sigma0_of(built_.network, covariance_.free_datum);
      if (!leave_out_blunder(sigma0) && !remove(outlying_marks(built_.network, options_.outlier_limit)))
        break;
      build();
    }
    report(scene_, seen_, built_, covariance_, left_out_, result_);
    if (!options_.covariance) result_.determined = true;  // as far as is known
    return std::move(result_);
  }

 private:
  void build() { built_ = build_network(scene_, seen_, options_, left_out_); }

  void solve_with(double cauchy) {
    const SolveReport solved =
        solve(built_.network, {.cauchy = cauchy, .max_iterations = options_.max_iterations});
    if (!solved.usable)
      throw Error(ErrorCode::input, "the adjustment finds no solution", "",
                  "check the start values of the poses and the standard deviations");
    result_.converged = solved.converged;
    result_.iterations += solved.iterations;
    write_back(built_, scene_);
  }

  // Returns whether anything was removed.
  bool remove(const std::vector<MarkResidual>& outliers) {
    std::vector<std::pair<std::size_t, std::size_t>> tie, control;  // point, mark
    for (const MarkResidual& m : outliers)
      (m.term->kind == Term::Kind::tie_mark ? tie : control).emplace_back(m.term->index, m.term->mark_index);
    for (const MarkResidual& m : outliers) {
      const bool is_tie = m.term->kind == Term::Kind::tie_mark;
      const std::size_t index = m.term->index;
      const Mark& mark =
          (is_tie ? scene_.points[index].marks : seen_.control[index].marks)[m.term->mark_index];
      (is_tie ? result_.removed : result_.removed_control)
          .push_back({index, mark, std::isfinite(m.size) ? m.size * mark.sd : std::nan("")});
    }
    std::ranges::sort(tie, std::greater());  // later marks first, so that indices stay right
    for (const auto& [point, mark] : tie) {
      auto& marks = scene_.points[point].marks;
      marks.erase(marks.begin() + static_cast<std::ptrdiff_t>(mark));
    }
    std::ranges::sort(control, std::greater());
    for (const auto& [point, mark] : control) {
      auto& marks = seen_.control[point].marks;
      marks.erase(marks.begin() + static_cast<std::ptrdiff_t>(mark));
    }
    for (const auto& [point, mark] : tie) drop_if_single(scene_.points[point]);
    return !outliers.empty();
  }

  void drop_if_single(TiePoint& point) const {
    const auto posed = std::ranges::count_if(
        point.marks, [&](const Mark& m) { return scene_.images[m.image].world_from_camera.has_value(); });
    if (posed < 2) point.position.reset(), point.covariance.reset();
  }

  // Returns whether the deviations of expected motions have changed enough for another solution.
  bool update_motion_scales(int round) {
    constexpr int kMotionRounds = 8;
    constexpr double kSettled = 0.05;
    if (!covariance_.determined || round >= kMotionRounds) return false;
    const MotionScales by = motion_scale_changes(built_.network, covariance_, left_out_.motions,
                                                 sigma0_of(built_.network, covariance_.free_datum));
    left_out_.motion_scales.shift *= by.shift;
    left_out_.motion_scales.turn *= by.turn;
    return std::abs(std::log(by.shift)) > kSettled || std::abs(std::log(by.turn)) > kSettled;
  }

  std::vector<bool>* flags_of(Term::Kind kind) {
    switch (kind) {
      case Term::Kind::control:
        return &left_out_.control;
      case Term::Kind::position:
        return &left_out_.positions;
      case Term::Kind::attitude:
        return &left_out_.attitudes;
      case Term::Kind::up:
        return &left_out_.ups;
      case Term::Kind::height:
        return &left_out_.heights;
      case Term::Kind::height_above_ground:
        return &left_out_.heights_above_ground;
      case Term::Kind::motion:
        return &left_out_.motions;
      default:
        return nullptr;
    }
  }

  // Leaves out what is far beyond doubt under the Cauchy loss, before it bends a plain solution.
  void leave_out_gross() {
    for (const auto& term : built_.network.terms) {
      auto* flags = flags_of(term->kind);
      Term::Linear linear;
      if (!flags) continue;
      const bool fits = built_.network.linearize(*term, linear) &&
                        linear.residual.norm() <= 5 * options_.blunder_limit * std::sqrt(term->rows);
      if (!fits && can_spare(*flags)) (*flags)[term->index] = true;
    }
  }

  static bool can_spare(const std::vector<bool>& flags) {
    return 2 * (std::ranges::count(flags, true) + 1) < static_cast<std::ptrdiff_t>(flags.size());
  }

  // Leaves out the observation of the largest statistic, if that leaves the frame as well determined.
  bool leave_out_blunder(double sigma0) {
    if (!covariance_.determined) return false;
    const Term* worst = nullptr;
    double largest = options_.blunder_limit;
    for (const auto& term : built_.network.terms) {
      auto* flags = flags_of(term->kind);
      if (!flags) continue;
      const double statistic = blunder_statistic(built_.network, covariance_, *term, sigma0);
      if (statistic > largest) largest = statistic, worst = term.get();
    }
    if (!worst) return false;
    const Term::Kind kind = worst->kind;
    const std::size_t index = worst->index;
    (*flags_of(kind))[index] = true;
    const BuiltNetwork without = build_network(scene_, seen_, options_, left_out_);
    if (free_frame_changes(without.network).cols() > covariance_.free_datum) {
      (*flags_of(kind))[index] = false;
      return false;
    }
    return true;
  }

  Reconstruction& scene_;
  Observations seen_;
  const AdjustmentOptions& options_;
  LeftOut left_out_;
  BuiltNetwork built_;
  NetworkCovariance covariance_;
  AdjustmentResult result_;
};

}  // namespace

AdjustmentResult adjust(Reconstruction& scene, const Observations& observations,
                        const AdjustmentOptions& options) {
  return Adjustment(scene, observations, options).run();
}

}  // namespace waymark::pipeline
