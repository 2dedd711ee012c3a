// SPDX-License-Identifier: Apache-2.0
#include "pipeline/engine/runner.hpp"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <exception>
#include <fstream>

#include "core/error.hpp"
#include "pipeline/engine/run/run.hpp"
#include "pipeline/engine/sha256.hpp"

namespace waymark::pipeline {
namespace {

/// Runs `work` with at most that many threads, including the calling one.
template <class Work>
void run_with_threads(int threads, Work work) {
  const int available = tbb::info::default_concurrency();
  const int wanted = threads == 0 ? available : threads;
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(std::max(wanted, available)));
  tbb::task_arena(wanted).execute(work);
}

}  // namespace

InputFile hash_plain_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  Sha256 sum;
  InputFile measured{.path = path, .bytes = 0, .sha256 = {}};
  std::vector<char> block(1 << 20);
  while (file) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    const auto count = static_cast<std::size_t>(file.gcount());
    sum.add({block.data(), count});
    measured.bytes += count;
  }
  if (!file.eof())
    throw Error(ErrorCode::input, std::string("cannot read an input file: ") + std::strerror(errno), path,
                "check the path in the job; it is relative to the job file");
  measured.sha256 = sum.hex();
  return measured;
}

RunResult run(const Pipeline& pipeline, const RunOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const bool keeps = !options.work.empty();
  Run run(pipeline, options);
  run_with_threads(options.threads, [&] {
    // A stage reports an unreadable file more precisely, so a failed hash is rethrown last. The task group
    // must not receive a second exception.
    std::exception_ptr unreadable;
    tbb::task_group beside;  // without a work folder hashes are provenance only
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
  run_with_threads(options.threads, [&] {
    run.hash_inputs();
    run.make_plan(true);
  });
  return run.plan();
}

}  // namespace waymark::pipeline
