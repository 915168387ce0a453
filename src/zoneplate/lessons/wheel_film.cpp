// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/lessons/wheel_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "zoneplate/base/parallel.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/math/transform.h"
#include "zoneplate/signal/functions.h"

namespace zoneplate::lessons {
namespace {

constexpr int places = 128;  // angles of a profile
constexpr float3 axle{0, 0.5f, 0};
constexpr float inner = 0.20f, outer = 0.38f;  // radii between hub and rim
constexpr int rings = 10;

int wrapped(int step, int steps) { return ((step % steps) + steps) % steps; }

float bilinear(const Plane<float>& plane, float x, float y) {
  const int x0 = std::clamp(static_cast<int>(std::floor(x)), 0, plane.width() - 2);
  const int y0 = std::clamp(static_cast<int>(std::floor(y)), 0, plane.height() - 2);
  const float u = x - static_cast<float>(x0), v = y - static_cast<float>(y0);
  const float top = plane(x0, y0) + (plane(x0 + 1, y0) - plane(x0, y0)) * u;
  const float low = plane(x0, y0 + 1) + (plane(x0 + 1, y0 + 1) - plane(x0, y0 + 1)) * u;
  return top + (low - top) * v;
}

}  // namespace

const LinearImage& WheelFilm::at(int step) const { return instants[static_cast<std::size_t>(wrapped(step, steps))]; }

WheelFilm film_wheel(int spokes, int steps, int side) {
  WheelFilm film{.spokes = spokes, .steps = steps};
  for (int step = 0; step < steps; ++step) {
    const double turn = static_cast<double>(step) / steps;
    const Scene scene = scene_of(fmt::format("wheel:spokes={},turn={:.6f}", spokes, turn));
    film.camera = camera_of(scene, side, side);
    film.instants.push_back(shoot(scene, "msaa:n=8", side, side));
  }
  return film;
}

LinearImage exposed(const WheelFilm& film, int first, int count) {
  LinearImage sum(film.at(0).width(), film.at(0).height(), {0, 0, 0, 0});
  const float share = 1 / static_cast<float>(count);
  parallel_ranges(static_cast<std::size_t>(sum.height()), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int i = 0; i < count; ++i) {
        const auto from = film.at(first + i).row(y);
        for (std::size_t x = 0; x < from.size(); ++x) sum.row(y)[x] = sum.row(y)[x] + from[x];
      }
      for (Linear& c : sum.row(y)) c = c * share;
    }
  });
  return sum;
}

std::vector<double> spoke_profile(const WheelFilm& film, const LinearImage& picture) {
  const Plane<float> light = luminance_of(picture);
  const auto w = static_cast<float>(light.width()), h = static_cast<float>(light.height());
  const float4x4 clip_from_world = film.camera.clip_from_camera(w / h) * inverse(film.camera.world_from_camera);
  std::vector<double> profile(places, 0.0);
  const auto around = static_cast<std::uint64_t>(places * film.spokes);
  for (std::uint64_t j = 0; j < around; ++j) {
    const SineCosine direction = unit_root(j, around);
    double sum = 0;
    for (int ring = 0; ring < rings; ++ring) {
      const float r = inner + (outer - inner) * static_cast<float>(ring) / (rings - 1);
      // Clockwise from the right.
      const float3 p = axle + float3{static_cast<float>(direction.cosine), -static_cast<float>(direction.sine), 0} * r;
      const float4 clip = clip_from_world * float4{p.x, p.y, p.z, 1};
      const float x = (clip.x / clip.w + 1) * 0.5f * w - 0.5f, y = (1 - clip.y / clip.w) * 0.5f * h - 0.5f;
      sum += static_cast<double>(bilinear(light, x, y));
    }
    profile[j % places] += sum / (rings * film.spokes);
  }
  return profile;
}

double displacement(const std::vector<double>& a, const std::vector<double>& b) {
  const int n = static_cast<int>(a.size());
  std::vector<double> correlation(a.size());
  for (int d = 0; d < n; ++d)
    for (int i = 0; i < n; ++i)
      correlation[static_cast<std::size_t>(d)] +=
          a[static_cast<std::size_t>(i)] * b[static_cast<std::size_t>((i + d) % n)];
  const auto at = [&](int d) { return correlation[static_cast<std::size_t>(wrapped(d, n))]; };
  const int peak = static_cast<int>(std::max_element(correlation.begin(), correlation.end()) - correlation.begin());

  // Interpolated between angles: the vertex of the parabola through the three highest values.
  const double before = at(peak - 1), top = at(peak), after = at(peak + 1), bend = before - 2 * top + after;
  const double offset = bend < 0 ? 0.5 * (before - after) / bend : 0;
  const double spokes = (peak + offset) / n;
  return spokes > 0.5 ? spokes - 1 : spokes;
}

double fundamental(const std::vector<double>& profile) {
  double re = 0, im = 0;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const SineCosine wave = unit_root(i, profile.size());
    re += profile[i] * wave.cosine, im += profile[i] * wave.sine;
  }
  return 2 * std::sqrt(re * re + im * im) / static_cast<double>(profile.size());
}

}  // namespace zoneplate::lessons
