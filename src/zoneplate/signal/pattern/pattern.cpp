// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/signal/pattern/pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "zoneplate/base/parallel.h"
#include "zoneplate/math/lanes.h"
#include "zoneplate/math/random.h"
#include "zoneplate/signal/filter/aliasing.h"
#include "zoneplate/signal/functions.h"
#include "zoneplate/signal/pattern/gradient_noise.h"

namespace zoneplate {
namespace {

using Params = std::span<const double>;

const Param size_param = real_param("size", "pixels on each side", 512, 2, 8192);

Linear grey(double value) {
  const float v = static_cast<float>(value);
  return {v, v, v, 1};
}

int size_of(Params p) { return static_cast<int>(p[0]); }

// An image with color_at(x, y) at each pixel, x and y in pixels from the top-left pixel.
template <class ColorAt>
LinearImage filled(Params p, const ColorAt& color_at) {
  LinearImage image(size_of(p), size_of(p));
  parallel_for(static_cast<std::size_t>(image.height()), [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < image.width(); ++x) image(x, y) = color_at(x, y);
  });
  return image;
}

LinearImage make_zone_plate(Params p) {
  const Plane<float> plate = zone_plate(size_of(p));
  return filled(p, [&](int x, int y) { return grey(static_cast<double>(plate(x, y))); });
}

// The wave of frequency x / (2 size) has the angle π x² / (2 size), which is reduced in integers: x is (2 i + 1) / 2.
LinearImage make_sweep(Params p) {
  const auto period = 16 * static_cast<std::uint64_t>(size_of(p));
  return filled(p, [&](int x, int) {
    const auto odd = static_cast<std::uint64_t>(2 * x + 1);
    return grey(0.5 + 0.5 * unit_root(odd * odd % period, period).cosine);
  });
}

LinearImage make_sine(Params p) {
  const SineCosine along = sin_cos_pi(p[2] / 180);
  const double fx = p[1] * along.cosine, fy = p[1] * along.sine;
  return filled(p, [&](int x, int y) { return grey(0.5 + 0.5 * cos_pi(2 * (fx * x + fy * y))); });
}

LinearImage make_checkerboard(Params p) {
  const double cell = p[1];
  return filled(p, [&](int x, int y) {
    const double column = std::floor((x + 0.5) / cell), row = std::floor((y + 0.5) / cell);
    return grey(std::fmod(column + row, 2) == 0 ? 0.8 : 0.05);
  });
}

// Running bond: every second course is offset by half a brick, and each brick has its own shade.
LinearImage make_bricks(Params p) {
  const double height = p[1], width = 2 * height, joint = p[2];
  return filled(p, [&](int x, int y) {
    const double course = std::floor((y + 0.5) / height);
    const double along = (x + 0.5) / width + (std::fmod(course, 2) == 0 ? 0 : 0.5), brick = std::floor(along);
    const bool is_joint = y + 0.5 - course * height < joint || (along - brick) * width < joint;
    if (is_joint) return Linear{0.62f, 0.58f, 0.5f, 1};
    const std::uint32_t place = static_cast<std::uint32_t>(course) * 4096 + static_cast<std::uint32_t>(brick);
    const float shade = 0.7f + 0.6f * unit_float(hash(place));
    return Linear{0.36f * shade, 0.09f * shade, 0.05f * shade, 1};
  });
}

LinearImage make_star(Params p) {
  const double centre = size_of(p) / 2.0, spokes = std::floor(p[1]);
  return filled(p, [&](int x, int y) {
    const double turns = angle_of(y + 0.5 - centre, x + 0.5 - centre) / (2 * std::numbers::pi);
    return grey(0.5 + 0.5 * cos_pi(2 * spokes * turns));
  });
}

LinearImage make_edge(Params p) {
  const double centre = size_of(p) / 2.0;
  const SineCosine along = sin_cos_pi(p[1] / 180);
  return filled(p, [&](int x, int y) {
    return grey((x + 0.5 - centre) * along.cosine + (y + 0.5 - centre) * along.sine < 0 ? 0.05 : 0.8);
  });
}

LinearImage make_impulse(Params p) {
  const int middle = size_of(p) / 2;
  return filled(p, [&](int x, int y) { return grey(x == middle && y == middle ? 1 : 0); });
}

LinearImage make_perlin(Params p) {
  using F = scalar::Float;
  const float step = 1 / static_cast<float>(p[1]), slice = static_cast<float>(p[4]);
  const Octaves octaves{static_cast<int>(p[2]), static_cast<float>(p[3])};
  return filled(p, [&](int x, int y) {
    const Vector<F> at{F((static_cast<float>(x) + 0.5f) * step), F((static_cast<float>(y) + 0.5f) * step), F(slice)};
    return grey(0.5 + 0.5 * static_cast<double>(fractal_noise<F>(at, F(0.0f), octaves, false).value.v));
  });
}

LinearImage make_noise(Params p) {
  const auto seed = static_cast<std::uint32_t>(p[1]), width = static_cast<std::uint32_t>(p[0]);
  return filled(p, [&](int x, int y) {
    const std::uint32_t place = static_cast<std::uint32_t>(y) * width + static_cast<std::uint32_t>(x);
    return grey(static_cast<double>(unit_float(hash(place ^ hash(seed)))));
  });
}

}  // namespace

std::span<const PatternEntry> patterns() {
  static const std::vector<PatternEntry> table = {
      {"zone-plate", "rings, from frequency 0 in the middle to Nyquist's at the edges", {size_param}, make_zone_plate},
      {"sweep", "bars, from frequency 0 at the left to Nyquist's at the right", {size_param}, make_sweep},
      {"sine",
       "one wave",
       {size_param, real_param("frequency", "cycles per pixel", 0.1, 0, 4),
        real_param("angle", "of its direction", 0, -360, 360)},
       make_sine},
      {"checkerboard",
       "light and dark squares",
       {size_param, real_param("cell", "side of a square", 16, 0.1, 8192)},
       make_checkerboard},
      {"bricks",
       "a wall, in colour",
       {size_param, real_param("height", "of a course", 11, 2, 8192),
        real_param("joint", "of mortar, width", 1.6, 0, 100)},
       make_bricks},
      {"star",
       "spokes that meet (Siemens star)",
       {size_param, real_param("spokes", "their number", 48, 1, 4096)},
       make_star},
      {"edge",
       "dark and light side by side",
       {size_param, real_param("angle", "of its normal", 5, -360, 360)},
       make_edge},
      {"impulse", "one white pixel in the middle", {size_param}, make_impulse},
      {"perlin",
       "a fractal sum of Perlin noise, as 0.5 + 0.5 sum",
       {size_param,
        real_param("cell", "side of a lattice cell, pixels", 32, 1, 8192),
        {"octaves", "each with twice the frequency", 1, 1, 12},
        real_param("gain", "amplitude of an octave over the octave before", 0.5, 0, 1),
        real_param("slice", "third coordinate, in cells", 0.5, -1e6, 1e6)},
       make_perlin},
      {"noise",
       "every pixel on its own, evenly from 0 to 1",
       {size_param, real_param("seed", "random seed", 1, 0, 4294967295.0)},
       make_noise},
  };
  return table;
}

bool is_pattern(std::string_view text) { return find_row(patterns(), text) != nullptr; }

LinearImage make_pattern(std::string_view text) {
  const auto spec = parse_spec("pattern", patterns(), text);
  return spec.row.make(spec.settings.numbers());
}

}  // namespace zoneplate
