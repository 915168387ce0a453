// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/shade/shadow/shared_visibility.h"

#include <array>
#include <utility>

namespace zoneplate {
namespace {

void copy_entry(const Receivers& from, int i, Receivers& to, int k) {
  const auto copy = [&](const float(&source)[3][Receivers::capacity], float(&target)[3][Receivers::capacity]) {
    for (int c = 0; c < 3; ++c) target[c][k] = source[c][i];
  };
  copy(from.position, to.position), copy(from.face, to.face), copy(from.normal, to.normal);
  copy(from.dx, to.dx), copy(from.dy, to.dy);
  to.margin[k] = from.margin[i], to.seed[k] = from.seed[i], to.surface[k] = from.surface[i];
  to.x[k] = from.x[i], to.y[k] = from.y[i];
}

/// How often the rays of a pixel are halved in a grid of this step. A fragment takes the mean of at least five pixels
/// of the grid of all pixels, which have the error of one by itself: by a quarter of its rays each it would be greater.
constexpr std::uint8_t halvings_of_grid(int step) { return step == 1 ? 1 : 0; }

/// How often the rays of a fragment are halved that covers this part of a pixel.
std::uint8_t halvings_of(float coverage) {
  std::uint8_t n = 0;
  for (; coverage <= 0.5f && n < 31; coverage *= 2) ++n;
  return n;
}

}  // namespace

SharedVisibility::SharedVisibility(const TracedVisibility& rays, int lights, const ShadowOptions& shadows,
                                   const OcclusionOptions& occlusion, Image image)
    : rays_(rays), image_(std::move(image)) {
  if (shadows.method == ShadowMethod::Soft && shadows.spacing > 1)
    for (int k = 0; k < lights; ++k) lights_.push_back(make_query(shadows.spacing, shadows.samples));
  if (occlusion.samples > 0) environment_ = make_query(occlusion.spacing, occlusion.samples);
}

SharedVisibility::Query SharedVisibility::make_query(int spacing, int samples) const {
  Query query;
  // Fewer rays cost less than what is interpolated: 4 of eight lights took 0.23 s by themselves, and 0.89 s shared.
  constexpr int fewest = 16;
  if (samples < fewest || spacing == 1) return query;
  const auto add = [&](int step) {
    const int rays = Receivers::halved(samples, halvings_of_grid(step));
    for (Grids* const grids : {&query.surfaces, &query.ground})
      grids->push_back(std::make_unique<VisibilityGrid>(step, image_.width, image_.height, rays));
  };
  for (int step = spacing; step > 2; step /= 2) add(step);
  add(1);
  return query;
}

void SharedVisibility::of_light(int k, const Receivers& receivers, float* visible) const {
  if (lights_.empty() || receivers.is_transmissive) return rays_.of_light(k, receivers, visible);
  share(lights_[static_cast<std::size_t>(k)], receivers,
        {[&](const Receivers& some, float* out) { rays_.of_light(k, some, out); },
         [&](const Receivers& some, int i) { return rays_.is_lit(k, some, i); }},
        visible);
}

void SharedVisibility::of_environment(const Receivers& receivers, float* visible) const {
  share(environment_, receivers,
        {[&](const Receivers& some, float* out) { rays_.of_environment(some, out); },
         [](const Receivers&, int) { return true; }},
        visible);
}

/// `times`: how often each pixel's number of rays is halved.
void SharedVisibility::evaluate(bool is_ground, std::uint8_t times, std::span<const PixelPosition> pixels,
                                const Rays& rays, VisibilityGrid::Value* values) const {
  Receivers seen, lit;
  std::array<std::uint8_t, Receivers::capacity> halvings;
  halvings.fill(times);
  lit.halvings = halvings.data();
  std::array<bool, FragmentBatch::capacity> found{};
  (is_ground ? image_.ground : image_.surfaces)(pixels, seen, {found.data(), pixels.size()});
  std::array<std::size_t, FragmentBatch::capacity> from;
  for (std::size_t k = 0; k < pixels.size(); ++k) {
    const int i = static_cast<int>(k);
    values[k] = {};
    if (!found[k]) continue;
    values[k] = {{seen.position[0][k], seen.position[1][k], seen.position[2][k]},
                 {seen.normal[0][k], seen.normal[1][k], seen.normal[2][k]},
                 bend_of(seen, i),
                 VisibilityGrid::Value::unlit,
                 seen.surface[k]};
    if (!rays.is_lit(seen, i)) continue;
    from[static_cast<std::size_t>(lit.count)] = k;
    copy_entry(seen, i, lit, lit.count++);
  }
  if (lit.count == 0) return;
  float visible[Receivers::capacity];
  rays.trace(lit, visible);
  for (int i = 0; i < lit.count; ++i) values[from[static_cast<std::size_t>(i)]].visible = visible[i];
}

void SharedVisibility::share(const Query& query, const Receivers& receivers, const Rays& rays, float* visible) const {
  const Grids& grids = receivers.is_ground ? query.ground : query.surfaces;
  if (grids.empty()) return rays.trace(receivers, visible);
  std::array<int, Receivers::capacity> open;
  std::size_t count = 0;
  for (int i = 0; i < receivers.count; ++i) {
    visible[i] = 0;
    if (rays.is_lit(receivers, i)) open[count++] = i;
  }
  for (const auto& grid : grids) {
    const auto evaluated = [&](std::span<const PixelPosition> pixels, VisibilityGrid::Value* values) {
      evaluate(receivers.is_ground, halvings_of_grid(grid->step()), pixels, rays, values);
    };
    float found[Receivers::capacity];
    grid->interpolate(receivers, {open.data(), count}, evaluated, found);
    std::size_t left = 0;
    for (std::size_t k = 0; k < count; ++k) {
      if (found[k] == VisibilityGrid::Value::nothing)
        open[left++] = open[k];
      else
        visible[open[k]] = found[k];
    }
    count = left;
  }

  if (count == 0) return;
  Receivers rest;
  std::array<std::uint8_t, Receivers::capacity> halvings;
  rest.halvings = halvings.data();
  for (std::size_t k = 0; k < count; ++k) {
    copy_entry(receivers, open[k], rest, rest.count++);
    halvings[k] = halvings_of(receivers.coverage[open[k]]);
  }
  float own[Receivers::capacity];
  rays.trace(rest, own);
  for (std::size_t k = 0; k < count; ++k) visible[open[k]] = own[k];
}

}  // namespace zoneplate
