// SPDX-License-Identifier: Apache-2.0
// zoneplate sdf: signed distance fields. A table of subcommands, each in a file of its own.
#include "zoneplate/cli/sdf/sdf.h"

#include <vector>

#include "zoneplate/cli/log.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

constexpr Verb subcommands[] = {
    {"draw", "draw a scene of shapes, antialiased from their distances", run_sdf_draw},
    {"field", "show or store the distances of a scene: colours, isolines, gradients, numbers", run_sdf_field},
    {"from-mask", "make the exact distance field of an image's bright pixels", run_sdf_from_mask},
    {"to-mask", "draw a stored field, at any size", run_sdf_to_mask},
    {"text", "draw text from single- or multi-channel fields, with its error", run_sdf_text},
    {"atlas", "make an atlas of a font's glyphs, with metrics as msdf-atlas-gen writes them", run_sdf_atlas}};

std::string overview() {
  return "Usage: zoneplate sdf SUBCOMMAND ARGUMENTS\n"
         "\n"
         "Signed distance fields: the distance of each point from the boundary of a shape, negative inside.\n"
         "\n" +
         lines_of(subcommands, 11) +
         "\n"
         "Examples:\n"
         "  zoneplate sdf draw badge.sdf -o badge.png\n"
         "  zoneplate sdf field badge.sdf --show isolines -o field.png\n"
         "  zoneplate sdf text \"Zone plate\" --sizes 16,32,64,128,256\n"
         "\n"
         "More: zoneplate sdf SUBCOMMAND -h (short), zoneplate sdf SUBCOMMAND --help (everything)\n";
}

}  // namespace

std::span<const Verb> sdf_verbs() { return subcommands; }

void run_sdf(std::span<const std::string> arguments) {
  if (arguments.empty() || arguments[0] == "-h" || arguments[0] == "--help") return print(overview());
  std::vector<std::string_view> names;
  for (const Verb& s : subcommands) names.push_back(s.name);
  subcommands[parse_choice(arguments[0], names)].run(arguments.subspan(1));
}

}  // namespace zoneplate::cli
