// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/option/view_args.h"

#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/base/error.h"
#include "zoneplate/base/spec.h"
#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/formats/json/json.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/math/double3.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

struct NamedDirection {
  std::string_view name;
  double azimuth, elevation;  ///< degrees
};
// iso: all three axes are equally long in a parallel projection, at an elevation of atan(1/√2).
constexpr NamedDirection directions[] = {{"front", 0, 0}, {"right", 90, 0},   {"back", 180, 0},     {"left", -90, 0},
                                         {"top", 0, 90},  {"bottom", 0, -90}, {"iso", 45, 35.26439}};

/// The velocity of a member at key i.
double3 velocity(const std::vector<KeyView>& keys, std::size_t i, double3 KeyView::*member) {
  const KeyView &before = keys[i > 0 ? i - 1 : 0], &after = keys[std::min(i + 1, keys.size() - 1)];
  return (after.*member - before.*member) * (1 / (after.time - before.time));
}

/// The place on the curve of a member, at part `t` of the way from key i to the next one.
double3 on_curve(const std::vector<KeyView>& keys, std::size_t i, double t, double3 KeyView::*member) {
  const double span = keys[i + 1].time - keys[i].time, s = 1 - t;
  const double3 from = keys[i].*member, to = keys[i + 1].*member;
  return from * (s * s * (1 + 2 * t)) + to * (t * t * (3 - 2 * t)) + velocity(keys, i, member) * (span * t * s * s) -
         velocity(keys, i + 1, member) * (span * t * t * s);
}

}  // namespace

std::vector<std::string_view> view_names() {
  std::vector<std::string_view> names;
  for (const NamedDirection& row : directions) names.push_back(row.name);
  return names;
}

std::vector<ViewDirection> parse_views(const std::string& text) {
  std::vector<ViewDirection> out;
  for (const std::string& name : split_list(text)) {
    const auto row = std::ranges::find(directions, name, &NamedDirection::name);
    if (row == std::end(directions)) refuse_name("view", name, view_names());
    out.push_back({radians_of(row->azimuth), radians_of(row->elevation)});
  }
  return out;
}

View KeyedViews::at(double time, View base) const {
  std::size_t i = 0;
  while (i + 1 < keys.size() && keys[i + 1].time <= time) ++i;
  const bool is_moving = i + 1 < keys.size() && time > keys[i].time;
  const KeyView &key = keys[i], &next = keys[is_moving ? i + 1 : i];
  const double t = is_moving ? (time - key.time) / (next.time - key.time) : 0;
  View view = std::move(base);
  view.index.reset(), view.azimuth.reset(), view.elevation.reset();
  view.position = is_moving ? on_curve(keys, i, t, &KeyView::position) : key.position;
  view.focal_point = is_moving ? on_curve(keys, i, t, &KeyView::focal_point) : key.focal_point;
  const auto s = static_cast<float>(t);
  if (key.view_up && next.view_up) view.view_up = *key.view_up + (*next.view_up - *key.view_up) * s;
  if (key.view_angle && next.view_angle) view.view_angle = *key.view_angle + (*next.view_angle - *key.view_angle) * s;
  return view;
}

KeyedViews read_camera_path(const std::string& path) {
  constexpr std::uint64_t max_bytes = 1 << 26;
  const FileBytes file(path, max_bytes);
  LoadLimits limits;
  ImportBudget budget(path, limits);
  const JsonValue value = parse_json(file.bytes(), budget);
  const JsonView root(value, path);
  KeyedViews out;
  const auto triple = [](const JsonView& key, const char* name) {
    const std::vector<double> v = key.doubles(name, 3);
    if (v.empty()) key.fail(fmt::format("has no {}", name));
    return double3{v[0], v[1], v[2]};
  };
  for (std::size_t i = 0; i < root.count("keys"); ++i) {
    const JsonView key = root.element("keys", i, "key");
    const std::vector<float> up = key.numbers("view_up", 3);
    KeyView view{.time = static_cast<double>(key.number("time")),
                 .position = triple(key, "position"),
                 .focal_point = triple(key, "focal_point")};
    if (!up.empty()) view.view_up = float3{up[0], up[1], up[2]};
    if (key.has("view_angle")) {
      const float degrees = key.number("view_angle");
      if (!(degrees >= 0.01f && degrees <= 179)) key.fail("has a view_angle outside 0.01 to 179");
      view.view_angle = radians_of(static_cast<double>(degrees));
    }
    if (view.position == view.focal_point) key.fail("has the same position and focal_point");
    if (!out.keys.empty() && !(view.time > out.keys.back().time)) key.fail("is not later than the key before");
    out.keys.push_back(view);
  }
  if (out.keys.empty()) root.fail("has no keys");
  return out;
}

}  // namespace zoneplate
