// SPDX-License-Identifier: Apache-2.0
// What bench/peers/run-filters asks of Zoneplate: draw a scene, filter it and tell the times, compare the result with
// another program's. Pictures are files of bare RGBA codes, rows from the top.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "../scene_codes.h"
#include "zoneplate/antialias/post/fxaa/fxaa.h"
#include "zoneplate/antialias/post/smaa/smaa.h"
#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/os/file.h"

namespace zoneplate::peers {
namespace {

using antialias::apply_fxaa;
using antialias::apply_smaa;

Rgba8Image load_codes(const std::string& path, int width, int height) {
  const FileBytes file(path);
  Rgba8Image image(width, height);
  if (file.bytes().size() != image.values().size_bytes())
    throw Error(ErrorKind::Input,
                fmt::format("{}: {} bytes, expected {}", path, file.bytes().size(), image.values().size_bytes()));
  std::memcpy(image.values().data(), file.bytes().data(), file.bytes().size());
  return image;
}

void draw(const std::string& name, int width, int height, const std::string& path) {
  const Rgba8Image image = scene_codes(name, width, height);
  save_bytes(path,
             std::span(reinterpret_cast<const std::uint8_t*>(image.values().data()), image.values().size_bytes()));
}

/// As it is used: SMAA mixes light, FXAA codes, with luma as the other program has it.
Rgba8Image filtered(const std::string& method, const Rgba8Image& image, Rgba8Image memory) {
  if (method == "fxaa") return apply_fxaa(image, {.preset = 12, .is_green_luma = true}, std::move(memory));
  if (method == "smaa") return apply_smaa(image, nullptr, {}, std::move(memory));
  throw Error(ErrorKind::Usage, "method " + method + " is unknown: fxaa, smaa");
}

/// As the other program does it: SMAA mixes codes, with its tables and its distances of corners.
Rgba8Image filtered_alike(const std::string& method, const Rgba8Image& image) {
  if (method == "smaa") return apply_smaa(image, nullptr, {.mixes_light = false, .is_postprocessing = true});
  return filtered(method, image, {});
}

void time(const std::string& method, const Rgba8Image& image, int frames) {
  Rgba8Image out = filtered(method, image, {});
  std::string ms;
  const std::clock_t start = std::clock();
  for (int i = 0; i < frames; ++i) {
    const Stopwatch watch;
    out = filtered(method, image, std::move(out));
    ms += fmt::format("{}{:.3f}", i > 0 ? ", " : "", watch.ms());
  }
  const double processor_ms = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  fmt::print("{{\"ms\": [{}], \"processor_ms\": {:.1f}}}\n", ms, processor_ms);
}

bool differ(Rgba8 a, Rgba8 b, int by) {
  return std::abs(a.r - b.r) > by || std::abs(a.g - b.g) > by || std::abs(a.b - b.b) > by;
}

/// How many percent of the pixels each program changed, and at how many the two differ by more than one code.
void distance(const std::string& method, const Rgba8Image& image, const Rgba8Image& theirs, const std::string& name) {
  const Rgba8Image ours = filtered_alike(method, image);
  std::size_t changed_here = 0, changed_there = 0, differing = 0;
  for (std::size_t i = 0; i < image.values().size(); ++i) {
    changed_here += differ(image.values()[i], ours.values()[i], 0);
    changed_there += differ(image.values()[i], theirs.values()[i], 0);
    differing += differ(ours.values()[i], theirs.values()[i], 1);
  }
  const auto percent = [&](std::size_t n) {
    return 100.0 * static_cast<double>(n) / static_cast<double>(image.values().size());
  };
  fmt::print("{{\"changed_percent\": {:.4f}, \"theirs_percent\": {:.4f}, \"differing_percent\": {:.4f}}}\n",
             percent(changed_here), percent(changed_there), percent(differing));
  if (name.empty()) return;
  save_bytes(name + "-theirs.png", encode_png(theirs, {.has_alpha = false}));
  save_bytes(name + "-zoneplate.png", encode_png(ours, {.has_alpha = false}));
}

int run(const std::vector<std::string>& args) {
  const auto number = [&](std::size_t i) { return std::atoi(args[i].c_str()); };
  const std::string verb = args.empty() ? "" : args[0];
  if (verb == "draw" && args.size() == 5) {
    draw(args[1], number(2), number(3), args[4]);
  } else if (verb == "time" && args.size() == 6) {
    time(args[1], load_codes(args[4], number(2), number(3)), number(5));
  } else if (verb == "distance" && args.size() == 7) {
    distance(args[1], load_codes(args[4], number(2), number(3)), load_codes(args[5], number(2), number(3)), args[6]);
  } else {
    std::fputs(
        "usage: peer_filters draw SCENE WIDTH HEIGHT FILE | time METHOD WIDTH HEIGHT FILE FRAMES |\n"
        "       distance METHOD WIDTH HEIGHT FILE THEIRS PNG-NAME\n",
        stderr);
    return 2;
  }
  return 0;
}

}  // namespace
}  // namespace zoneplate::peers

int main(int argc, char** argv) {
  try {
    return zoneplate::peers::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "peer_filters: %s\n", error.what());
    return 1;
  }
}
