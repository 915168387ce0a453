// SPDX-License-Identifier: Apache-2.0
// zoneplate texture: what the renderer makes of a texture. A table of subcommands, each in a file of its own.
#include "zoneplate/cli/texture/texture.h"

#include <vector>

#include "zoneplate/cli/log.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

constexpr Verb subcommands[] = {
    {"levels", "mip levels or ripmap of an image as one image, with sizes and memory", run_texture_levels},
    {"normal-from-height", "normal map of a height map, by the Sobel operator or central differences",
     run_texture_normal_from_height}};

std::string overview() {
  return "Usage: zoneplate texture SUBCOMMAND ARGUMENTS\n"
         "\n"
         "Mip levels and normal maps, of image files or of generated test patterns.\n"
         "\n" +
         lines_of(subcommands, 20) +
         "\n"
         "Examples:\n"
         "  zoneplate texture levels photo.jpg -o levels.png\n"
         "  zoneplate texture levels leaf.png --mip-filter kaiser --alpha-cutoff 0.5 -o levels.png\n"
         "  zoneplate texture normal-from-height height.png --strength 4 -o normal.png\n"
         "\n"
         "More: zoneplate texture SUBCOMMAND -h (short), zoneplate texture SUBCOMMAND --help (everything)\n";
}

}  // namespace

std::span<const Verb> texture_verbs() { return subcommands; }

void run_texture(std::span<const std::string> arguments) {
  if (arguments.empty() || arguments[0] == "-h" || arguments[0] == "--help") return print(overview());
  std::vector<std::string_view> names;
  for (const Verb& s : subcommands) names.push_back(s.name);
  subcommands[parse_choice(arguments[0], names)].run(arguments.subspan(1));
}

}  // namespace zoneplate::cli
