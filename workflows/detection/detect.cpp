// SPDX-License-Identifier: Apache-2.0
#include "workflows/detection/detect.hpp"

#include <fmt/format.h>

#include <chrono>

#include "workflows/detection/detection_plan.hpp"
#include "workflows/detection/run_detection.hpp"
#include "workflows/detection/write_detections.hpp"

namespace waymark::workflows {

DetectResult detect(const DetectRequest& request, const Callbacks& callbacks) {
  const DetectionPlan plan = plan_detection(request);
  if (!request.output.empty()) check_detection_output(request.output);
  const auto started = std::chrono::system_clock::now();
  for (const std::string& warning : plan.warnings) callbacks.warning(warning);
  DetectResult found = run_detection(plan, request.threads, callbacks.progress);
  for (const std::string& warning : found.warnings) callbacks.warning(warning);
  found.warnings.insert(found.warnings.begin(), plan.warnings.begin(), plan.warnings.end());
  if (!found.light.empty()) callbacks.summary(found.light + "\n");
  if (request.output.empty()) return found;
  const DetectionOutput output{request.output, plan.image->info().path, request.command_line, started};
  write_detections(found.detections, output, callbacks);
  callbacks.summary(
      fmt::format("{}: {} {}\n", request.output, found.detections.detections.size(), request.kind));
  return found;
}

}  // namespace waymark::workflows
