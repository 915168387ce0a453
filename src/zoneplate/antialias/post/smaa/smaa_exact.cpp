// SPDX-License-Identifier: Apache-2.0
// SMAA with exact areas: each edge's line is displaced by the offset of the samples in which the edge was detected, and
// the area under it is computed instead of being read from tables.
//
// SMAA's tables have seven positions of samples, across the edge only, and are interpolated between the squares of
// whole distances. For samples off the pixel's centre they also mix each step with two half steps, so that S2x, T2x and
// 4x gain less than their samples are worth. Here a line is displaced along its edge as well as across it, by any
// offset and at any distance. Weaknesses: those of SMAA: one image of samples leaves a line's position within its steps
// open, and details thinner than a pixel stay broken; a wire's displaced edges spread it over two pixels.
//
// Source: the passes, searches, patterns and samples of Jimenez, Echevarria, Sousa, Gutierrez, SMAA, Eurographics 2012,
// code v2.8; the areas are this project's.
#include "zoneplate/antialias/post/smaa/smaa.h"

namespace zoneplate::antialias {
namespace {

constexpr std::string_view exact_variants[] = {"mode=s2x", "mode=t2x", "mode=4x"};

}  // namespace

Method smaa();

Method smaa_exact() {
  return {.name = "smaa-exact",
          .summary = "SMAA with areas in closed form for the position of each sample, in place of its tables",
          .source = "Jimenez 2012; the areas are our own",
          .params = smaa().params,
          .make = [](const Settings& s) { return make_smaa(s, SmaaAreas::Exact, "smaa-exact"); },
          .variants = exact_variants};
}

}  // namespace zoneplate::antialias
