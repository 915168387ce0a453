// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <utility>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/scene/facing_for_test.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate::antialias {

/// Renders a scene with its own camera and resolves it with a method, before tone mapping.
inline LinearImage shot(const Scene& scene, const std::string& method,
                        RenderOptions options = {.width = 160, .height = 120}, RenderCounts* counts = nullptr) {
  Renderer renderer(PreparedScene(scene), make_resolver(methods(), method));
  RenderedImage image = renderer.render(scene.cameras.at(0), {.options = options, .form = ImageForm::Linear});
  if (counts) *counts = image.counts;
  return std::move(image.linear);
}

/// The mean absolute difference of green.
inline double mean_error(const LinearImage& a, const LinearImage& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.values().size(); ++i)
    sum += std::abs(double{a.values()[i].g} - double{b.values()[i].g});
  return sum / static_cast<double>(a.values().size());
}

}  // namespace zoneplate::antialias
