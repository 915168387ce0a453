// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/fidelity.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/inspect/color_space.h"
#include "zoneplate/codec/system/system_format.h"
#include "zoneplate/formats/import/image_file.h"
#include "zoneplate/formats/json/json.h"
#include "zoneplate/image/orientation.h"
#include "zoneplate/metrics/compare.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/metrics/metrics.h"
#include "zoneplate/os/file.h"
#include "zoneplate/process/packed.h"

namespace zoneplate {
namespace {

/// The list of the file: a JSON array, or the member "scenarios" of an object.
std::vector<Scenario> scenarios_in(const std::string& path, const LoadLimits& limits) {
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

FidelityVerdict verdict_of(const metrics::Picture& ours, const std::map<std::string, metrics::Picture>& peers) {
  FidelityVerdict v;
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
  v.median = among_peers.empty() ? FidelityVerdict::always_good : median_of(among_peers);
  v.bound = std::max(FidelityVerdict::always_good, v.median + FidelityVerdict::margin);
  return v;
}

metrics::Picture load_image(const std::string& path, Delivery& out) {
  metrics::Picture picture;
  out.read(path, [&] { picture = metrics::load_picture(path, out.limits().pixels); });
  out.warn_of_flaw(picture.flaw), out.warn_of_flaw(picture.color_flaw);
  return picture;
}

}  // namespace

void read_scenarios(const std::string& file, Delivery& out) {
  std::vector<Scenario> scenarios;
  out.read(file, [&] { scenarios = scenarios_in(file, out.limits()); });
  Packer packer;
  packer.value(std::uint64_t{scenarios.size()});
  for (const Scenario& s : scenarios) {
    packer.text(s.name), packer.text(s.model), packer.text(s.environment);
    packer.value(s.theta), packer.value(s.phi), packer.value(s.radius), packer.value(s.target);
    packer.value(s.view_angle), packer.value(std::uint8_t{s.has_background});
  }
  out.set_result(std::move(packer).bytes());
}

std::vector<Scenario> unpack_scenarios(std::span<const std::uint8_t> bytes) {
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

void read_shown_size(const std::string& image, Delivery& out) {
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
}

int2 unpack_size(std::span<const std::uint8_t> bytes) { return Unpacker(bytes).value<int2>(); }

void judge_fidelity(const std::string& output, const std::map<std::string, std::string>& peers, Delivery& out) {
  std::map<std::string, metrics::Picture> pictures;
  for (const auto& [name, image] : peers) pictures.emplace(name, load_image(image, out));
  const FidelityVerdict v = verdict_of(load_image(output, out), pictures);
  Packer packer;
  packer.text(v.nearest);
  packer.value(v.decibels), packer.value(v.median), packer.value(v.bound), packer.value(v.overlap);
  out.set_result(std::move(packer).bytes());
}

FidelityVerdict unpack_verdict(std::span<const std::uint8_t> bytes) {
  Unpacker unpacker(bytes);
  FidelityVerdict v{.nearest = unpacker.text()};
  v.decibels = unpacker.value<double>(), v.median = unpacker.value<double>(), v.bound = unpacker.value<double>();
  v.overlap = unpacker.value<double>();
  return v;
}

}  // namespace zoneplate
