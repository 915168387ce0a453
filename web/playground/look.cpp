// SPDX-License-Identifier: Apache-2.0
#include "look.h"

#include <string>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/math/elementary.h"

namespace zoneplate {

std::span<const Param> look_params() {
  static const std::vector<std::string_view> filters = [] {
    std::vector<std::string_view> names = {"sampler"};
    for (const TextureFilterEntry& filter : texture_filters()) names.push_back(filter.name);
    return names;
  }();
  static constexpr std::string_view visibilities[] = {"z-buffer", "painter"};
  static constexpr std::string_view edge_rules[] = {"top-left", "inside"};
  static constexpr std::string_view frequencies[] = {"flat", "gouraud", "phong"};
  static constexpr std::string_view specular[] = {"none", "geometric", "toksvig", "lean", "full"};
  static constexpr std::string_view shadows[] = {"none", "map", "hard", "soft"};
  static constexpr std::string_view occlusions[] = {"none", "rays"};
  static constexpr std::string_view grounds[] = {"none", "shadow"};
  static constexpr std::string_view backgrounds[] = {"colour", "environment"};
  static constexpr std::string_view curves[] = {"default", "none", "aces", "neutral", "agx", "filmic"};
  static const Param params[] = {
      {.name = "visibility",
       .meaning = "hidden-surface removal: by the depth of each sample, or triangles sorted back to front",
       .names = visibilities},
      {.name = "edge-rule", .meaning = "inside: every triangle includes its edges", .names = edge_rules},
      {.name = "shading-frequency",
       .meaning = "where lights are evaluated: once for each triangle, at vertices, or at every fragment",
       .value = 2,
       .names = frequencies},
      {.name = "texture-filter", .meaning = "of all textures, in place of the scene's own", .names = filters},
      {.name = "anisotropy",
       .meaning = "maximum anisotropy of texture filters; 0: 4, or the own value of a built-in scene",
       .low = 0,
       .high = 16},
      {.name = "specular-aa",
       .meaning = "highlights are widened by the normals' variance in a pixel",
       .names = specular},
      {.name = "shadows",
       .meaning = "of the lights: a depth image, one ray, or 32 rays to an extended light",
       .names = shadows},
      {.name = "ambient-occlusion", .meaning = "what hides the environment's light: 32 rays", .names = occlusions},
      {.name = "ground", .meaning = "a plane that displays the shadows on it; requires shadows", .names = grounds},
      {.name = "background", .meaning = "of the image: one colour, or the light's own image", .names = backgrounds},
      {.name = "tone-mapping",
       .meaning = "curve from light to the display; default: neutral in the studio, else none",
       .names = curves},
      {.name = "exposure", .meaning = "in stops: each doubles the brightness", .low = -8, .high = 8, .decimals = 2},
  };
  return params;
}

void set_look(std::string_view text, RenderOptions& options) {
  const Settings settings("option", look_params(), text);
  options.visibility = settings.integer("visibility") == 0 ? Visibility::ZBuffer : Visibility::Painter;
  options.edge_rule = settings.integer("edge-rule") == 0 ? EdgeRule::TopLeft : EdgeRule::Inside;
  options.shading_frequency = static_cast<ShadingFrequency>(settings.integer("shading-frequency"));
  if (const std::string_view filter = settings.chosen("texture-filter"); filter != "sampler")
    options.texture_filter = parse_texture_filter(filter);
  if (const int most = settings.integer("anisotropy"); most > 0) options.anisotropy = most;
  options.specular_aa = static_cast<SpecularAntialiasing>(settings.integer("specular-aa"));
  options.shadows.method = static_cast<ShadowMethod>(settings.integer("shadows"));
  options.occlusion.samples = settings.integer("ambient-occlusion") == 0 ? 0 : 32;
  options.ground = settings.integer("ground") == 0 ? GroundKind::None : GroundKind::Shadow;
  if (options.ground == GroundKind::Shadow && !has_visibility(options))
    throw Error(ErrorKind::Usage, "ground=shadow requires shadows or ambient-occlusion");
  if (settings.integer("background") == 1) options.background.emplace();
  if (const int curve = settings.integer("tone-mapping"); curve > 0)
    options.display.mapping = static_cast<ToneMapping>(curve - 1);
  options.display.exposure = exp2(static_cast<float>(settings.number("exposure")));
}

}  // namespace zoneplate
