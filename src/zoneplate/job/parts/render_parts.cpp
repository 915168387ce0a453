// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/parts/render_parts.h"

#include <optional>
#include <utility>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/job/import_time.h"
#include "zoneplate/job/parts/scene_of_files.h"
#include "zoneplate/job/render_job.h"
#include "zoneplate/job/resolve.h"
#include "zoneplate/render/frame_parts.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw Error(ErrorKind::Usage, what); }

void check_still(const Job& job) {
  if (job.sequence.is_sequence()) refuse("ranks render one image, not a sequence");
  if (job.input == "-") refuse("-: ranks cannot share standard input");
}

/// Refuses what depends on all vertices, where each rank has some files.
void check_files(const Job& job) {
  if (job.meters_exposure) refuse("--exposure auto needs the whole scene, and each rank has a part of it alone");
  if (!job.solid_texture.empty()) refuse("--solid-texture needs the whole scene, and each rank has a part of it alone");
  if (!job.section.planes.empty()) refuse("--section needs the whole scene, and each rank has a part of it alone");
  if (job.view.index) refuse("--camera-index: the cameras of several files cannot be used");
  for (const Aov* aov : job.aovs)
    if (aov->plane == &Planes::sample_triangles)
      refuse("--aov cryptomatte needs the whole scene, and each rank has a part of it alone");
}

Scene read_scene(const Job& job, const std::string& input) {
  Scene scene;
  within_import_time(input, job.load.limits, [&] { scene = load_scene(input, job.load); });
  convert_materials(job, scene);
  return scene;
}

/// The camera of a scene of several files.
Camera camera_of(const Job& job, const SceneOfFiles& files) {
  View view = job.view;
  view.up = job.up.value_or(files.scene.up);
  view.lens = job.lens.lens(job.options.width, job.options.height);
  return choose_camera(scene_of_bounds(files.bounds, files.scene), view,
                       static_cast<float>(job.options.width) / static_cast<float>(job.options.height));
}

}  // namespace

Summary render_parts(PartsJob parts, Ranks& ranks, const std::function<void(const std::function<void()>&)>& agree,
                     JobSink& out, PartTimes& times) {
  const Stopwatch total;
  Job& job = parts.job;
  const bool has_files = parts.inputs.size() > 1;
  Summary summary;
  summary.threads = thread_limit();
  std::unique_ptr<Resolver> method;
  Environments environments;
  SceneOfFiles files;
  std::optional<PreparedScene> prepared;
  StillView view;
  agree([&] {
    check_still(job);
    if (has_files) check_files(job);
    method = upscale::make_method(job.method);
    check_request(job, request_of(job, *method));
    check_passes(job, request_of(job, *method));
    environments.complete(job);
  });
  const Stopwatch reading;
  const std::size_t count = parts.inputs.size();
  std::vector<Scene> read(count);
  agree([&] {
    for (std::size_t file = 0; file < count; ++file)
      if (!has_files || rank_of_file(file, count, ranks.count()) == ranks.rank())
        read[file] = read_scene(job, parts.inputs[file]);
  });
  agree([&] {
    if (!has_files) return prepared.emplace(std::move(read.front()), job.mips), void();
    files = join_files(parts.inputs, std::move(read), ranks);
    if (files.scene.needs_fill_light && may_dim_lights(job, is_linear(job.named_output())))
      refuse("the lights of the files may be dimmed, for which each rank needs the whole scene: see --light-intensity");
    view.camera = camera_of(job, files);
    resolve_point_size(files.points, job);
    prepared.emplace(std::move(files.scene), job.mips);
  });
  summary.times.emplace_back("read", reading.ms());
  view.backend = make_cpu_backend(FrameParts{
      .ranks = ranks, .partition = parts.partition, .elsewhere = std::move(files.elsewhere), .times = &times});
  DrawnStill still = draw_still(job, std::move(method), *prepared, std::move(view), out, summary);
  if (ranks.rank() == 0) send_still(std::move(still), prepared->scene(), !has_files, out, summary);
  summary.times.emplace_back("total", total.ms());
  return summary;
}

}  // namespace zoneplate
