// SPDX-License-Identifier: Apache-2.0
#include "apps/console.hpp"

#include <iostream>

#include "apps/log.hpp"
#include "apps/progress.hpp"

namespace waymark::apps {
namespace {

void write_message(const workflows::Message& message) {
  switch (message.kind) {
    case workflows::MessageKind::detail:
      return log_detail(message.text);
    case workflows::MessageKind::summary:
      return log_summary(message.text);
    case workflows::MessageKind::warning:
      return log_warning(message.text);
    case workflows::MessageKind::failure:  // a quiet log has no summary that lists it
      if (quiet_log()) log_error(message.text);
      return;
    case workflows::MessageKind::result:
      std::cout << message.text;
  }
}

}  // namespace

workflows::Callbacks console_callbacks(const Session& session) {
  return {.progress = progress_renderer(session), .message = write_message};
}

}  // namespace waymark::apps
