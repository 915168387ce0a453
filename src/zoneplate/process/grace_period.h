// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace zoneplate {

/// While it lives, the first SIGTERM does not end the program but begins a period of grace, in which the work at hand
/// can be finished. The program ends as without it, with exit code 143, when the period is over or SIGTERM arrives
/// again.
///
/// Requires  at most one at a time; nothing else uses SIGALRM. An ignored SIGTERM stays ignored.
class GracePeriod {
 public:
  /// 0 seconds: SIGTERM ends the program at once, as without this object.
  explicit GracePeriod(double seconds);
  ~GracePeriod();
  GracePeriod(const GracePeriod&) = delete;
  GracePeriod& operator=(const GracePeriod&) = delete;

  /// Whether SIGTERM has arrived.
  static bool has_begun();

 private:
  bool is_set_ = false;
};

}  // namespace zoneplate
