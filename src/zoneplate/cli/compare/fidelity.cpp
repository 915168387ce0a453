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
#include "zoneplate/cli/args.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/packed.h"
#include "zoneplate/cli/process/confined.h"
#include "zoneplate/cli/render/items.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/codec/inspect/color_space.h"
#include "zoneplate/codec/system/system_format.h"
#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/formats/json/json.h"
#include "zoneplate/image/orientation.h"
#include "zoneplate/job/options.h"
#include "zoneplate/job/values.h"
#include "zoneplate/math/angle.h"
#include "zoneplate/metrics/compare.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/metrics/metrics.h"
#include "zoneplate/os/file.h"
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

/// A view of a model in the light of an image.
struct Scenario {
  std::string name, model, environment;
  float theta = 0, phi = 90, radius = 1;  ///< of the camera about the target, in degrees; phi from the up axis
  float3 target{0, 0, 0};
  float view_angle = 45;
  bool has_background = false;
  int2 size{0, 0};  ///< of the peers' images
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

/// The list of the file: a JSON array, or the member "scenarios" of an object.
std::vector<Scenario> read_scenarios(const std::string& path, const LoadLimits& limits) {
  const FileBytes file(path, limits.memory);
  ImportBudget budget(path, limits);
  JsonValue whole{.kind = JsonValue::Kind::Object, .keys = {"scenarios"}};
  JsonValue value = parse_json(file.bytes(), budget);
  const bool is_list = value.kind == JsonValue::Kind::List;
  if (is_list) whole.items.push_back(std::move(value));
  const JsonView view(is_list ? whole : value, path);
  std::vector<Scenario> out;
  for (std::size_t i = 0; i < view.count("scenarios"); ++i) {
    const JsonView from = view.element("scenarios", i, "scenario");
    Scenario& s = out.emplace_back();
    s.name = from.text("name"), s.model = from.text("model");
    s.environment = from.text("environment", from.text("lighting"));
    if (s.name.empty() || s.model.empty() || s.environment.empty())
      from.fail("needs a name, a model and an environment");
    const JsonView orbit = from.object("orbit"), target = from.object("target");
    s.theta = orbit.number("theta", 0.0f), s.phi = orbit.number("phi", 90.0f), s.radius = orbit.number("radius", 1.0f);
    s.target = {target.number("x", 0.0f), target.number("y", 0.0f), target.number("z", 0.0f)};
    s.view_angle = from.number("verticalFoV", 45.0f);
    s.has_background = from.flag("renderSkybox", false);
  }
  return out;
}

double yiq_decibels(const metrics::Picture& reference, const metrics::Picture& test) {
  const std::vector<metrics::Choice> metric = {metrics::choose_metric(metrics::metrics(), "yiq_rms:empty=1")};
  const metrics::Comparands pictures{
      .count = 1, .reference = [&](std::size_t) { return reference; }, .test = [&](std::size_t) { return test; }};
  return metrics::compare(pictures, metric, metrics::Unfit::Refuse).results.at(0).value;
}

/// The intersection of what two images cover over the union.
double alpha_overlap(const metrics::Picture& a, const metrics::Picture& b) {
  double both = 0, either = 0;
  for (int y = 0; y < a.display.height(); ++y)
    for (int x = 0; x < a.display.width(); ++x) {
      const double p = a.display(x, y).a, q = b.display(x, y).a;
      both += std::min(p, q), either += std::max(p, q);
    }
  return either > 0 ? both / either : 1;
}

double median_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

/// How a rendered image compares with those of the peers, and they with each other.
struct Verdict {
  std::string nearest;
  double decibels = 0, median = 0, bound = 0, overlap = 0;
  bool is_good() const { return decibels <= bound && overlap >= least_overlap; }
  static constexpr double least_overlap = 0.995, always_good = -24, margin = 2;
};

Verdict judge(const metrics::Picture& ours, const std::map<std::string, metrics::Picture>& peers) {
  Verdict v;
  v.decibels = 1e300;
  for (const auto& [name, peer] : peers) {
    const double decibels = yiq_decibels(peer, ours);
    if (decibels < v.decibels) v.decibels = decibels, v.nearest = name;
    v.overlap = std::max(v.overlap, alpha_overlap(peer, ours));
  }
  std::vector<double> among_peers;
  for (const auto& [name, test] : peers)
    for (const auto& [other, reference] : peers)
      if (name != other) among_peers.push_back(yiq_decibels(reference, test));
  v.median = among_peers.empty() ? Verdict::always_good : median_of(among_peers);
  v.bound = std::max(Verdict::always_good, v.median + Verdict::margin);
  return v;
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

/// Reads the scenarios in a confined process.
std::vector<Scenario> confined_scenarios(const FidelityArgs& args, const std::string& file) {
  const std::vector<std::uint8_t> bytes = run_confined(confined_run(args, file, {file}), [&](Delivery& out) {
    std::vector<Scenario> scenarios;
    out.read(file, [&] { scenarios = read_scenarios(file, out.limits()); });
    Packer packer;
    packer.value(std::uint64_t{scenarios.size()});
    for (const Scenario& s : scenarios) {
      packer.text(s.name), packer.text(s.model), packer.text(s.environment);
      packer.value(s.theta), packer.value(s.phi), packer.value(s.radius), packer.value(s.target);
      packer.value(s.view_angle), packer.value(std::uint8_t{s.has_background});
    }
    out.set_result(std::move(packer).bytes());
  });
  Unpacker unpacker(bytes);
  std::vector<Scenario> scenarios;
  for (auto n = unpacker.value<std::uint64_t>(); n > 0; --n) {
    Scenario& s = scenarios.emplace_back();
    s.name = unpacker.text(), s.model = unpacker.text(), s.environment = unpacker.text();
    s.theta = unpacker.value<float>(), s.phi = unpacker.value<float>(), s.radius = unpacker.value<float>();
    s.target = unpacker.value<float3>(), s.view_angle = unpacker.value<float>();
    s.has_background = unpacker.value<std::uint8_t>() != 0;
  }
  return scenarios;
}

metrics::Picture load_image(const std::string& path, Delivery& out) {
  metrics::Picture picture;
  out.read(path, [&] { picture = metrics::load_picture(path, out.limits().pixels); });
  out.warn_of_flaw(picture.flaw), out.warn_of_flaw(picture.color_flaw);
  return picture;
}

/// The size of an image as it is shown, which a confined process reads: from the header if it states that.
int2 confined_size(const FidelityArgs& args, const std::string& image) {
  const std::vector<std::uint8_t> bytes = run_confined(confined_run(args, image, {image}), [&](Delivery& out) {
    std::optional<int2> size;
    out.read(image, [&] {
      const FileBytes file(image, out.limits().memory);
      // The headers of TIFF, AVIF and JPEG XL state no orientation that would be read without the library.
      if (!find_system_format(file.bytes())) size = find_image_size(file.bytes());
      if (size && swaps_sides(read_file_color(file.bytes()).orientation)) std::swap(size->x, size->y);
    });
    if (!size) {
      const metrics::Picture picture = load_image(image, out);
      size = {picture.width(), picture.height()};
    }
    Packer packer;
    packer.value(*size);
    out.set_result(std::move(packer).bytes());
  });
  const int2 size = Unpacker(bytes).value<int2>();
  if (size.x < 1 || size.y < 1) throw Error(ErrorKind::Input, image + ": has no pixels");
  return size;
}

/// Compares the rendered image with those of the peers, in a confined process.
Verdict confined_verdict(const FidelityArgs& args, const std::string& output,
                         const std::map<std::string, std::string>& peers) {
  std::vector<std::string> readable{output};
  for (const auto& [name, image] : peers) readable.push_back(image);
  const std::vector<std::uint8_t> bytes = run_confined(confined_run(args, output, readable), [&](Delivery& out) {
    std::map<std::string, metrics::Picture> pictures;
    for (const auto& [name, image] : peers) pictures.emplace(name, load_image(image, out));
    const Verdict v = judge(load_image(output, out), pictures);
    Packer packer;
    packer.text(v.nearest);
    packer.value(v.decibels), packer.value(v.median), packer.value(v.bound), packer.value(v.overlap);
    out.set_result(std::move(packer).bytes());
  });
  Unpacker unpacker(bytes);
  Verdict v{.nearest = unpacker.text()};
  v.decibels = unpacker.value<double>(), v.median = unpacker.value<double>(), v.bound = unpacker.value<double>();
  v.overlap = unpacker.value<double>();
  return v;
}

/// Renders a scenario as `zoneplate render` does, and compares it.
Verdict verdict_of(const FidelityArgs& args, const std::string& file, Scenario scenario) {
  if (scenario.name.find('/') != std::string::npos || scenario.name == "." || scenario.name == "..")
    throw Error(ErrorKind::Input,
                fmt::format("{}: scenario '{}': its name is not that of a file", file, scenario.name));
  const std::map<std::string, std::string> peers = peer_files(args, file, scenario);
  scenario.size = confined_size(args, peers.begin()->second);
  const std::string output = (fs::path(args.output) / (scenario.name + ".png")).string();
  std::optional<RenderArgs> render =
      parse_render_args(render_arguments(scenario, args, find_root(args, file, scenario), output));
  render->progress = ProgressKind::None;
  render->load.limits = args.limits.load;
  render->max_seconds = args.limits.seconds, render->is_sandboxed = args.limits.is_sandboxed;
  RenderItems({*render}).next();
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
    Verdict v;
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
