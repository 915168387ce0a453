// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/process/grace_period.h"

#include <sys/time.h>

#include <cmath>
#include <csignal>

namespace zoneplate {
namespace {

// The state of a signal handler, which has no arguments of its own.
volatile std::sig_atomic_t begun = 0;
itimerval period{};
void (*end_at_once)(int) = nullptr;  // the handler of SIGTERM without a period

extern "C" void end_period(int) { end_at_once(SIGTERM); }

extern "C" void begin_period(int) {
  if (begun != 0) return end_at_once(SIGTERM);
  begun = 1;
  ::setitimer(ITIMER_REAL, &period, nullptr);
}

}  // namespace

GracePeriod::GracePeriod(double seconds) {
  begun = 0;
  if (seconds <= 0) return;
  const double whole = std::floor(seconds);
  period.it_value = {static_cast<time_t>(whole), static_cast<suseconds_t>((seconds - whole) * 1e6)};
  if (period.it_value.tv_sec == 0 && period.it_value.tv_usec == 0) period.it_value.tv_usec = 1;
  struct sigaction before {};
  if (::sigaction(SIGTERM, nullptr, &before) != 0 || before.sa_handler == SIG_IGN || before.sa_handler == SIG_DFL)
    return;
  end_at_once = before.sa_handler;
  std::signal(SIGALRM, end_period);
  std::signal(SIGTERM, begin_period);
  is_set_ = true;
}

GracePeriod::~GracePeriod() {
  if (!is_set_) return;
  std::signal(SIGTERM, end_at_once);
  const itimerval none{};
  ::setitimer(ITIMER_REAL, &none, nullptr);
  std::signal(SIGALRM, SIG_DFL);
}

bool GracePeriod::has_begun() { return begun != 0; }

}  // namespace zoneplate
