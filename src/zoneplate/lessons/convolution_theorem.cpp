// SPDX-License-Identifier: Apache-2.0
// The convolution theorem: convolution of images equals multiplication of their spectra.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "zoneplate/lessons/demo.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/signal/filter/convolve.h"

namespace zoneplate::lessons {
namespace convolution_theorem_lesson {
namespace {

constexpr Param params[] = {
    {.name = "radius", .meaning = "of the disk, for panels of 360 pixels", .value = 10, .low = 1, .high = 40}};
constexpr double range_db = 130;  // dynamic range of the displayed spectra

/// A disk, the blur of an out-of-focus lens, antialiased with 16 × 16 points per pixel; the sum is 1.
Plane<float> disk(int radius) {
  constexpr int points = 16;
  const int n = 2 * radius + 3;
  Plane<float> plane(n, n);
  std::int64_t all = 0;
  const auto inside = [&](int x, int y) {
    std::int64_t count = 0;
    for (int j = 0; j < points; ++j)
      for (int i = 0; i < points; ++i) {
        const std::int64_t dx = 2 * (points * (x - n / 2) + i) + 1 - points,
                           dy = 2 * (points * (y - n / 2) + j) + 1 - points;
        const std::int64_t reach = 2 * points * radius;
        count += dx * dx + dy * dy <= reach * reach;
      }
    return count;
  };
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const std::int64_t count = inside(x, y);
      all += count;
      plane(x, y) = static_cast<float>(count);
    }
  for (float& v : plane.values()) v /= static_cast<float>(all);
  return plane;
}

double greatest(const Plane<float>& a, const Plane<float>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i)
    most = std::max(most, std::abs(static_cast<double>(a.values()[i]) - static_cast<double>(b.values()[i])));
  return most;
}

/// The kernel in the middle of an otherwise empty image of this size.
Plane<float> placed(const Plane<float>& kernel, int side) {
  Plane<float> plane(side, side);
  for (int y = 0; y < kernel.height(); ++y)
    for (int x = 0; x < kernel.width(); ++x)
      plane((side - kernel.width()) / 2 + x, (side - kernel.height()) / 2 + y) = kernel(x, y);
  return plane;
}

std::string small(double value) {
  return value == 0 ? "0" : value >= 0.001 ? number(value, 3) : fmt::format("{:.0e}", value);
}

Table border_table(const Plane<float>& picture, const Plane<float>& kernel) {
  Table table{{"border", "applied directly", "border padded first"}, {}};
  const Plane<float> product = convolve_by_fourier(picture, kernel, Border::Wrap);
  for (const Border border : {Border::Wrap, Border::Zero, Border::Clamp, Border::Reflect}) {
    const Plane<float> space = convolve(picture, kernel, {.border = border});
    table.rows.push_back({name_of(border), small(greatest(space, product)),
                          small(greatest(space, convolve_by_fourier(picture, kernel, border)))});
  }
  return table;
}

Spectrum product(Spectrum a, const Spectrum& b) {
  for (std::size_t i = 0; i < a.half.values().size(); ++i) a.half.values()[i] *= b.half.values()[i];
  return a;
}

/// Scales a plane so that its greatest value is white.
Plane<float> brightened(Plane<float> plane) {
  const float peak = *std::max_element(plane.values().begin(), plane.values().end());
  for (float& v : plane.values()) v /= peak;
  return plane;
}

/// A phrase for the difference of both results.
std::string agreement(double most) { return most == 0 ? "the same bits" : "the greatest difference is " + small(most); }

Lesson make(const DemoSize& size, const Settings& settings) {
  const int side = size.panel, radius = (settings.integer("radius") - 1) * side / 360 + 1;
  const Plane<float> picture = luminance_of(shoot(scene_of("city"), "msaa:n=8", side, side));
  const Plane<float> kernel = disk(radius), lens = placed(kernel, side);
  const Plane<float> space = convolve(picture, kernel, {.border = Border::Wrap});
  const Plane<float> back = convolve_by_fourier(picture, kernel, Border::Wrap);
  const Spectrum spectrum = fourier(picture), lens_spectrum = fourier(lens);
  const Table table = border_table(picture, kernel);

  const auto sign = [&](const char* text) { return Panel{sign_picture(text, side, size.style()), ""}; };
  const auto drawn = [](const Spectrum& s) { return spectrum_picture(s, range_db); };
  Figure figure{.title = "The convolution theorem: convolution of images is multiplication of spectra"};
  figure.rows = {
      {{shown(picture), "An image\nIts edges are sharp."},
       sign("∗"),
       {shown(brightened(lens)),
        fmt::format("A kernel\nA disk of {} pixels, the image of a point by a lens out of focus.", 2 * radius)},
       sign("="),
       {shown(space), "Convolution\nEvery point of the image becomes a disk; the disks add up."}},
      {{drawn(spectrum), "Its spectrum\nEdges are streaks towards high frequencies; frequency 0 is in the centre."},
       sign("×"),
       {drawn(lens_spectrum), "Its spectrum\nRings of zeros: the frequencies that a disk removes."},
       sign("="),
       {drawn(product(spectrum, lens_spectrum)),
        fmt::format("The product\nIts inverse transform is the image above: {}.", agreement(greatest(space, back)))}},
      {{table_picture(table, size.style(), 2 * side), ""}}};
  figure.text =
      "Greatest difference between convolution in space and multiplication of spectra, white being 1. The theorem "
      "describes periodic images: applied directly, it holds for borders that wrap around. For other borders the image "
      "must be padded first, and the padding cropped afterwards.";
  return {.frames = {figure}, .tables = {table}};
}

}  // namespace
}  // namespace convolution_theorem_lesson

Demo demo_convolution_theorem() {
  return {"convolution-theorem", "a blur by convolution in space and by multiplication of spectra",
          convolution_theorem_lesson::make, convolution_theorem_lesson::params};
}

}  // namespace zoneplate::lessons
