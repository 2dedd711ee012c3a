// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string_view>
#include "apps/session.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::apps {

/// Returns callbacks that draw progress and write messages as the global options ask for: results to standard
/// output, all else to the log. Under the format "json" results go to the log, too: the object that the
/// command prints at its end is alone on standard output.
workflows::Callbacks console_callbacks(const Session& session, std::string_view format = "text");

}  // namespace waymark::apps
