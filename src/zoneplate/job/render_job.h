// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "zoneplate/job/environment_file.h"
#include "zoneplate/job/job_sink.h"
#include "zoneplate/job/picture.h"
#include "zoneplate/job/resolve.h"
#include "zoneplate/render/prepared_scene.h"

namespace zoneplate {

/// Reads, renders and encodes jobs, one image or one sequence each. The last model is kept for the next job.
class RenderJobs {
 public:
  /// Runs a job that check_job has completed and sends its files to `out`, with the threads of the caller.
  Summary run(Job job, JobSink& out);

 private:
  /// Reads the model of the job; nothing if it is already in `scene_`.
  std::optional<Scene> read(const Job& job);

  std::string key_;  ///< of the model that is loaded
  Environments environments_;
  std::optional<PreparedScene> scene_;  ///< the model, with the lights of its file
};

/// Who renders a still image, and through which camera.
struct StillView {
  std::unique_ptr<Backend> backend = make_cpu_backend();
  std::optional<Camera> camera = {};  ///< none: that of the job
};

/// A still image before it is encoded, of a job that is resolved.
struct DrawnStill {
  LitStill still;
  RenderedImage image;
};

/// The two halves of render_still. `can_meter`: the scene is whole, so that warnings may depend on its light.
DrawnStill draw_still(Job job, std::unique_ptr<Resolver> method, const PreparedScene& prepared, StillView view,
                      JobSink& out, Summary& summary);
void send_still(DrawnStill drawn, const Scene& scene, bool can_meter, JobSink& out, Summary& summary);

/// Renders, encodes and sends a still image of a scene whose materials are those of the job, which check_job has
/// completed.
void render_still(Job job, std::unique_ptr<Resolver> method, const PreparedScene& prepared, JobSink& out,
                  Summary& summary);

/// The options that determine the loaded model: jobs with the same key share one.
std::string model_key(const Job& job);

}  // namespace zoneplate
