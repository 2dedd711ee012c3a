// SPDX-License-Identifier: Apache-2.0
#include "apps/interrupt.hpp"

#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <thread>

#include "core/locked_folder.hpp"

namespace waymark::apps {
namespace {

std::atomic<bool> is_interrupted = false;

::sigset_t interrupts() {
  ::sigset_t set;
  ::sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM}) ::sigaddset(&set, signal);
  return set;
}

/// Ends the process by the first interrupt.
void end_when_interrupted() {
  const ::sigset_t set = interrupts();
  int signal = 0;
  if (::sigwait(&set, &signal) != 0) return;
  is_interrupted = true;
  for (const int other : {SIGINT, SIGTERM}) ::signal(other, SIG_DFL);
  ::pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
  constexpr char text[] =
      "\nerror: interrupted; an output that was not finished is not put in place\n  with --work, the same "
      "command again continues where it stopped\n";
  static_cast<void>(!::write(STDERR_FILENO, text, sizeof text - 1));
  remove_own_folders();
  ::raise(signal);
}

}  // namespace

void watch_interrupts() {
  const ::sigset_t set = interrupts();
  ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
  std::thread(end_when_interrupted).detach();
}

void wait_if_interrupted() {
  while (is_interrupted) ::pause();
}

}  // namespace waymark::apps
