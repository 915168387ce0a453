// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/render_streamed.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/size_text.h"
#include "zoneplate/formats/open_stream.h"
#include "zoneplate/job/import_time.h"
#include "zoneplate/job/render_job.h"
#include "zoneplate/job/resolve.h"
#include "zoneplate/render/stream/streamed_backend.h"
#include "zoneplate/render/view.h"
#include "zoneplate/scene/stream/stream_outline.h"

namespace zoneplate {
namespace {

/// Refuses what depends on all vertices. What else does, depends on the request: see make_streamed_backend.
void check_options(const Job& job) {
  const auto refuse = [](const std::string& option) {
    throw Error(ErrorKind::Usage, option + " needs the whole scene in memory");
  };
  if (job.sequence.is_sequence()) refuse("a sequence");
  if (job.meters_exposure) refuse("--exposure auto");
  if (!job.solid_texture.empty()) refuse("--solid-texture");
  if (!job.section.planes.empty()) refuse("--section");
  if (job.displacement) refuse("--displacement");
  if (!job.default_material.files().empty()) refuse("a texture");
  if (job.options.ground == GroundKind::Shadow) refuse("a ground of shadows");
  for (const Aov* aov : job.aovs)
    if (aov->plane == &Planes::sample_triangles) refuse(fmt::format("--aov {}", aov->name));
}

/// Refuses what depends on all vertices, and says of which file and why they are not in memory.
void check_is_streamable(const Job& job, const Request& request) {
  try {
    check_options(job);
    check_streamed(request, job.options);
  } catch (const Error& error) {
    throw Error(error.kind(), fmt::format("{}: {}, for which --max-memory is too small", job.input, error.what()));
  }
}

/// The farthest corners of a stream as points of a scene, whose camera is that of the stream.
Scene scene_of_points(const Scene& head, std::vector<float3> points) {
  Scene scene = head;
  scene.meshes.resize(1), scene.instances.assign(1, {});
  Mesh& mesh = scene.meshes[0];
  mesh.topology = Topology::Points;
  mesh.index.resize(points.size());
  std::iota(mesh.index.begin(), mesh.index.end(), 0u);
  mesh.position = std::move(points);
  return scene;
}

bool are_single_sided(const Scene& head) {
  return std::ranges::none_of(head.instances, [&](const Instance& instance) {
    const Mesh& mesh = head.meshes[static_cast<std::size_t>(instance.mesh)];
    return head.materials[static_cast<std::size_t>(mesh.material)].double_sided;
  });
}

Camera camera_of(const Job& job, const Scene& head, const StreamOutline& outline) {
  View view = job.view;
  view.up = job.up.value_or(head.up);
  view.lens = job.lens.lens(job.options.width, job.options.height);
  const float aspect = static_cast<float>(job.options.width) / static_cast<float>(job.options.height);
  const std::vector<float3> directions = view_directions(outline.bounds(), view, aspect);
  const Camera camera = choose_camera(scene_of_points(head, outline.farthest(directions)), view, aspect);
  if (is_free(view) && are_single_sided(head) && !outline.has_front(camera))
    throw Error(ErrorKind::Usage, job.input +
                                      ": the default camera sees backs alone, and to choose another one needs "
                                      "the whole scene in memory: see --camera-azimuth-angle");
  return camera;
}

/// An eighth of the memory for the parts that are searched, and a quarter for the visible triangles.
StreamCapacity capacity_of(const FileStream& stream, std::uint64_t memory) {
  // Corners, indices and screen vertices of a triangle, and its samples in bins.
  constexpr std::uint64_t of_part = 350, least = 1 << 12;
  constexpr StreamCapacity most;
  const auto triangles = [&](std::uint64_t bytes, std::uint64_t of_each, std::size_t limit) {
    return static_cast<std::size_t>(std::clamp<std::uint64_t>(bytes / of_each, least, limit));
  };
  return {.part = triangles(memory / 8, of_part, most.part),
          .visible = triangles(memory / 4, stream.visible_bytes(), most.visible)};
}

}  // namespace

std::unique_ptr<FileStream> open_streamed(const Job& job, const Request& request) {
  std::unique_ptr<FileStream> stream = open_large_file(job.input, job.load);
  if (!stream) return nullptr;
  try {
    check_is_streamable(job, request);
    stream->check();
  } catch (const Error&) {
    if (stream->bytes_in_memory() > job.load.limits.memory) throw;
    return nullptr;
  }
  return stream;
}

void render_streamed(Job job, std::unique_ptr<Resolver> method, std::unique_ptr<FileStream> file, JobSink& out,
                     Summary& summary) {
  const Stopwatch reading;
  const std::shared_ptr<FileStream> stream = std::move(file);
  StillView view;
  Scene head;
  within_import_time(job.input, job.load.limits, [&] {
    const StreamOutline outline(*stream, job.input, out.progress_of("read", 0, 0.1));
    head = stream->head();
    if (head.needs_fill_light && may_dim_lights(job, is_linear(job.named_output())))
      throw Error(ErrorKind::Usage, job.input +
                                        ": its lights may be dimmed, which needs the whole scene in memory, for "
                                        "which --max-memory is too small: see --light-intensity");
    view.camera = camera_of(job, head, outline);
  });
  summary.times.emplace_back("read", reading.ms());
  out.has_read();
  head.warnings.push_back(
      fmt::format("{}: its {} triangles may take {} in memory, more than --max-memory allows: they are drawn in parts "
                  "from the file",
                  job.input, stream->count(), size_text(stream->bytes_to_draw())));
  convert_materials(job, head);
  const PreparedScene prepared(std::move(head), job.mips);
  view.backend = make_streamed_backend(stream, capacity_of(*stream, job.load.limits.memory));
  DrawnStill still = draw_still(std::move(job), std::move(method), prepared, std::move(view), out, summary);
  stream->check_whole();
  send_still(std::move(still), prepared.scene(), false, out, summary);
}

}  // namespace zoneplate
