// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/render/job.h"

#include <fmt/format.h>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/render/sequence.h"
#include "zoneplate/cli/report_version.h"
#include "zoneplate/cli/usage.h"
#include "zoneplate/formats/load.h"
#include "zoneplate/os/file.h"
#include "zoneplate/render/metering/metering.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::cli {

std::string model_key(const RenderArgs& args) {
  const SceneChoice& c = args.load.choice;
  const LoadLimits& l = args.load.limits;
  const DefaultMaterial& m = args.default_material;
  const float4 color = m.color.value_or(float4{-1, 0, 0, 0});
  return fmt::format(
      "{} {}\n{}\n{}\n{} {} {} {:a} {} {} {} {} {} {} {} {} {} {} {} {:a} {:a} {:a} {:a} {:a} {:a} {} {} {} {} {:a}",
      l.is_strict, args.input, args.load.format, c.animation_name, c.scene.value_or(-1), c.variant,
      c.animation.value_or(-1), c.time, l.memory, l.pixels, l.seconds, fmt::join(l.allowed_paths, "\n"),
      args.mips.raw_colors, static_cast<int>(args.mips.filter), args.mips.keeps_coverage, args.mips.weights_by_alpha,
      args.shading_model ? static_cast<int>(*args.shading_model) : -1, args.solid_texture,
      args.displacement.value_or(-1), color.x, color.y, color.z, color.w, m.metallic.value_or(-1),
      m.roughness.value_or(-1), m.texture, args.section.text(), m.normal_map, m.height_map,
      m.height_scale.value_or(-1e30f));
}

std::optional<Scene> RenderJobs::read(const RenderArgs& args) {
  const std::string key = model_key(args);
  if (scene_ && key == key_ && args.input != "-") return std::nullopt;
  scene_.reset();
  std::optional<Scene> scene;
  within_import_time(args.input, args.load.limits, [&] { scene = load_scene(args.input, args.load); });
  key_ = key;
  return scene;
}

Summary RenderJobs::run(RenderArgs args, ItemSender& out) {
  const Stopwatch total_watch;
  std::unique_ptr<Resolver> method = upscale::make_method(args.method);
  check_request(args, request_of(args, *method));
  Summary summary;
  summary.threads = thread_limit();
  out.progress("read", 0);
  const Environments::Store store = [&](std::uint64_t key, auto bytes) { out.environment(key, bytes); };
  complete_environments(environments_, args, store, out);
  if (args.sequence.is_sequence()) {
    render_sequence(args, std::move(method), out, summary);
    summary.times = {{"total", total_watch.ms()}};
    summary.peak_memory = peak_memory();
    return summary;
  }

  const Stopwatch read_watch;
  std::optional<Scene> read_scene = read(args);
  summary.times.emplace_back("read", read_watch.ms());
  out.has_read();
  const Stopwatch texture_watch;
  if (read_scene) {
    convert_materials(args, *read_scene);
    scene_.emplace(std::move(*read_scene), args.mips);
  }
  summary.times.emplace_back("textures", texture_watch.ms());
  const Scene& scene = scene_->scene();
  const Camera camera = choose_own_camera(args, scene);
  summary.warnings = scene.warnings;
  if (std::string late = lateness(args, end_of_animation(args.load.choice, scene)); !late.empty())
    summary.warnings.push_back(std::move(late));
  out.progress("render", 0.1);
  check_passes(args, request_of(args, *method));
  RenderedImage image;
  const Lighting lighting = make_lighting(scene, args.lighting);
  args.display.mapping = args.tone_mapping.value_or(lighting.tone_mapping);
  PreparedScene lit = scene_->lit(lighting);
  if (std::string warning = set_light_dimming(args, lit, args.named_output()); !warning.empty())
    summary.warnings.push_back(std::move(warning));
  lit = dimmed(std::move(lit), args.light_dimming);
  {
    Renderer renderer(lit, std::move(method));
    if (args.meters_exposure) args.display.exposure = metered_exposure(renderer.scene(), camera, args);
    RenderSettings settings = settings_of(args, args.named_output());
    settings.options.progress = out.progress_of("render", 0.1, 0.9);
    image = renderer.render_still(camera, settings);
  }
  summary.exposure = args.display.exposure;
  const Rendered picture = finish_picture(args, std::move(image), scene, camera, args.named_output(), summary);
  const auto metered = [&] { return metered_exposure(lit, camera, args); };
  if (std::string warning = clipping(args, picture, metered); !warning.empty())
    summary.warnings.push_back(std::move(warning));
  if (std::string warning = emptiness(args, summary.counts, picture); !warning.empty())
    summary.warnings.push_back(std::move(warning));

  out.progress("encode", 0.9);
  const Stopwatch encode_watch;
  const std::vector<std::uint8_t> bytes = encode_picture(picture, args.named_output(), args.file);
  summary.times.emplace_back("encode", encode_watch.ms());
  out.progress("write", 0.99);
  const Stopwatch write_watch;
  for (const LayerFile& file : picture.layers) out.file(-1, file.aov, file.bytes);
  out.file(-1, -1, bytes);  // last: --skip-existing looks for it
  summary.times.emplace_back("write", write_watch.ms());
  summary.times.emplace_back("total", total_watch.ms());
  summary.peak_memory = peak_memory();
  return summary;
}

Json::Object summary_json(const RenderArgs& args, const Summary& summary) {
  Json::Object times, passes;
  for (const auto& [name, ms] : summary.times) times.emplace_back(name, ms);
  for (const Aov* aov : args.aovs) passes.emplace_back(aov->name, aov_path(summary.output, aov->name));
  return Json::Object{{"format", "zoneplate-render"},
                      {"version", report_version},
                      {"input", args.input},
                      {"output", summary.output},
                      {"data_passes", std::move(passes)},
                      {"width", summary.width},
                      {"height", summary.height},
                      {"method", args.method},
                      {"exposure", summary.exposure},
                      {"frames", summary.frames},
                      {"triangles", summary.counts.triangles},
                      {"triangles_set_up", summary.counts.triangles_set_up},
                      {"shaded_samples", summary.counts.shaded},
                      {"threads", summary.threads},
                      {"isa", name_of(args.isa)},
                      {"stage_ms", std::move(times)},
                      {"peak_memory_bytes", summary.peak_memory},
                      {"warnings", Json::Array(summary.warnings.begin(), summary.warnings.end())}};
}

std::string plan_text(const RenderArgs& args) {
  const std::optional<Crop>& crop = args.options.crop;
  return fmt::format("{} -> {}, {} × {}, {}", args.input, args.output, crop ? crop->width : args.options.width,
                     crop ? crop->height : args.options.height, args.method);
}

Json::Object plan_json(const RenderArgs& args, std::string_view status) {
  return {{"format", "zoneplate-render"},
          {"version", report_version},
          {"input", args.input},
          {"output", args.output},
          {"status", status}};
}

}  // namespace zoneplate::cli
