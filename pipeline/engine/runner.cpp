// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/runner.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <chrono>
#include <exception>

#include "pipeline/engine/run.hpp"

namespace waymark {
namespace {

/// Runs `work` with at most that many threads, the calling one among them.
template <class Work>
void with_threads(int threads, Work work) {
  const int available = tbb::info::default_concurrency();
  const int wanted = threads == 0 ? available : threads;
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(std::max(wanted, available)));
  tbb::task_arena(wanted).execute(work);
}

}  // namespace

RunResult run(const Pipeline& pipeline, const RunOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const bool keeps = !options.work.empty();
  Run run(pipeline, options);
  with_threads(options.threads, [&] {
    // A stage says better what is wrong with a file, so a hash that fails is told last; and a task group that
    // is left by an exception must not meet a second one.
    std::exception_ptr unreadable;
    tbb::task_group beside;  // without a work folder the hashes are provenance only: nothing waits for them
    if (keeps) run.hash_inputs();
    if (!keeps && !options.check_only)
      beside.run([&] {
        try {
          run.hash_inputs();
        } catch (...) {
          unreadable = std::current_exception();
        }
      });
    run.make_plan(keeps);
    if (!keeps && !options.check_only) beside.run([&] { run.hash_images(); });
    if (!options.check_only) run.run_stages();
    beside.wait();
    if (unreadable) std::rethrow_exception(unreadable);
  });
  RunResult result = run.result();
  result.report.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

Plan plan(const Pipeline& pipeline, const RunOptions& options) {
  Run run(pipeline, options);
  with_threads(options.threads, [&] {
    run.hash_inputs();
    run.make_plan(true);
  });
  return run.plan();
}

}  // namespace waymark
