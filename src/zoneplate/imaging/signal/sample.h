// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "zoneplate/imaging/signal/result.h"
#include "zoneplate/signal/fourier/series.h"

namespace zoneplate {

struct SampleOptions : SignalOptions {
  double frequency = 0, rate = 0;

  bool is_aliased() const { return frequency > rate / 2; }
  double apparent() const { return apparent_frequency(frequency, rate); }
};

/// Prints the aliases of the wave, and plots them and the replicas of a sampled spectrum if there is an output.
void plot_sampling(const SampleOptions& args, Delivery& out);

}  // namespace zoneplate
