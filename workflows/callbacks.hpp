// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include "pipeline/engine/progress.hpp"
namespace waymark::workflows {

/// Purpose of a message.
enum class MessageKind {
  detail,   ///< of interest to a verbose log only
  summary,  ///< text for people, written as it is; lines end in \n
  warning,  ///< one sentence without \n
  failure,  ///< a failed unit of work; a summary lists it as well, so a log that shows summaries skips it
  result,   ///< machine-readable lines that belong on standard output
};

/// Text that a workflow sends while it runs.
struct Message {
  MessageKind kind = MessageKind::summary;
  std::string text;
};

/// Functions that a workflow calls while it runs. Empty functions are not called. They are called from one
/// thread at a time.
struct Callbacks {
  pipeline::ProgressListener progress = {};
  std::function<void(const Message&)> message = {};

  void send(MessageKind kind, std::string text) const {
    if (message) message({kind, std::move(text)});
  }
  void summary(std::string text) const { send(MessageKind::summary, std::move(text)); }
  void warning(std::string text) const { send(MessageKind::warning, std::move(text)); }
};

}  // namespace waymark::workflows
