// zoneplate signal: the signal laboratory. A table of subcommands, each in a file of its own.
#include "zoneplate/cli/signal/signal.h"

#include <vector>

#include "zoneplate/cli/log.h"
#include "zoneplate/cli/values.h"
#include "zoneplate/cli/verbs.h"

namespace zoneplate::cli {
namespace {

constexpr Verb subcommands[] = {
    {"spectrum", "which frequencies an image holds: magnitude, phase, radial profile", run_signal_spectrum},
    {"filter", "an image without the low, the high or a band of its frequencies", run_signal_filter},
    {"convolve", "an image or a list of numbers with a kernel, in space, by its spectrum, or both",
     run_signal_convolve},
    {"resample", "an image on another grid, larger or smaller, with any kernel", run_signal_resample},
    {"decimate", "every n-th pixel beside filtering first: where moire comes from", run_signal_decimate},
    {"series", "a square, triangle or sawtooth wave built up from its harmonics", run_signal_series},
    {"sample", "two waves with the same samples, and the copies of a sampled spectrum", run_signal_sample},
    {"box", "boxes and their spectra: wider in space, narrower in frequency", run_signal_box}};

std::string overview() {
  return "Usage: zoneplate signal SUBCOMMAND ARGUMENTS\n"
         "\n"
         "The signal laboratory: spectra, filters and sampling, on pictures of yours or on patterns made in code.\n"
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

void run_signal(std::span<const std::string> arguments) {
  if (arguments.empty() || arguments[0] == "-h" || arguments[0] == "--help") return print(overview());
  std::vector<std::string_view> names;
  for (const Verb& s : subcommands) names.push_back(s.name);
  subcommands[parse_choice(arguments[0], names)].run(arguments.subspan(1));
}

}  // namespace zoneplate::cli
