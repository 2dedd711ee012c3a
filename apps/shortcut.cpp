// SPDX-License-Identifier: Apache-2.0
#include "apps/shortcut.hpp"

#include <iostream>

#include "apps/map_arguments.hpp"
#include "workflows/registries.hpp"

namespace waymark::apps {

CommandSpec Shortcut::describe() {
  CommandSpec spec = describe_own();
  for (auto& argument : map_arguments(request_)) spec.arguments.push_back(std::move(argument));
  for (auto& argument : options_.arguments()) spec.arguments.push_back(std::move(argument));
  spec.arguments.push_back(
      {"--print-job", "", &print_job_, "Print the job instead of running it: the start of one of your own"});
  return spec;
}

int Shortcut::run(const Session& session) {
  pipeline::Pipeline pipeline(workflows::all_stages());
  add_stages(pipeline);
  options_.apply(pipeline);
  const pipeline::Job job{describe_own().name, std::move(pipeline)};
  if (!print_job_) return make_map_command(job, request_, session);
  std::cout << pipeline::job_as_json(job.name, job.pipeline) << '\n';
  return 0;
}

}  // namespace waymark::apps
