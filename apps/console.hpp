// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "apps/session.hpp"
#include "workflows/callbacks.hpp"
namespace waymark::apps {

/// Returns callbacks that draw progress and write messages as the global options ask for: results to standard
/// output, all else to the log.
workflows::Callbacks console_callbacks(const Session& session);

}  // namespace waymark::apps
