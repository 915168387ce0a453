// SPDX-License-Identifier: Apache-2.0
// zoneplate fidelity: renders the scenarios of a render-fidelity collection and compares them with the images of other
// renderers.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/batch/items.h"
#include "zoneplate/cli/args.h"
#include "zoneplate/cli/common_options.h"
#include "zoneplate/cli/confined.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/render/args.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/evaluate/fidelity.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/job/options.h"
#include "zoneplate/math/angle.h"
#include "zoneplate/report/table.h"

namespace zoneplate::cli {
namespace {

namespace fs = std::filesystem;

struct FidelityArgs {
  std::string output, root, method = "ssaa:n=3,mix=codes";
  std::vector<std::string> peers = {"model-viewer", "filament", "babylon", "gltf-sample-viewer"};
  int threads = 0;
  ReadingLimits limits;
};

/// The scene that all peers render: camera as <model-viewer>, no lights but the image, three.js' ACES curve. Most peers
/// draw glass opaque before a transparent background.
std::vector<std::string> render_arguments(const Scenario& s, const FidelityArgs& args, const std::string& root,
                                          const std::string& output) {
  const SineCosine theta = sine_cosine(static_cast<double>(s.theta) * 3.14159265358979323846 / 180);
  const SineCosine phi = sine_cosine(static_cast<double>(s.phi) * 3.14159265358979323846 / 180);
  const auto narrow = [](double x) { return static_cast<float>(x); };
  const float3 outwards{narrow(phi.sine * theta.sine), narrow(phi.cosine), narrow(phi.sine * theta.cosine)};
  const float3 eye = s.target + outwards * s.radius, ahead = eye - outwards;
  const auto triple = [](float3 v) { return fmt::format("{:.9g},{:.9g},{:.9g}", v.x, v.y, v.z); };
  std::vector<std::string> words = {(fs::path(root) / s.model).string(),
                                    "-o",
                                    output,
                                    "--quiet",
                                    "--size",
                                    fmt::format("{}x{}", s.size.x, s.size.y),
                                    "--aa",
                                    args.method,
                                    "--tone-mapping",
                                    "aces",
                                    "--hdri-file",
                                    (fs::path(root) / s.environment).string(),
                                    "--camera-position",
                                    triple(eye),
                                    "--camera-focal-point",
                                    triple(ahead),
                                    "--camera-view-angle",
                                    fmt::format("{:.9g}", s.view_angle)};
  if (s.has_background)
    words.insert(words.end(), {"--background", "environment"});
  else
    words.insert(words.end(), {"--no-background", "--opaque-glass"});
  return words;
}

/// The folder that the scenarios' paths are relative to: that of the file, or the one above.
std::string find_root(const FidelityArgs& args, const std::string& file, const Scenario& scenario) {
  if (!args.root.empty()) return args.root;
  const fs::path folder = fs::absolute(file).parent_path();
  std::error_code ignored;
  return fs::exists(folder / scenario.model, ignored) ? folder.string() : folder.parent_path().string();
}

Syntax fidelity_syntax(FidelityArgs& args) {
  Syntax syntax{
      .verb = "fidelity",
      .summary = "Render the scenarios of a render-fidelity collection and compare them with other renderers",
      .operands = "SCENARIOS.json -o DIR",
      .examples = "  zoneplate fidelity goldens/scenarios.json -o out\n",
      .notes =
          "A scenario has a name, a model, an environment image, an orbit, a target, verticalFoV and\n"
          "renderSkybox, as in glTF's render-fidelity collection; images/NAME/PEER.png next to the file are\n"
          "the images of other renderers, whose size is used. A scenario passes where the distance (yiq_rms,\n"
          "zoneplate metrics --help) to the nearest peer is at most -24 dB, or at most 2 dB more than the\n"
          "median distance between the peers, and the overlap of the alpha channels is at least 0.995.\n"
          "\n"
          "Exit codes: 0 all pass, 1 some do not, 2 wrong usage, 3 input missing or corrupt.\n"};
  const std::string group = "Options";
  syntax.options = {
      {"--output,-o", "DIR", "Folder of the rendered images; made if it does not exist", group, true,
       [&](auto& text) { args.output = text; }},
      {"--root", "DIR", "Folder that models and environments are relative to; default: that of the file, or above it",
       group, true, [&](auto& text) { args.root = text; }},
      {"--peers", "LIST", "Renderers to compare with; default model-viewer,filament,babylon,gltf-sample-viewer", group,
       true, [&](auto& text) { args.peers = split_specs(text); }},
      {"--anti-aliasing,--aa", "METHOD",
       "Antialiasing method; default ssaa:n=3,mix=codes, as the images of the peers are made", group, true,
       [&](auto& text) { args.method = text; }},
      {"--threads,-t", "N", "Threads at most; 0, the default: as many as affinity and CPU quota allow", group, false,
       [&](auto& text) { args.threads = parse_whole(text, 0, 1024); }},
      allow_path_option(args.limits.load)};
  for (Option& option : limit_options(args.limits, "a scenario")) syntax.options.push_back(std::move(option));
  return syntax;
}

/// The images of the peers that exist, by their names.
std::map<std::string, std::string> peer_files(const FidelityArgs& args, const std::string& file,
                                              const Scenario& scenario) {
  const fs::path folder = fs::absolute(file).parent_path() / "images" / scenario.name;
  std::map<std::string, std::string> files;
  std::error_code ignored;
  for (const std::string& name : args.peers)
    if (const fs::path image = folder / (name + ".png"); fs::exists(image, ignored)) files.emplace(name, image);
  if (files.empty()) throw Error(ErrorKind::Input, folder.string() + ": no image of a peer");
  return files;
}

ConfinedRun confined_run(const FidelityArgs& args, const std::string& file, std::vector<std::string> readable) {
  return {.name = file, .limits = args.limits, .readable = std::move(readable), .outputs = {}};
}

std::vector<Scenario> confined_scenarios(const FidelityArgs& args, const std::string& file) {
  return unpack_scenarios(
      run_confined(confined_run(args, file, {file}), [&](Delivery& out) { read_scenarios(file, out); }));
}

int2 confined_size(const FidelityArgs& args, const std::string& image) {
  const int2 size = unpack_size(
      run_confined(confined_run(args, image, {image}), [&](Delivery& out) { read_shown_size(image, out); }));
  if (size.x < 1 || size.y < 1) throw Error(ErrorKind::Input, image + ": has no pixels");
  return size;
}

FidelityVerdict confined_verdict(const FidelityArgs& args, const std::string& output,
                                 const std::map<std::string, std::string>& peers) {
  std::vector<std::string> readable{output};
  for (const auto& [name, image] : peers) readable.push_back(image);
  return unpack_verdict(
      run_confined(confined_run(args, output, readable), [&](Delivery& out) { judge_fidelity(output, peers, out); }));
}

/// Renders a scenario as `zoneplate render` does, and compares it.
FidelityVerdict verdict_of(const FidelityArgs& args, const std::string& file, Scenario scenario) {
  if (scenario.name.find('/') != std::string::npos || scenario.name == "." || scenario.name == "..")
    throw Error(ErrorKind::Input,
                fmt::format("{}: scenario '{}': its name is not that of a file", file, scenario.name));
  const std::map<std::string, std::string> peers = peer_files(args, file, scenario);
  scenario.size = confined_size(args, peers.begin()->second);
  const std::string output = (fs::path(args.output) / (scenario.name + ".png")).string();
  std::optional<RenderArgs> render =
      parse_render_args(render_arguments(scenario, args, find_root(args, file, scenario), output));
  render->load.limits = args.limits.load;
  render->max_seconds = args.limits.seconds, render->is_sandboxed = args.limits.is_sandboxed;
  RenderItems({*render}, {.warn = say_warning}).next();
  return confined_verdict(args, output, peers);
}

}  // namespace

void run_fidelity(std::span<const std::string> arguments) {
  FidelityArgs args;
  Syntax syntax = fidelity_syntax(args);
  if (!parse(syntax, arguments)) return;
  if (syntax.found_operands.size() != 1) throw Error(ErrorKind::Usage, "fidelity takes one file of scenarios");
  if (args.output.empty()) throw Error(ErrorKind::Usage, "no output: give -o DIR");
  const std::string file = syntax.found_operands.front();
  const std::vector<Scenario> scenarios = confined_scenarios(args, file);
  if (scenarios.empty()) throw Error(ErrorKind::Input, file + ": no scenarios");
  std::error_code failure;
  fs::create_directories(args.output, failure);
  if (failure) throw Error(ErrorKind::Output, args.output + ": " + failure.message());

  Table table{{"scenario", "nearest", "dB", "peers' median", "bound", "overlap", "result"}, {}};
  int failed = 0;
  for (const Scenario& scenario : scenarios) {
    FidelityVerdict v;
    with_threads(args.threads, [&] { v = verdict_of(args, file, scenario); });
    if (!v.is_good()) ++failed;
    table.rows.push_back({scenario.name, v.nearest, fmt::format("{:.2f}", v.decibels), fmt::format("{:.2f}", v.median),
                          fmt::format("{:.2f}", v.bound), fmt::format("{:.4f}", v.overlap),
                          v.is_good() ? "pass" : "FAIL"});
  }
  print(table_text(table));
  if (failed > 0) throw Difference(fmt::format("{} of {} scenarios miss their bounds", failed, scenarios.size()));
}

}  // namespace zoneplate::cli
