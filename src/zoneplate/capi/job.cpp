// SPDX-License-Identifier: Apache-2.0
// Jobs: renderings by the options of the command.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/capi/handles.h"
#include "zoneplate/job/check.h"
#include "zoneplate/job/environment_file.h"
#include "zoneplate/job/options.h"
#include "zoneplate/job/output/film.h"
#include "zoneplate/job/render_job.h"
#include "zoneplate/job/sequence.h"
#include "zoneplate/os/file.h"
#include "zoneplate/upscale/upscaler.h"

using namespace zoneplate;
using namespace zoneplate::capi;

namespace zoneplate::capi {
namespace {

/// The options of jobs: those of the command that describe a rendering, and those of reading.
std::vector<Option> options_of(Job& job) {
  std::vector<Option> out = job_options(job);
  for (Option& option : reading_options(job.load.limits, "Running", "an image")) out.push_back(std::move(option));
  out.push_back({"--sandbox", "", "Read models in a sandboxed process", "Running", false,
                 [&](auto&) { job.load.is_sandboxed = true; }});
  return out;
}

/// The files of a job.
class FileSink final : public JobSink {
 public:
  explicit FileSink(const Job& job) : job_(job) {}
  void file(int frame, int layer, std::span<const std::uint8_t> bytes) override {
    save_bytes(output_path(job_, frame, layer), bytes);
  }
  void film_frame(const Rgba8Image& image) override {
    if (!film_)
      film_.emplace(job_.output, image.width(), image.height(), film_format(job_.sequence.rate),
                    std::function<void()>());
    film_->add({reinterpret_cast<const std::uint8_t*>(image.values().data()), image.values().size_bytes()});
  }
  /// After the last frame.
  void finish() {
    if (film_) save_bytes(job_.output, film_->encode());
  }

 private:
  const Job& job_;
  std::optional<FfmpegFilm> film_;
};

}  // namespace
}  // namespace zoneplate::capi

struct zoneplate_job {
  Job job;
  std::vector<Option> options = options_of(job);
  std::shared_ptr<Environments> environments = std::make_shared<Environments>();  ///< of earlier renderings

  zoneplate_job() = default;
  zoneplate_job(const zoneplate_job&) = delete;
  zoneplate_job& operator=(const zoneplate_job&) = delete;

  /// Calls `body`; errors name options as rows.
  template <class Body>
  zoneplate_status checked(const Body& body) const {
    return guarded([&] { naming_rows(options, body); });
  }

  /// The job of a scene, complete for an output.
  Job of(const zoneplate_scene& scene, const std::string& output) const {
    Job out = job;
    out.input = scene.name;
    const bool reads_otherwise = model_key(reading(job.load)) != model_key(reading({}));
    if (scene.name.empty() && reads_otherwise)
      throw Error(ErrorKind::Usage, "the scene is made from arrays: options of reading a file do not apply to it");
    if (!reads_otherwise) out.load = scene.load, out.load.limits = job.load.limits;
    out.output = output, out.frame_place = find_frame_place(output);
    check_effects(out);
    check_job(out);
    return out;
  }

  /// Runs `body` with the threads and the instruction set of the job.
  void run(const std::function<void()>& body) const {
    with_isa(job.isa, [&] { with_threads(job.threads, body); });
  }

 private:
  /// A job of these options of reading alone.
  static Job reading(const LoadOptions& load) {
    Job out;
    out.load = load, out.load.limits = {};
    out.load.limits.is_strict = load.limits.is_strict, out.load.limits.allowed_paths = load.limits.allowed_paths;
    return out;
  }
};

struct zoneplate_frames {
  std::shared_ptr<Environments> environments;
  std::optional<PreparedScene> given;
  int threads = 0;
  Isa isa = current_isa();
  NoFiles sink;
  std::optional<JobFrames> frames;
};

namespace zoneplate::capi {
namespace {

/// The job of images in memory, whose form is that of files of its output.
Job in_memory(const zoneplate_job& job, const zoneplate_scene& scene, zoneplate_form form) {
  // Light with alpha is that of an .exr, which has alpha unless a background is given.
  const bool has_alpha = job.job.display.is_transparent || (job.job.background && job.job.background->w < 1);
  const char* const outputs[] = {"image.png", "image.png", has_alpha ? "image.exr" : "image.pfm"};
  if (job.job.bit_depth == 16 && form != ZONEPLATE_SRGB16)
    throw Error(ErrorKind::Usage, "bit-depth: is 16, and the form of the image is another one");
  Job out = job.of(scene, at(outputs, form, "form"));
  if (form == ZONEPLATE_SRGB16) out.bit_depth = 16;
  return out;
}

}  // namespace
}  // namespace zoneplate::capi

zoneplate_status zoneplate_job_new(zoneplate_job** job) {
  return guarded([&] { required(job, "job") = new zoneplate_job; });
}

void zoneplate_job_free(zoneplate_job* job) { delete job; }

zoneplate_status zoneplate_job_set(zoneplate_job* job, const char* option, const char* value) {
  return guarded([&] {
    zoneplate_job& to = required(job, "job");
    set_row(to.options, &required(option, "option"), value);
  });
}

zoneplate_status zoneplate_job_load(const zoneplate_job* job, const char* name, zoneplate_scene** scene) {
  if (job == nullptr) return guarded([&] { required(job, "job"); });
  return job->checked([&] {
    std::unique_ptr<zoneplate_scene> out;
    LoadOptions load = job->job.load;
    const bool has_animation = load.choice.animation || !load.choice.animation_name.empty();
    if (job->job.has_animation_time && !has_animation && !job->job.sequence.requests_frames())
      load.choice.animation = 0;
    job->run([&] { out = loaded(&required(name, "name"), load); });
    required(scene, "scene") = out.release();
  });
}

zoneplate_status zoneplate_job_render(zoneplate_job* job, zoneplate_scene* scene, const zoneplate_camera* camera,
                                      zoneplate_form form, zoneplate_image** image) {
  if (job == nullptr) return guarded([&] { required(job, "job"); });
  return job->checked([&] {
    zoneplate_scene& from = required(scene, "scene");
    zoneplate_image*& result = required(image, "image");
    Job complete = in_memory(*job, from, form);
    if (complete.sequence.requests_frames())
      throw Error(ErrorKind::Usage, "the job is a sequence of frames: render it by zoneplate_job_frames");
    std::unique_ptr<zoneplate_image> out;
    job->run([&] {
      NoFiles sink;
      complete_environments(*job->environments, complete, {}, sink);
      const PreparedScene model = from.prepared(complete);
      check_request(complete, request_of(complete, *upscale::make_method(complete.method)));
      out = render_image(complete, model, camera);
    });
    result = out.release();
  });
}

zoneplate_status zoneplate_job_save(zoneplate_job* job, zoneplate_scene* scene, const char* output) {
  if (job == nullptr) return guarded([&] { required(job, "job"); });
  return job->checked([&] {
    zoneplate_scene& from = required(scene, "scene");
    const std::string file = &required(output, "output");
    check_output_name(file);
    Job complete = job->of(from, file);
    FileSink sink(complete);
    check_savable(output_path(complete, complete.sequence.first.value_or(0), -1));
    job->run([&] {
      Job lit = complete;
      complete_environments(*job->environments, lit, {}, sink);
      std::unique_ptr<Resolver> method = upscale::make_method(lit.method);
      check_request(lit, request_of(lit, *method));
      Summary summary;
      const bool reads = lit.sequence.is_sequence() && !from.name.empty();
      const std::optional<PreparedScene> model = reads ? std::nullopt : std::optional(from.prepared(lit));
      if (lit.sequence.is_sequence())
        render_sequence(lit, std::move(method), sink, summary, model ? &*model : nullptr);
      else
        render_still(lit, std::move(method), *model, sink, summary);
    });
    sink.finish();
  });
}

zoneplate_status zoneplate_job_frames(zoneplate_job* job, zoneplate_scene* scene, zoneplate_form form,
                                      zoneplate_frames** frames) {
  if (job == nullptr) return guarded([&] { required(job, "job"); });
  return job->checked([&] {
    zoneplate_scene& from = required(scene, "scene");
    Job complete = in_memory(*job, from, form);
    if (!complete.sequence.requests_frames())
      throw Error(ErrorKind::Usage, "the job has no frames: set turntable, frames, frame-start or frame-end");
    auto out = std::make_unique<zoneplate_frames>();
    out->environments = job->environments, out->threads = job->job.threads, out->isa = job->job.isa;
    job->run([&] {
      complete_environments(*out->environments, complete, {}, out->sink);
      std::unique_ptr<Resolver> method = upscale::make_method(complete.method);
      check_request(complete, request_of(complete, *method));
      if (from.name.empty()) out->given = from.prepared(complete);
      out->frames.emplace(complete, std::move(method), out->sink, out->given ? &*out->given : nullptr);
    });
    required(frames, "frames") = out.release();
  });
}

size_t zoneplate_frames_count(const zoneplate_frames* frames) {
  return frames == nullptr ? 0 : frames->frames->frames().size();
}

zoneplate_status zoneplate_frames_next(zoneplate_frames* frames, int32_t* number, zoneplate_image** image) {
  return guarded([&] {
    zoneplate_frames& from = required(frames, "frames");
    zoneplate_image*& result = required(image, "image");
    JobFrames& rest = *from.frames;
    if (rest.done() == rest.frames().size()) {
      result = nullptr;
      return;
    }
    std::unique_ptr<zoneplate_image> out;
    with_isa(from.isa, [&] {
      with_threads(from.threads, [&] {
        JobImage next = rest.next();
        if (number != nullptr) *number = next.frame;
        out = image_of(rest.job(), std::move(next.image), rest.scene());
      });
    });
    result = out.release();
  });
}

void zoneplate_frames_free(zoneplate_frames* frames) { delete frames; }

zoneplate_status zoneplate_job_option(size_t index, zoneplate_option* option) {
  struct Row {
    std::string name, value, choices, group, summary, names;
    ValueKind kind;
    double low, high;
  };
  return guarded([&] {
    static const std::vector<Row> rows = [] {
      Job job;
      std::vector<Row> out;
      for (const Option& o : options_of(job))
        out.push_back({row_name(o), o.value, fmt::format("{}", fmt::join(o.choices, ",")), o.group,
                       without_dashes(options_of(job), o.meaning), o.names, o.kind(), o.set.low, o.set.high});
      return out;
    }();
    if (index >= rows.size()) throw Error(ErrorKind::Usage, "index: is past the last option");
    zoneplate_option& out = required(option, "option");
    const Row& row = rows[index];
    const zoneplate_option full{.size = out.size,
                                .name = row.name.c_str(),
                                .value = row.value.c_str(),
                                .kind = static_cast<zoneplate_option_kind>(row.kind),
                                .low = row.low,
                                .high = row.high,
                                .choices = row.choices.c_str(),
                                .group = row.group.c_str(),
                                .summary = row.summary.c_str(),
                                .names = row.names.c_str()};
    if (out.size < sizeof(std::size_t) || out.size > sizeof full)
      throw Error(ErrorKind::Usage, "zoneplate_option: size is not sizeof(zoneplate_option)");
    std::memcpy(&out, &full, out.size);
  });
}
