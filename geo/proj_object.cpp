// SPDX-License-Identifier: Apache-2.0
#include "geo/proj_object.hpp"

#include <proj.h>

#include <utility>

namespace waymark::inline geo {

void ProjRelease::operator()(PJconsts* object) const {
  proj_destroy(object);
}

ProjContext::ProjContext() : context_(proj_context_create()) {
  proj_context_set_enable_network(context_, 0);
  proj_log_level(context_, PJ_LOG_ERROR);
  proj_log_func(context_, &message_,
                [](void* message, int, const char* text) { *static_cast<std::string*>(message) = text; });
}

ProjContext::~ProjContext() {
  proj_context_destroy(context_);
}

std::string ProjContext::take_message() {
  std::string text = std::exchange(message_, {});
  if (text.starts_with("proj_"))
    if (const auto colon = text.find(": "); colon != std::string::npos) text.erase(0, colon + 2);
  return text;
}

ProjContext& ProjContext::current() {
  thread_local ProjContext context;
  return context;
}

}  // namespace waymark::inline geo
