#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zoneplate/cli/aov.h"
#include "zoneplate/cli/args.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/look.h"
#include "zoneplate/cli/progress.h"
#include "zoneplate/cli/view.h"
#include "zoneplate/image/tonemap.h"
#include "zoneplate/render/render.h"

namespace zoneplate::cli {

/// Everything that `zoneplate render` can be told.
struct RenderArgs {
  std::string input, output;
  std::string method = "msaa:n=8";
  RenderOptions options;
  DisplayOptions display;
  std::optional<float4> background;  ///< sRGB code; none: the scene's own or the usual one
  View view;
  Look look;
  std::vector<const Aov*> aovs;
  LoadLimits limits;
  int threads = 0;  ///< 0: as many as there are cores
  bool wants_json = false;
  Verbosity verbosity = Verbosity::Normal;
  std::optional<ProgressKind> progress;  ///< none: a bar on a terminal
};

/// The longest side of a picture, in pixels: the reach of the rasterizer's fixed-point coordinates.
inline constexpr int max_side = 16384;

/// The options of the verb, which set `args`. It keeps a reference to it.
Syntax render_syntax(RenderArgs& args);

/// Parses and checks the whole command line of the verb; nothing where help was asked for.
///
/// Errors    Trouble::Usage.
std::optional<RenderArgs> parse_render_args(std::span<const std::string> arguments);

}  // namespace zoneplate::cli
