// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "zoneplate/cli/process/item_process.h"
#include "zoneplate/cli/render/environment_file.h"
#include "zoneplate/cli/render/picture.h"
#include "zoneplate/render/prepared_scene.h"
#include "zoneplate/report/json.h"

namespace zoneplate::cli {

/// Reads, renders and encodes one image or one sequence according to the arguments, in the process of the item. The
/// last model is kept for the next job.
class RenderJobs {
 public:
  /// Runs a job and sends its files to `out`, with the threads of the caller.
  Summary run(RenderArgs args, ItemSender& out);

 private:
  /// Reads the model of the arguments; nothing if it is already in `scene_`.
  std::optional<Scene> read(const RenderArgs& args);

  std::string key_;  ///< of the model that is loaded
  Environments environments_;
  std::optional<PreparedScene> scene_;  ///< the model, with the lights of its file
};

/// The options that determine the loaded model: jobs with the same key share one.
std::string model_key(const RenderArgs& args);

/// The result as JSON.
Json::Object summary_json(const RenderArgs& args, const Summary& summary);

/// The line of --dry-run about an item, and its report as JSON with this status.
std::string plan_text(const RenderArgs& args);
Json::Object plan_json(const RenderArgs& args, std::string_view status);

}  // namespace zoneplate::cli
