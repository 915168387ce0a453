// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace zoneplate::cli {

// The subcommands of `zoneplate signal`. Each takes the arguments after its name, as a verb does.

void run_signal_spectrum(std::span<const std::string> arguments);
void run_signal_filter(std::span<const std::string> arguments);
void run_signal_convolve(std::span<const std::string> arguments);
void run_signal_resample(std::span<const std::string> arguments);
void run_signal_decimate(std::span<const std::string> arguments);
void run_signal_series(std::span<const std::string> arguments);
void run_signal_sample(std::span<const std::string> arguments);
void run_signal_box(std::span<const std::string> arguments);

}  // namespace zoneplate::cli
