// SPDX-License-Identifier: Apache-2.0
#include "localization/slam/graph_solver.hpp"

#include <ceres/ceres.h>
#include <fmt/format.h>

#include <algorithm>

#include "core/error.hpp"
#include "localization/slam/graph_initialization.hpp"
#include "localization/slam/graph_marginals.hpp"

namespace waymark::localization {
namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajor23 = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;
using RowMajor2 = Eigen::Matrix<double, 2, 2, Eigen::RowMajor>;
using Parameters = double const* const*;

// Headings are not wrapped: errors are taken the short way round, so no manifold is needed.
Pose2 pose_at(const double* p) {
  return {p[0], p[1], p[2]};
}

class StepCost final : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit StepCost(const StepEdge& edge) : edge_(edge) {}
  bool Evaluate(Parameters p, double* residuals, double** jacobians) const override {
    const StepError e = step_error(edge_, pose_at(p[0]), pose_at(p[1]));
    Eigen::Map<Eigen::Vector3d>{residuals} = e.value;
    if (jacobians && jacobians[0]) Eigen::Map<RowMajor3>{jacobians[0]} = e.by_from;
    if (jacobians && jacobians[1]) Eigen::Map<RowMajor3>{jacobians[1]} = e.by_to;
    return true;
  }

 private:
  const StepEdge& edge_;
};

class SightingCost final : public ceres::SizedCostFunction<2, 3, 2> {
 public:
  SightingCost(const SightingEdge& edge, const SlamLine* line) : edge_(edge), line_(line) {}
  bool Evaluate(Parameters p, double* residuals, double** jacobians) const override {
    const SightingError e =
        sighting_error(edge_, pose_at(p[0]), Eigen::Map<const Eigen::Vector2d>(p[1]), line_);
    Eigen::Map<Eigen::Vector2d>{residuals} = e.value;
    if (jacobians && jacobians[0]) Eigen::Map<RowMajor23>{jacobians[0]} = e.by_pose;
    if (jacobians && jacobians[1]) Eigen::Map<RowMajor2>{jacobians[1]} = e.by_landmark;
    return true;
  }

 private:
  const SightingEdge& edge_;
  const SlamLine* line_;
};

class PieceCost final : public ceres::SizedCostFunction<2, 3, 2, 2> {
 public:
  PieceCost(const SightingEdge& edge, const SlamLine& line) : edge_(edge), line_(line) {}
  bool Evaluate(Parameters p, double* residuals, double** jacobians) const override {
    const SightingError e = sighting_error(edge_, pose_at(p[0]), Eigen::Map<const Eigen::Vector2d>(p[1]),
                                           &line_, Eigen::Map<const Eigen::Vector2d>(p[2]));
    Eigen::Map<Eigen::Vector2d>{residuals} = e.value;
    if (jacobians && jacobians[0]) Eigen::Map<RowMajor23>{jacobians[0]} = e.by_pose;
    if (jacobians && jacobians[1]) Eigen::Map<RowMajor2>{jacobians[1]} = e.by_landmark;
    if (jacobians && jacobians[2]) Eigen::Map<RowMajor2>{jacobians[2]} = e.by_deviation;
    return true;
  }

 private:
  const SightingEdge& edge_;
  const SlamLine& line_;
};

class PoseCost final : public ceres::SizedCostFunction<3, 3> {
 public:
  explicit PoseCost(const PosePrior& prior) : prior_(prior) {}
  bool Evaluate(Parameters p, double* residuals, double** jacobians) const override {
    Eigen::Map<Eigen::Vector3d>{residuals} = prior_error(prior_, pose_at(p[0]));
    if (jacobians && jacobians[0]) Eigen::Map<RowMajor3>{jacobians[0]} = prior_.root;
    return true;
  }

 private:
  const PosePrior& prior_;
};

/// Of a landmark or of the deviation of a piece.
template <class Prior>
class PairCost final : public ceres::SizedCostFunction<2, 2> {
 public:
  explicit PairCost(const Prior& prior) : prior_(prior) {}
  bool Evaluate(Parameters p, double* residuals, double** jacobians) const override {
    Eigen::Map<Eigen::Vector2d>{residuals} = prior_error(prior_, Eigen::Map<const Eigen::Vector2d>(p[0]));
    if (jacobians && jacobians[0]) Eigen::Map<RowMajor2>{jacobians[0]} = prior_.root;
    return true;
  }

 private:
  const Prior& prior_;
};

std::unique_ptr<ceres::LossFunction> loss_of(const GraphOptions& options) {
  if (options.kernel == "huber") return std::make_unique<ceres::HuberLoss>(options.kernel_width);
  if (options.kernel == "cauchy") return std::make_unique<ceres::CauchyLoss>(options.kernel_width);
  return nullptr;
}

ceres::Problem::Options problem_options() {
  ceres::Problem::Options options;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return options;
}

/// Least-squares problem to which poses are added one by one.
class IncrementalProblem {
 public:
  IncrementalProblem(const PoseGraph& graph, const GraphOptions& options)
      : graph_(graph),
        options_(options),
        loss_(loss_of(options)),
        problem_(problem_options()),
        at_(graph.poses.size()),
        there_(graph.landmarks.size()),
        deviations_(graph.deviations.size(), Eigen::Vector2d::Zero()),
        placed_(graph.poses.size(), false),
        known_(graph.landmarks.size(), false),
        steps_of_(graph.poses.size()),
        sightings_of_(graph.poses.size()),
        waiting_(graph.landmarks.size()) {
    for (std::size_t i = 0; i < graph.steps.size(); ++i) {
      steps_of_[graph.steps[i].from].push_back(i);
      steps_of_[graph.steps[i].to].push_back(i);
    }
    for (std::size_t i = 0; i < graph.sightings.size(); ++i)
      sightings_of_[graph.sightings[i].pose].push_back(i);
    for (const LandmarkPrior& prior : graph.landmark_priors) {
      if (!known_[prior.landmark]) place(prior.landmark, prior.at);
      problem_.AddResidualBlock(new PairCost(prior), nullptr, there_[prior.landmark].data());
    }
  }

  void add(const InitializationStep& next, bool from_guess) {
    const std::size_t i = next.pose;
    at_[i] = (from_guess ? graph_.poses[i].at : guess(next)).vector();
    placed_[i] = true;
    problem_.AddParameterBlock(at_[i].data(), 3);
    if (graph_.poses[i].fixed || (i == 0 && !has_gauge(graph_)))
      problem_.SetParameterBlockConstant(at_[i].data());
    for (const PosePrior& prior : graph_.pose_priors)
      if (prior.pose == i) problem_.AddResidualBlock(new PoseCost(prior), nullptr, at_[i].data());
    for (const std::size_t s : steps_of_[i]) {
      const StepEdge& e = graph_.steps[s];
      if (placed_[e.from] && placed_[e.to])
        problem_.AddResidualBlock(new StepCost(e), loss_of_step(e), at_[e.from].data(), at_[e.to].data());
    }
    for (const std::size_t s : sightings_of_[i]) add_sighting(s, from_guess);
  }

  ceres::Solver::Summary solve(int iterations, double tolerance) {
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    solver.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;  // no BLAS: the same bits everywhere
    solver.num_threads = 1;
    solver.max_num_iterations = iterations;
    solver.function_tolerance = tolerance;
    solver.parameter_tolerance = 1e-12;
    solver.gradient_tolerance = 1e-12;
    solver.logging_type = ceres::SILENT;
    solver.initial_trust_region_radius = 1e6;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem_, &summary);
    return summary;
  }

  PoseGraph result() const {
    PoseGraph graph = graph_;
    for (std::size_t i = 0; i < at_.size(); ++i) graph.poses[i].at = pose_of(at_[i]);
    for (std::size_t i = 0; i < there_.size(); ++i) graph.landmarks[i].at = there_[i];
    for (std::size_t i = 0; i < deviations_.size(); ++i) graph.deviations[i].at = deviations_[i];
    return graph;
  }

  std::optional<std::size_t> undetermined_landmark() const {
    const auto lost = std::ranges::find(known_, false);
    return lost == known_.end() ? std::nullopt
                                : std::optional(static_cast<std::size_t>(lost - known_.begin()));
  }

 private:
  // Odometry has no kernel; an edge between poses that are not neighbours may be a false loop closure.
  ceres::LossFunction* loss_of_step(const StepEdge& e) const {
    return (e.from < e.to ? e.to - e.from : e.from - e.to) > 1 ? loss_.get() : nullptr;
  }

  Pose2 guess(const InitializationStep& next) const {
    if (next.by_step) {
      const StepEdge& e = graph_.steps[*next.by_step];
      return e.to == next.pose ? pose_of(at_[e.from]) * e.step : pose_of(at_[e.to]) * inverse(e.step);
    }
    PoseGraph now = graph_;
    for (const std::size_t s : sightings_of_[next.pose])
      now.landmarks[graph_.sightings[s].landmark].at = there_[graph_.sightings[s].landmark];
    if (const auto pose = resect_pose(now, sightings_of_[next.pose], known_)) return *pose;
    return graph_.poses[next.pose].at;
  }

  void place(std::size_t landmark, const Eigen::Vector2d& at) {
    there_[landmark] = at;
    known_[landmark] = true;
    problem_.AddParameterBlock(there_[landmark].data(), 2);
    for (const std::size_t s : waiting_[landmark]) tie(s);
    waiting_[landmark].clear();
  }

  void tie(std::size_t s) {
    const SightingEdge& e = graph_.sightings[s];
    const auto& line = graph_.landmarks[e.landmark].line;
    double *const pose = at_[e.pose].data(), *const landmark = there_[e.landmark].data();
    if (!e.deviation) {
      problem_.AddResidualBlock(new SightingCost(e, line ? &*line : nullptr), loss_.get(), pose, landmark);
      return;
    }
    double* const deviation = deviations_[*e.deviation].data();
    if (!problem_.HasParameterBlock(deviation))
      problem_.AddResidualBlock(new PairCost(graph_.deviations[*e.deviation]), nullptr, deviation);
    problem_.AddResidualBlock(new PieceCost(e, *line), loss_.get(), pose, landmark, deviation);
  }

  void add_sighting(std::size_t s, bool from_guess) {
    const SightingEdge& e = graph_.sightings[s];
    if (known_[e.landmark]) return tie(s);
    waiting_[e.landmark].push_back(s);
    if (from_guess && graph_.landmarks[e.landmark].given)
      place(e.landmark, graph_.landmarks[e.landmark].at);
    else if (e.kind == SightingKind::line)
      place(e.landmark, line_state(e, pose_of(at_[e.pose]), *graph_.landmarks[e.landmark].line));
    else if (const auto at = landmark_position(e, pose_of(at_[e.pose])))
      place(e.landmark, *at);
    else if (e.kind == SightingKind::bearing)
      if (const auto crossing = intersect_rays(ray(first_bearing(waiting_[e.landmark])), ray(s)))
        place(e.landmark, *crossing);
  }

  std::size_t first_bearing(const std::vector<std::size_t>& sightings) const {
    return *std::ranges::find(sightings, SightingKind::bearing,
                              [&](std::size_t i) { return graph_.sightings[i].kind; });
  }

  /// Returns the ray from the sensor along a bearing.
  Pose2 ray(std::size_t sighting) const {
    const SightingEdge& e = graph_.sightings[sighting];
    Pose2 sensor = pose_of(at_[e.pose]) * e.robot_from_sensor;
    sensor.yaw += e.value[1];
    return sensor;
  }

  const PoseGraph& graph_;
  const GraphOptions& options_;
  std::unique_ptr<ceres::LossFunction> loss_;
  ceres::Problem problem_;
  std::vector<Eigen::Vector3d> at_;
  std::vector<Eigen::Vector2d> there_, deviations_;
  std::vector<bool> placed_, known_;
  std::vector<std::vector<std::size_t>> steps_of_, sightings_of_, waiting_;
};

constexpr double kRough = 1e-4, kFine = 1e-10;  // relative change of chi2 at which an optimisation ends
constexpr int kRoughIterations = 15;

GraphSolution solve_incrementally(const PoseGraph& graph, const std::vector<InitializationStep>& order,
                                  const GraphOptions& options, std::size_t block, bool from_guess) {
  IncrementalProblem problem(graph, options);
  GraphSolution solution;
  for (std::size_t i = 0; i < order.size(); ++i) {
    problem.add(order[i], from_guess);
    const bool last = i + 1 == order.size();
    if (!last && (block == 0 || (i + 1) % block != 0)) continue;
    const auto summary =
        problem.solve(last ? static_cast<int>(options.iterations) : kRoughIterations, last ? kFine : kRough);
    if (!summary.IsSolutionUsable())
      throw Error(ErrorCode::input, "the graph cannot be solved: " + summary.message, "",
                  "check its measurements and information matrices");
    solution.iterations += static_cast<int>(summary.iterations.size()) - 1;
    ++solution.optimisations;
    solution.converged = summary.termination_type == ceres::CONVERGENCE;
  }
  if (const auto landmark = problem.undetermined_landmark())
    throw Error(
        ErrorCode::input,
        fmt::format(
            "landmark {} of the graph has no position: its bearings do not cross, or it has ranges alone",
            graph.landmarks[*landmark].id),
        "", "remove it, or add sightings from other positions");
  solution.graph = problem.result();
  solution.chi2 = chi2(solution.graph);
  return solution;
}

}  // namespace

void GraphOptions::describe(OptionVisitor& option) {
  option("graph_block", block,
         {.help = "Poses added between two optimisations of a graph; 0: all at once", .min = 0});
  option("graph_iterations", iterations,
         {.help = "Largest number of iterations of the last optimisation", .min = 1});
  option("graph_kernel", kernel,
         {.help = "Robust kernel of sightings and loops; auto: none for graph files, huber for logs",
          .choices = {"auto", "none", "huber", "cauchy"}});
  option("graph_kernel_width", kernel_width,
         {.help = "Standard deviations from which the kernel reduces an error's weight", .min = 0.01});
}

GraphSolution optimise(PoseGraph graph, const GraphOptions& options) {
  const std::vector<InitializationStep> order = initialization_order(graph);
  const std::size_t residuals = residual_count(graph), unknowns = unknown_count(graph);
  // Twice the expected errors if all covariances are right: such a minimum needs no further search.
  const double good = 2 * static_cast<double>(std::max(residuals, unknowns + 1) - unknowns) + 10;
  const bool guessed = std::ranges::all_of(graph.poses, &GraphPose::given);
  std::optional<GraphSolution> best;
  const auto attempt = [&](std::int64_t block, bool from_guess) {
    if (best && best->chi2 <= good) return;
    GraphSolution one =
        solve_incrementally(graph, order, options, static_cast<std::size_t>(block), from_guess);
    if (!best || one.chi2 < best->chi2) best = std::move(one);
  };
  if (guessed) attempt(0, true);
  if (!guessed || options.block > 0) attempt(options.block, false);
  if (options.block > 1 && graph.poses.size() > static_cast<std::size_t>(options.block) / 4)
    attempt(std::max<std::int64_t>(1, options.block / 4), false);
  best->start_chi2 = guessed ? chi2(graph) : 0;
  best->residuals = residuals;
  best->unknowns = unknowns;
  if (options.covariances) {
    GraphMarginals marginals = graph_marginals(best->graph, options.kernel, options.kernel_width);
    best->pose_covariances = std::move(marginals.poses);
    best->landmark_covariances = std::move(marginals.landmarks);
  }
  return *std::move(best);
}

}  // namespace waymark::localization
