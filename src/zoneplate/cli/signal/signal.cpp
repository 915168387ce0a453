// SPDX-License-Identifier: Apache-2.0
// zoneplate signal: spectra, filters and sampling. The table of subcommands, each of which has its own file.
#include "zoneplate/cli/signal/signal.h"

#include <vector>

#include "zoneplate/cli/log.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

constexpr Verb subcommands[] = {
    {"spectrum", "spectrum of an image: magnitude, phase, radial profile", run_signal_spectrum},
    {"filter", "low-pass, high-pass, band-pass or band-stop filter of an image", run_signal_filter},
    {"convolve", "convolution of an image or a list of numbers, in space, by the spectra, or both",
     run_signal_convolve},
    {"resample", "resampling of an image to another size, with any kernel", run_signal_resample},
    {"decimate", "downsampling with and without a low-pass filter: the cause of moire", run_signal_decimate},
    {"series", "Fourier series of a square, triangle or sawtooth wave", run_signal_series},
    {"sample", "aliases of a sampled sine wave, and the replicas of a sampled spectrum", run_signal_sample},
    {"box", "box filters and their spectra: wider in space, narrower in frequency", run_signal_box}};

std::string overview() {
  return "Usage: zoneplate signal SUBCOMMAND ARGUMENTS\n"
         "\n"
         "Spectra, filters and sampling, on image files or on generated test patterns.\n"
         "\n" +
         lines_of(subcommands, 10) +
         "\n"
         "Examples:\n"
         "  zoneplate signal spectrum zone-plate --side-by-side -o spectrum.png\n"
         "  zoneplate signal filter photo.jpg --low-pass 0.1 --shape butterworth:order=4 -o soft.png\n"
         "  zoneplate signal decimate bricks --by 4 -o moire.png\n"
         "  zoneplate signal series square --terms 1,3,5,15 -o series.svg\n"
         "\n"
         "More: zoneplate signal SUBCOMMAND -h (short), zoneplate signal SUBCOMMAND --help (everything)\n";
}

}  // namespace

std::span<const Verb> signal_verbs() { return subcommands; }

void run_signal(std::span<const std::string> arguments) {
  if (arguments.empty() || arguments[0] == "-h" || arguments[0] == "--help") return print(overview());
  std::vector<std::string_view> names;
  for (const Verb& s : subcommands) names.push_back(s.name);
  subcommands[parse_choice(arguments[0], names)].run(arguments.subspan(1));
}

}  // namespace zoneplate::cli
