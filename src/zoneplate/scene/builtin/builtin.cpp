#include "zoneplate/scene/builtin/builtin.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <string_view>
#include <utility>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/scene/builtin/make.h"

namespace zoneplate {
namespace {

constexpr std::array makers = {builtin_teapot,         builtin_checkerboard, builtin_triangles,    builtin_cyclic,
                               builtin_crossing,       builtin_sphere,       builtin_wheel,        builtin_city,
                               builtin_city_trilinear, builtin_tri10k,       builtin_tri1m,        builtin_micro,
                               builtin_fill,           builtin_fillblend,    builtin_near_axis,    builtin_wires,
                               builtin_stars,          builtin_sun_roof,     builtin_foliage,      builtin_tiles,
                               builtin_metal,          builtin_text_ui,      builtin_thin_diagonal};

/// A parameter's value as it is written: 500 of three decimals is "0.5".
std::string shown(std::int64_t value, int decimals) {
  std::int64_t scale = 1;
  for (int i = 0; i < decimals; ++i) scale *= 10;
  return fmt::format("{}", static_cast<double>(value) / static_cast<double>(scale));
}

std::string list_of(std::span<const BuiltinParam> params) {
  std::string text;
  for (const BuiltinParam& p : params)
    text += fmt::format("{}{} ({}, {} to {})", text.empty() ? "" : ", ", p.name, p.meaning, shown(p.low, p.decimals),
                        shown(p.high, p.decimals));
  return text.empty() ? "no parameters" : text;
}

/// The text as a number of at most so many decimals; nothing if it is none.
std::optional<std::int64_t> parse_value(std::string_view text, int decimals) {
  const std::size_t point = decimals > 0 ? text.find('.') : std::string_view::npos;
  std::string digits(text.substr(0, point));
  const std::string_view fraction = point == std::string_view::npos ? std::string_view{} : text.substr(point + 1);
  if (fraction.size() > static_cast<std::size_t>(decimals)) return std::nullopt;
  digits.append(fraction).append(static_cast<std::size_t>(decimals) - fraction.size(), '0');

  std::int64_t value = 0;
  const auto [end, trouble] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool has_digit = text.find_first_of("0123456789") != std::string_view::npos;
  if (!has_digit || trouble != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return value;
}

/// Sets the value that `setting` (name=value) names.
void apply(const BuiltinMaker& maker, std::string_view setting, std::vector<std::int64_t>& values) {
  const std::size_t equals = setting.find('=');
  const std::string_view name = setting.substr(0, equals);
  const std::string_view value = equals == std::string_view::npos ? std::string_view{} : setting.substr(equals + 1);
  for (std::size_t i = 0; i < maker.params.size(); ++i) {
    const BuiltinParam& p = maker.params[i];
    if (name != p.name) continue;
    const std::optional<std::int64_t> number = parse_value(value, p.decimals);
    if (number && *number >= p.low && *number <= p.high) {
      values[i] = *number;
      return;
    }
    const std::string kind = p.decimals == 0 ? "whole number" : fmt::format("number of {} decimals", p.decimals);
    throw Error(ErrorKind::Usage, fmt::format("scene {}: {} is '{}', wants a {} from {} to {}", maker.name, p.name,
                                              value, kind, shown(p.low, p.decimals), shown(p.high, p.decimals)));
  }
  throw Error(ErrorKind::Usage,
              fmt::format("scene {}: unknown parameter '{}'; it has {}", maker.name, name, list_of(maker.params)));
}

/// A scene and the values of its parameters.
struct Choice {
  BuiltinMaker maker;
  std::vector<std::int64_t> values;
};

std::optional<Choice> find_choice(const std::string& text) {
  const std::size_t colon = text.find(':');
  for (const auto& maker_of : makers) {
    Choice choice{maker_of(), {}};
    if (text.compare(0, colon, choice.maker.name) != 0) continue;
    for (const BuiltinParam& p : choice.maker.params) choice.values.push_back(p.otherwise);
    std::string_view rest = colon == std::string::npos ? std::string_view{} : std::string_view(text).substr(colon + 1);
    for (bool more = colon != std::string::npos; more;) {
      const std::size_t comma = rest.find(',');
      apply(choice.maker, rest.substr(0, comma), choice.values);
      more = comma != std::string_view::npos;
      if (more) rest = rest.substr(comma + 1);
    }
    return choice;
  }
  return std::nullopt;
}

}  // namespace

std::span<const BuiltinScene> builtin_scenes() {
  static const std::vector<BuiltinScene> scenes = [] {
    std::vector<BuiltinScene> list;
    for (const auto& maker_of : makers) {
      const BuiltinMaker maker = maker_of();
      std::string params;
      for (const BuiltinParam& p : maker.params)
        params += fmt::format("{}{}={}", params.empty() ? "" : ",", p.name, shown(p.otherwise, p.decimals));
      list.push_back({maker.name, maker.summary, params, maker.failure, maker.complaint});
    }
    return list;
  }();
  return scenes;
}

const BuiltinScene* find_builtin_scene(std::string_view text) {
  for (const BuiltinScene& scene : builtin_scenes())
    if (scene.name == text.substr(0, text.find(':'))) return &scene;
  return nullptr;
}

bool check_builtin_scene(const std::string& text) { return find_choice(text).has_value(); }

std::optional<Scene> make_builtin_scene(const std::string& text) {
  const std::optional<Choice> choice = find_choice(text);
  if (!choice) return std::nullopt;
  return choice->maker.make(choice->values);
}

Camera camera_at(float3 eye, float3 target, float vertical_fov, float near, float far) {
  const float3 forward = normalize(target - eye), right = normalize(cross(forward, {0, 1, 0}));
  const float3 above = cross(right, forward);
  Camera camera;
  camera.name = "camera";
  camera.world_from_camera = {{float4{right.x, right.y, right.z, 0}, float4{above.x, above.y, above.z, 0},
                               float4{-forward.x, -forward.y, -forward.z, 0}, float4{eye.x, eye.y, eye.z, 1}}};
  camera.vertical_fov = vertical_fov;
  camera.near = near, camera.far = far;
  return camera;
}

void add_object(Scene& scene, const char* name, Mesh mesh) {
  mesh.name = name;
  scene.instances.push_back(
      {static_cast<int>(scene.meshes.size()), static_cast<int>(scene.objects.size()), float4x4{}});
  scene.objects.push_back(name);
  scene.meshes.push_back(std::move(mesh));
}

}  // namespace zoneplate
