// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/resolve.h"

#include <fmt/format.h>

#include <utility>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/image/auto_exposure.h"
#include "zoneplate/render/metering/metering.h"
#include "zoneplate/scene/default_options.h"

namespace zoneplate {
namespace {

bool is_builtin(const Job& job) { return job.load.format.empty() && is_builtin_scene(job.input); }

/// "#333333", the default background of F3D; the scene "triangles" is defined on black.
float4 background_of(const Job& job) {
  if (job.background) return *job.background;
  if (job.quality_background) return *job.quality_background;
  return job.input == "triangles" && is_builtin(job) ? float4{0, 0, 0, 1} : default_background;
}

/// Whether a view that is not chosen is that of the scene's first camera.
bool has_own_view(const Job& job, const Scene& scene) {
  const SequenceArgs& sequence = job.sequence;
  const bool moves_camera = sequence.turntable || !sequence.views.empty() || sequence.camera_path;
  return is_builtin(job) && !scene.cameras.empty() && (!moves_camera || !scene.animations.empty());
}

}  // namespace

Job resolve(Job job, const Scene& scene, ToneMapping of_light) {
  RenderOptions& options = job.options;
  options.point_size = job.point_size.value_or(default_point_size(scene, options.width, options.height));
  options.anisotropy = job.anisotropy.value_or(is_builtin(job) ? 1 : default_anisotropy);
  job.view.up = job.up.value_or(scene.up);
  job.view.lens = job.lens.lens(job.options.width, job.options.height);
  if (has_own_view(job, scene) && !job.view.index && !job.view.position) job.view.index = 0;
  job.display.background = background_of(job);
  job.display.mapping = job.tone_mapping.value_or(of_light);
  return job;
}

void resolve_point_size(double points, Job& job) {
  if (!job.point_size) job.point_size = default_point_size(points, job.options.width, job.options.height);
}

LitStill light_still(Job job, const PreparedScene& scene, bool is_linear, const Camera* camera) {
  const Lighting lighting = make_lighting(scene.scene(), job.lighting);
  job = resolve(std::move(job), scene.scene(), lighting.tone_mapping);
  const float aspect = static_cast<float>(job.options.width) / static_cast<float>(job.options.height);
  const Camera chosen = camera != nullptr ? *camera : choose_camera(scene.scene(), job.view, aspect);
  PreparedScene lit = scene.lit(lighting);
  std::string warning = set_light_dimming(job, lit, is_linear);
  lit = dimmed(std::move(lit), job.light_dimming);
  if (job.meters_exposure) job.display.exposure = metered_exposure(lit, chosen, job);
  return {std::move(job), std::move(lit), chosen, std::move(warning)};
}

float metered_exposure(const PreparedScene& scene, const Camera& camera, const Job& job) {
  Renderer renderer(scene, make_resolver(antialias::methods(), "none"));
  return auto_exposure(metered_image(renderer, camera, job.options));
}

bool may_dim_lights(const Job& job, bool is_linear) {
  return job.lighting.source == LightSource::Scene && !job.lighting.environment && !job.has_own_brightness &&
         !is_linear;
}

std::string set_light_dimming(Job& job, const PreparedScene& lit, bool is_linear) {
  job.light_dimming = 1;
  if (!may_dim_lights(job, is_linear)) return {};
  const auto [factor, white] = dimming_of(lit, make_resolver(antialias::methods(), "none"));
  job.light_dimming = factor;
  if (factor == 1) return {};
  return fmt::format(
      "{}: its lights would clip {:.0f} % of the surfaces to white and are dimmed to {:.2g} of their intensity; see "
      "--light-intensity, --exposure and --lights",
      job.input, 100 * white, factor);
}

}  // namespace zoneplate
