// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/render_job.h"

#include <fmt/format.h>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/job/import_time.h"
#include "zoneplate/job/render_streamed.h"
#include "zoneplate/job/resolve.h"
#include "zoneplate/job/sequence.h"
#include "zoneplate/os/file.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate {

std::string model_key(const Job& job) {
  const SceneChoice& c = job.load.choice;
  const LoadLimits& l = job.load.limits;
  const DefaultMaterial& m = job.default_material;
  const float4 color = m.color.value_or(float4{-1, 0, 0, 0});
  return fmt::format(
      "{} {}\n{}\n{}\n{} {} {} {:a} {} {} {} {} {} {} {} {} {} {} {} {:a} {:a} {:a} {:a} {:a} {:a} {} {} {} {} {:a}",
      l.is_strict, job.input, job.load.format, c.animation_name, c.scene.value_or(-1), c.variant,
      c.animation.value_or(-1), c.time, l.memory, l.pixels, l.seconds, fmt::join(l.allowed_paths, "\n"),
      job.mips.raw_colors, static_cast<int>(job.mips.filter), job.mips.keeps_coverage, job.mips.weights_by_alpha,
      job.shading_model ? static_cast<int>(*job.shading_model) : -1, job.solid_texture, job.displacement.value_or(-1),
      color.x, color.y, color.z, color.w, m.metallic.value_or(-1), m.roughness.value_or(-1), m.texture,
      job.section.text(), m.normal_map, m.height_map, m.height_scale.value_or(-1e30f));
}

std::optional<Scene> RenderJobs::read(const Job& job) {
  const std::string key = model_key(job);
  if (scene_ && key == key_ && job.input != "-") return std::nullopt;
  scene_.reset();
  std::optional<Scene> scene;
  within_import_time(job.input, job.load.limits, [&] { scene = load_scene(job.input, job.load); });
  key_ = key;
  return scene;
}

DrawnStill draw_still(Job job, std::unique_ptr<Resolver> method, const PreparedScene& prepared, StillView view,
                      JobSink& out, Summary& summary) {
  const Scene& scene = prepared.scene();
  summary.warnings = scene.warnings;
  if (std::string late = lateness(job, end_of_animation(job.load.choice, scene)); !late.empty())
    summary.warnings.push_back(std::move(late));
  out.progress("render", 0.1);
  check_passes(job, request_of(job, *method));
  LitStill still = light_still(job, prepared, is_linear(job.named_output()), view.camera ? &*view.camera : nullptr);
  if (!still.warning.empty()) summary.warnings.push_back(std::move(still.warning));
  RenderSettings settings = settings_of(still.job, job.named_output());
  settings.options.progress = out.progress_of("render", 0.1, 0.9);
  Renderer renderer(still.scene, std::move(method), std::move(view.backend));
  RenderedImage image = renderer.render_still(still.camera, settings);
  return {std::move(still), std::move(image)};
}

void send_still(DrawnStill drawn, const Scene& scene, bool can_meter, JobSink& out, Summary& summary) {
  const LitStill& still = drawn.still;
  const Job& job = still.job;
  summary.exposure = job.display.exposure;
  const Rendered picture =
      finish_picture(job, std::move(drawn.image), scene, still.camera, job.named_output(), summary);
  const auto metered = [&] { return metered_exposure(still.scene, still.camera, job); };
  if (can_meter)
    if (std::string warning = clipping(job, picture.image, metered); !warning.empty())
      summary.warnings.push_back(std::move(warning));
  if (std::string warning = emptiness(job, summary.counts, picture); !warning.empty())
    summary.warnings.push_back(std::move(warning));

  out.progress("encode", 0.9);
  const Stopwatch encode_watch;
  const std::vector<std::uint8_t> bytes = encode_picture(picture, job.named_output(), job.file);
  summary.times.emplace_back("encode", encode_watch.ms());
  out.progress("write", 0.99);
  const Stopwatch write_watch;
  for (const LayerFile& file : picture.layers) out.file(-1, file.aov, file.bytes);
  out.file(-1, -1, bytes);  // last: --skip-existing looks for it
  summary.times.emplace_back("write", write_watch.ms());
}

void render_still(Job job, std::unique_ptr<Resolver> method, const PreparedScene& prepared, JobSink& out,
                  Summary& summary) {
  DrawnStill drawn = draw_still(std::move(job), std::move(method), prepared, {}, out, summary);
  send_still(std::move(drawn), prepared.scene(), true, out, summary);
}

Summary RenderJobs::run(Job job, JobSink& out) {
  const Stopwatch total_watch;
  std::unique_ptr<Resolver> method = upscale::make_method(job.method);
  check_request(job, request_of(job, *method));
  Summary summary;
  summary.threads = thread_limit();
  out.progress("read", 0);
  const Environments::Store store = [&](std::uint64_t key, auto bytes) { out.environment(key, bytes); };
  complete_environments(environments_, job, store, out);
  if (std::unique_ptr<FileStream> file = open_streamed(job, request_of(job, *method))) {
    scene_.reset();
    render_streamed(std::move(job), std::move(method), std::move(file), out, summary);
    summary.times.emplace_back("total", total_watch.ms());
    return summary;
  }
  if (job.sequence.is_sequence()) {
    render_sequence(job, std::move(method), out, summary);
    summary.times = {{"total", total_watch.ms()}};
    return summary;
  }

  const Stopwatch read_watch;
  std::optional<Scene> read_scene = read(job);
  summary.times.emplace_back("read", read_watch.ms());
  out.has_read();
  const Stopwatch texture_watch;
  if (read_scene) {
    convert_materials(job, *read_scene);
    scene_.emplace(std::move(*read_scene), job.mips);
  }
  summary.times.emplace_back("textures", texture_watch.ms());
  render_still(std::move(job), std::move(method), *scene_, out, summary);
  summary.times.emplace_back("total", total_watch.ms());
  return summary;
}

}  // namespace zoneplate
