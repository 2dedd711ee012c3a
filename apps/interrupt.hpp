// SPDX-License-Identifier: Apache-2.0
#pragma once
namespace waymark::apps {

/// Starts to wait for SIGINT and SIGTERM on a thread of its own; call it before any other thread is made.
/// The signal is reported, hidden folders beside outputs are removed, and the process ends by it, so that
/// shells and makefiles see it (exit code 130 or 143). A second one ends the process at once.
void watch_interrupts();

/// Does not return if the process is being ended by a signal: errors that follow from that are not reported.
void wait_if_interrupted();

}  // namespace waymark::apps
