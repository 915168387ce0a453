#pragma once

#include <memory>
#include <string>

#include "zoneplate/cli/render_picture.h"
#include "zoneplate/cli/stage.h"
#include "zoneplate/report/json.h"

namespace zoneplate::cli {

/// Carries out what the arguments of one picture, or one sequence, ask for; keeps the last model between jobs.
class RenderJobs {
 public:
  /// Reads, renders and writes. The threads are those of the caller.
  Summary run(RenderArgs args);

 private:
  Stage& stage_of(const RenderArgs& args);

  std::string key_;  ///< of the model that is loaded
  std::unique_ptr<Stage> stage_;
};

/// The result as JSON.
Json::Object summary_json(const RenderArgs& args, const Summary& summary);

}  // namespace zoneplate::cli
