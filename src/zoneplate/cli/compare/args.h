// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/cli/args.h"
#include "zoneplate/cli/render/args.h"
#include "zoneplate/evaluate/compare/comparison.h"

namespace zoneplate::cli {

/// The arguments of `zoneplate compare`.
struct CompareArgs : CompareOptions {
  RenderArgs render;  ///< size, view, lights, tone mapping, limits: the options of `zoneplate render`
  std::string methods = "all", reference, metrics;
  bool replaces = false;  ///< an earlier comparison in the folder of the output
  int turns = 3;
};

/// The applicable options of `render`, and the verb's own.
Syntax compare_syntax(CompareArgs& args);

/// Errors    ErrorKind::Usage for an invalid method, metric or reference; ErrorKind::Input for a reference that is no
///           file.
TrialOptions trial_options(const CompareArgs& args);

/// The scenes of the operands; `all` is every built-in scene that shows a class of artifacts.
std::vector<std::string> scenes_of(const std::vector<std::string>& operands);

/// Reports an invalid scene name before the first scene is drawn.
void check_scenes(const CompareArgs& args);

}  // namespace zoneplate::cli
