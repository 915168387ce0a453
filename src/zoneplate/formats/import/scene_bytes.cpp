// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/import/scene_bytes.h"

#include <memory>
#include <optional>
#include <type_traits>

#include "zoneplate/base/large_array.h"
#include "zoneplate/scene/material_layers.h"
#include "zoneplate/scene/validate.h"

namespace zoneplate {
namespace {

/// Writer and reader traverse the scene with the same function (`pass`); they differ in the operations on its leaves.
class Writer {
 public:
  explicit Writer(const ByteSink& sink) : sink_(sink) {}

  template <class T>
  void value(T& v) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_enum_v<T> && !std::is_same_v<T, bool>);
    sink_(&v, sizeof v);
  }
  void choice(bool& b) {
    std::uint8_t v = b;
    value(v);
  }
  template <class Enum>
  void choice(Enum& e, Enum) {
    auto v = static_cast<std::uint8_t>(e);
    value(v);
  }
  template <class T>
  void values(std::vector<T>& list) {
    std::uint64_t n = list.size();
    value(n);
    if (n > 0) sink_(list.data(), list.size() * sizeof(T));
  }
  void text(std::string& t) {
    std::uint64_t n = t.size();
    value(n);
    if (n > 0) sink_(t.data(), t.size());
  }
  void image(TexelImage& pixels) {
    TexelKind kind = pixels.kind();
    choice(kind, TexelKind::Light);
    pixels.visit([&](const auto& plane) {
      std::int32_t size[2] = {plane.width(), plane.height()};
      value(size);
      sink_(plane.values().data(), plane.values().size_bytes());
    });
  }
  void optional(std::optional<float>& number) {
    bool is_given = number.has_value();
    choice(is_given);
    if (is_given) value(*number);
  }
  template <class T, class Each>
  void shared(std::shared_ptr<const T>& item, Each each) {
    bool is_given = item != nullptr;
    choice(is_given);
    if (!is_given) return;
    T copy = *item;
    each(copy);
  }
  template <class T, class Each>
  void list(std::vector<T>& items, Each each) {
    std::uint64_t n = items.size();
    value(n);
    for (T& item : items) each(item);
  }
  void names(NameList& names) {
    std::vector<std::string> texts = names.texts();
    std::vector<std::uint32_t> text_of = names.text_of();
    list(texts, [&](std::string& t) { text(t); });
    values(text_of);
  }

 private:
  const ByteSink& sink_;
};

class Reader {
 public:
  Reader(const ByteSource& source, ImportBudget& budget) : source_(source), budget_(budget) {}

  template <class T>
  void value(T& v) {
    static_assert(std::is_trivially_copyable_v<T> && !std::is_enum_v<T> && !std::is_same_v<T, bool>);
    source_(&v, sizeof v);
  }
  void choice(bool& b) {
    std::uint8_t v = 0;
    value(v);
    b = v != 0;
  }
  template <class Enum>
  void choice(Enum& e, Enum last) {
    std::uint8_t v = 0;
    value(v);
    if (v > static_cast<std::uint8_t>(last)) fail("an enumerator out of range");
    e = static_cast<Enum>(v);
  }
  template <class T>
  void values(std::vector<T>& list) {
    make_large(list, counted(sizeof(T)));
    if (!list.empty()) source_(list.data(), list.size() * sizeof(T));
  }
  void text(std::string& t) {
    t.resize(counted(1));
    if (!t.empty()) source_(t.data(), t.size());
  }
  void image(TexelImage& pixels) {
    TexelKind kind{};
    choice(kind, TexelKind::Light);
    if (kind == TexelKind::Codes8)
      pixels = plane<Rgba8>();
    else if (kind == TexelKind::Codes16)
      pixels = plane<Rgba16>();
    else
      pixels = plane<float4>();
  }
  void optional(std::optional<float>& number) {
    bool is_given = false;
    choice(is_given);
    if (is_given) value(number.emplace());
  }
  template <class T, class Each>
  void shared(std::shared_ptr<const T>& item, Each each) {
    bool is_given = false;
    choice(is_given);
    if (!is_given) return;
    budget_.take(sizeof(T));
    T read;
    each(read);
    item = std::make_shared<const T>(read);
  }
  template <class T, class Each>
  void list(std::vector<T>& items, Each each) {
    // Elements are read one by one, so that a false count fails at the end of the bytes and does not allocate memory.
    std::uint64_t n = 0;
    for (value(n); n > 0; --n) {
      constexpr std::uint64_t items_per_check = 256;
      if (n % items_per_check == 0) budget_.check_time();
      budget_.take(sizeof(T));
      each(items.emplace_back());
    }
  }
  void names(NameList& names) {
    std::vector<std::string> texts;
    std::vector<std::uint32_t> text_of;
    list(texts, [&](std::string& t) { text(t); });
    values(text_of);
    for (const std::uint32_t i : text_of)
      if (i >= texts.size()) fail("a name that is not there");
    names = NameList(std::move(texts), std::move(text_of));
  }

  [[noreturn]] void fail(const std::string& cause) const {
    throw Error(ErrorKind::Input, budget_.file() + ": its reader's answer is no scene: " + cause);
  }

 private:
  template <class Texel>
  Plane<Texel> plane() {
    std::int32_t size[2];
    value(size);
    if (size[0] < 0 || size[1] < 0) fail("an image of negative size");
    const std::uint64_t count = static_cast<std::uint64_t>(size[0]) * static_cast<std::uint64_t>(size[1]);
    if (count > budget_.limits().pixels) fail("an image of more pixels than the limit (--max-pixels)");
    budget_.take(count * sizeof(Texel));
    Plane<Texel> pixels(size[0], size[1]);
    source_(pixels.values().data(), pixels.values().size_bytes());
    return pixels;
  }

  std::size_t counted(std::size_t each) {
    std::uint64_t n = 0;
    value(n);
    budget_.take(n > ~std::uint64_t{0} / each ? ~std::uint64_t{0} : n * each);
    return static_cast<std::size_t>(n);
  }

  const ByteSource& source_;
  ImportBudget& budget_;
};

template <class S>
void pass(S& s, Mesh& m) {
  s.text(m.name), s.choice(m.topology, Topology::Points), s.value(m.material);
  s.values(m.position), s.values(m.normal), s.values(m.tangent), s.values(m.uv0), s.values(m.uv1), s.values(m.color);
  s.values(m.index);
}

template <class S>
void pass(S& s, TextureUse& t) {
  s.value(t.image), s.value(t.uv_set), s.value(t.offset), s.value(t.scale), s.value(t.rotation);
  s.choice(t.sampler.wrap_u, Wrap::Clamp), s.choice(t.sampler.wrap_v, Wrap::Clamp);
  s.choice(t.sampler.magnify, TexelFilter::Linear), s.choice(t.sampler.minify, TexelFilter::Linear);
  s.choice(t.sampler.level, LevelFilter::Linear), s.value(t.sampler.anisotropy);
}

template <class S>
void pass(S& s, MaterialLayers& l) {
  s.value(l.ior), s.value(l.specular), s.value(l.specular_color);
  s.value(l.clearcoat), s.value(l.clearcoat_roughness), s.value(l.clearcoat_normal_scale);
  s.value(l.sheen_color), s.value(l.sheen_roughness), s.value(l.anisotropy), s.value(l.anisotropy_rotation);
  s.value(l.iridescence), s.value(l.iridescence_ior), s.value(l.iridescence_thickness_minimum);
  s.value(l.iridescence_thickness_maximum), s.value(l.transmission), s.value(l.thickness);
  s.value(l.attenuation_distance), s.value(l.attenuation_color), s.value(l.dispersion);
  s.value(l.diffuse_transmission), s.value(l.diffuse_transmission_color);
  s.optional(l.glossiness);
  for (const LayerTextureSlot& slot : layer_texture_slots) pass(s, l.*slot.use);
}

template <class S>
void pass(S& s, SolidTexture& t) {
  s.choice(t.pattern, SolidPattern::Rock);
  s.value(t.scale), s.value(t.octaves), s.value(t.gain), s.value(t.distortion), s.choice(t.is_filtered), s.value(t.low),
      s.value(t.high);
}

template <class S>
void pass(S& s, Material& m) {
  s.text(m.name), s.choice(m.model, ShadingModel::Unlit), s.choice(m.alpha_mode, AlphaMode::Blend);
  s.value(m.alpha_cutoff), s.choice(m.double_sided), s.choice(m.is_default);
  s.value(m.base_color), s.value(m.emissive), s.value(m.normal_scale), s.value(m.occlusion_strength);
  s.value(m.metallic), s.value(m.roughness), s.value(m.ambient), s.value(m.specular), s.value(m.exponent);
  s.value(m.height_scale), s.value(m.parallax_layers);
  pass(s, m.solid_texture);
  for (const MaterialTextureSlot& slot : material_texture_slots) pass(s, m.*slot.use);
  s.shared(m.layers, [&](MaterialLayers& layers) { pass(s, layers); });
}

template <class S>
void pass(S& s, Light& l) {
  s.text(l.name), s.choice(l.kind, LightKind::Spot), s.choice(l.is_in_camera_space), s.value(l.color),
      s.value(l.intensity), s.value(l.position);
  s.value(l.direction), s.value(l.range), s.choice(l.falloff, Falloff::Quadratic), s.value(l.attenuation);
  s.value(l.inner_cone), s.value(l.outer_cone), s.value(l.radius);
}

template <class S>
void pass(S& s, Camera& c) {
  s.text(c.name), s.value(c.world_from_camera), s.choice(c.is_orthographic), s.value(c.vertical_fov);
  s.value(c.half_height), s.value(c.aspect), s.value(c.near), s.value(c.far);
}

template <class S>
void pass(S& s, Environment& e) {
  s.value(e.color), s.value(e.image), s.value(e.rotation), s.choice(e.is_in_camera_space), s.value(e.strength);
}

template <class S>
void pass(S& s, Scene& scene) {
  const auto text = [&](std::string& t) { s.text(t); };
  s.list(scene.meshes, [&](Mesh& m) { pass(s, m); });
  s.list(scene.instances,
         [&](Instance& i) { s.value(i.mesh), s.value(i.object), s.value(i.world_from_object), s.value(i.part); });
  s.names(scene.objects);
  s.list(scene.materials, [&](Material& m) { pass(s, m); });
  s.list(scene.images, [&](TextureImage& i) { s.text(i.name), s.image(i.pixels); });
  s.list(scene.lights, [&](Light& l) { pass(s, l); });
  s.list(scene.cameras, [&](Camera& c) { pass(s, c); });
  pass(s, scene.environment), s.value(scene.origin), s.value(scene.up), s.value(scene.ambient_light);
  s.choice(scene.needs_fill_light);
  s.list(scene.animations, [&](AnimationSpan& a) { s.text(a.name), s.value(a.begin), s.value(a.end); });
  s.list(scene.variants, text), s.list(scene.warnings, text);
}

}  // namespace

void write_scene(const Scene& scene, const ByteSink& sink) {
  Writer writer(sink);
  pass(writer, const_cast<Scene&>(scene));  // a Writer does not modify the scene
}

Scene read_scene(const ByteSource& source, ImportBudget& budget) {
  Scene scene;
  Reader reader(source, budget);
  pass(reader, scene);
  if (const auto flaw = find_invalid(scene)) reader.fail(*flaw);
  return scene;
}

}  // namespace zoneplate
