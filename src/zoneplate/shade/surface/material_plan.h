// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "zoneplate/scene/scene.h"
#include "zoneplate/shade/reflection/exponent.h"
#include "zoneplate/shade/surface/shading.h"
#include "zoneplate/shade/surface/surface.h"
#include "zoneplate/shade/surface/vertices.h"
#include "zoneplate/shade/texture/filtering.h"
#include "zoneplate/shade/texture/texture.h"

namespace zoneplate {

struct LayeredPlan;

/// The textures of a scene's materials. An image that is used both as colour and as data makes two textures.
class TextureSet {
 public:
  /// Makes the mip levels of the images that materials use, one image after the other. With `raw_colors` the encoded
  /// values of colours are taken as linear; images that are linear already stay as they are. Borders and the kept
  /// coverage are those of the first material that uses the image.
  /// Errors    ErrorKind::Input where an image that is used is empty; OutOfMemory("texture levels").
  TextureSet(const Scene& scene, const MipOptions& mips);
  /// The same, and frees the images: each as soon as its texels are copied to the levels, unused images at once.
  /// Afterwards all images of the scene are empty, and only this set can texture the scene.
  static TextureSet take(Scene& scene, const MipOptions& mips);

  /// Null where the use names no image.
  const Texture* find(const TextureUse& use, TexelMeaning meaning) const;

 private:
  using Key = std::pair<int, TexelMeaning>;
  explicit TextureSet(const MipOptions& mips) : mips_(mips) {}
  void collect_uses(const Scene& scene);
  Key key_of(int image, TexelMeaning meaning) const;

  struct Entry {
    LevelOptions options;
    std::unique_ptr<Texture> texture;
  };

  MipOptions mips_;
  std::vector<bool> is_light_;  ///< by image
  std::map<Key, Entry> textures_;
};

/// One texture of a material. `texture` null: absent.
struct TextureSlot {
  const Texture* texture = nullptr;
  SamplerState filtering;
  CoordinateMap map;
  bool is_mapped = false;  ///< the map is not the identity
  int uv_set = 0;
};

/// The coordinate map of a texture use: scale, then rotation u' = cos u + sin v, v' = cos v - sin u, then offset
/// (KHR_texture_transform).
CoordinateMap coordinate_map(const TextureUse& use);

/// Whether two slots look up the same texels with the same weights.
bool share_taps(const TextureSlot& a, const TextureSlot& b);

/// The decisions that are made once for a material: which stages shade its fragments, with which constants.
struct MaterialPlan {
  ShadingModel model = ShadingModel::Unlit;
  AlphaMode alpha_mode = AlphaMode::Opaque;
  std::array<TextureSlot, texture_slot_count> slots;  ///< by TextureSlotIndex
  const TextureSlot& slot(TextureSlotIndex index) const { return slots[static_cast<std::size_t>(index)]; }
  TextureSlot& slot(TextureSlotIndex index) { return slots[static_cast<std::size_t>(index)]; }

  std::shared_ptr<const LayeredPlan> layers;  ///< null: none
  SolidTexture solid_texture;
  float factor[4] = {1, 1, 1, 1};
  float metallic = 1, roughness = 1;
  float emissive_factor[3] = {0, 0, 0};
  float normal_scale = 1, occlusion_strength = 1;
  float specular[3] = {0, 0, 0};
  Exponent exponent;

  // (Blinn-)Phong's ambient term by channel: a multiple of the base colour, or, where the base colour's factor is too
  // small to divide by, a term that is added like emission.
  float ambient_factor[3] = {0, 0, 0};  ///< times the base colour
  float own_ambient[3] = {0, 0, 0};     ///< times the base colour without its factor
  bool has_own_ambient = false;

  // Heights: the normal's tilt, and the coordinates' displacement.
  float height_scale = 0;
  int parallax_layers = 0;
  bool has_bumps = false;

  // Specular antialiasing.
  bool widens_by_curvature = false;
  const TextureView* normal_spread = nullptr;  ///< Texture::normal_spread, where the material is widened by it
  bool has_slope_variance = false;             ///< by the variances of slopes, else by the length of the mean normal
  /// The lobes of lights are widened along each direction by itself; those of layers by the mean over all directions.
  bool has_turning_lobes() const { return layers == nullptr && (widens_by_curvature || has_slope_variance); }
  bool widens() const { return widens_by_curvature || normal_spread != nullptr; }

  bool is_lit = false;        ///< lights or an environment change its colour
  bool has_specular = false;  ///< (Blinn-)Phong
  bool has_emissive = false;
  bool has_bare_meshes = false;  ///< some of its meshes have no normals
  bool has_meshes_without_tangents = false;
  bool needs_viewer = false;  ///< for the colour
  Attributes attributes;      ///< for the colour
};

/// The plans of a scene's materials, by material.
std::vector<MaterialPlan> make_plans(const Scene& scene, const ViewUniforms& view, const TextureSet& textures);

}  // namespace zoneplate
