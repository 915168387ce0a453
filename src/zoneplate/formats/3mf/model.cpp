// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/3mf/model.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <utility>

#include "zoneplate/formats/3mf/values.h"

namespace zoneplate {
namespace {

using namespace model_3mf;

constexpr std::string_view core_space = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
constexpr std::string_view material_space = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02";
constexpr std::string_view production_space = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";

/// Extensions whose content is ignored: a part of the URI, an element, and what to call it.
struct Ignored {
  std::string_view space, element, text;
};
constexpr Ignored ignored_extensions[] = {
    {"/beamlattice/", "beamlattice", "beam lattices (of the beam lattice extension) are not drawn"},
    {"/slice/", "slicestack", "slices (of the slice extension) are not drawn"},
    {"/displacement/", "displacementmesh", "displaced meshes (of the displacement extension) are not drawn"},
    {"/booleanoperations/", "booleanshape", "boolean shapes (of the boolean operations extension) are not drawn"},
    {"/volumetric/", "volumedata", "volumes (of the volumetric extension) are not drawn"},
    {"/implicit/", "implicitfunction", "implicit functions (of the implicit extension) are not drawn"},
    {"/volumetric/", "levelset", "level sets (of the volumetric extension) are not drawn"}};

constexpr bool is_known(std::string_view space) {
  return space == core_space || space == material_space || space == production_space ||
         space.find("/trianglesets/") != std::string_view::npos;  // names for groups of triangles
}

Wrap wrap_of(std::optional<std::string_view> style) {
  // "none" shows what is below; for a texture that is not on another layer the specification takes it as "clamp".
  return style == "mirror" ? Wrap::Mirror : style == "clamp" || style == "none" ? Wrap::Clamp : Wrap::Repeat;
}

/// A layer of multiproperties over what is accumulated below it.
float4 mixed(float4 below, float4 above) {
  const float3 rgb = xyz(above) * above.w + xyz(below) * (1 - above.w);
  return {rgb.x, rgb.y, rgb.z, above.w + below.w * (1 - above.w)};
}

constexpr float4 white{1, 1, 1, 1};

std::string no_property(std::uint32_t group, std::uint32_t index) {
  return fmt::format("property {} of group {} is not there: it is left out", index, group);
}

void forget_places(Object& object, ImportBudget& budget) {
  budget.give_back(object.far.place.capacity() * sizeof(double3));
  object.far = {};
}

/// Rounds the vertices of an object far from its own origin again, relative to its centre. Vertices that no triangle
/// has do not count.
void center_far(Object& object, ImportBudget& budget) {
  OriginChoice choice;
  if (!object.far.place.empty())
    choice.add_used(object.triangles, [&](std::uint32_t vertex) { return object.far.place[vertex]; });
  const double3 centre = choice.origin();
  if (centre != double3{}) {
    for (std::size_t i = 0; i < object.position.size(); ++i)
      object.position[i] = relative_to(centre, object.far.place[i]);
    object.centre = centre;
  }
  forget_places(object, budget);
}

void drop_invalid(Object& object, std::uint32_t id, FlawList& flaws, ImportBudget& budget) {
  std::vector<std::uint32_t>& triangles = object.triangles;
  const std::size_t count = triangles.size() / 3;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < count; ++t) {
    constexpr std::size_t triangles_per_check = 1 << 16;
    if (t % triangles_per_check == 0) budget.check_time();
    const std::uint32_t* const v = &triangles[3 * t];
    const std::uint32_t* const stray =
        std::find_if(v, v + 3, [&](std::uint32_t i) { return i >= object.position.size(); });
    if (stray != v + 3) {
      flaws.add(Flaw::Vertex, [&] {
        return *stray == none ? fmt::format("object {}, triangle {}: a corner is no number: it is dropped", id, t)
                              : fmt::format("object {}, triangle {} uses vertex {}, there are {}: it is dropped", id, t,
                                            *stray, object.position.size());
      });
    } else if (!std::all_of(v, v + 3, [&](std::uint32_t i) { return is_finite(object.position[i]); })) {
      flaws.add(Flaw::NotFinite, [&] {
        return fmt::format("object {}, triangle {}: a vertex is not finite or no number: it is dropped", id, t);
      });
    } else {
      std::copy_n(v, 3, &triangles[3 * kept]);
      if (!object.properties.empty()) object.properties[kept] = object.properties[t];
      ++kept;
    }
  }
  triangles.resize(3 * kept);
  if (!object.properties.empty()) object.properties.resize(kept);
  for (float3& p : object.position)
    if (!is_finite(p)) p = {0, 0, 0};  // no triangle has it
}

}  // namespace

void model_3mf::append_vertex(Object& object, const std::array<std::string_view, 3>& coordinates, double unit,
                              ImportBudget& budget) {
  constexpr std::size_t vertices_per_decision = 256;
  constexpr int near_blocks = 2;  // one may be so by a single vertex at 0, which nothing uses
  const auto& [x, y, z] = coordinates;
  append_charged(object.position, float3{number_of(x), number_of(y), number_of(z)} * static_cast<float>(unit), budget);
  FarPlaces& far = object.far;
  if (far.is_near) return;
  append_charged(far.place, double3{double_of(x) * unit, double_of(y) * unit, double_of(z) * unit}, budget);
  far.choice.add(far.place.back());
  if (far.place.size() % vertices_per_decision != 0) return;
  const bool is_near = std::exchange(far.choice, {}).is_near();
  if (!is_near || ++far.near_blocks < near_blocks) return;
  forget_places(object, budget);
  far.is_near = true;
}

void model_3mf::finish_objects(Model& model, FlawList& flaws, ImportBudget& budget) {
  for (auto& [id, object] : model.objects) {
    drop_invalid(object, id, flaws, budget);
    center_far(object, budget);
  }
}

std::string model_3mf::rest_is_left_out(std::uint32_t inner, const Object& outer) {
  return fmt::format("object {} is inside {}: what follows it there is left out", inner, outer.name);
}

ModelParser3mf::ModelParser3mf(Model& model, FlawList& flaws, ImportBudget& budget)
    : model_(model), flaws_(flaws), budget_(budget) {}

void ModelParser3mf::declare(std::string_view prefix, std::string_view uri) {
  if (spaces_.contains(prefix)) return;
  budget_.take(prefix.size() + uri.size() + 128);
  spaces_.emplace(prefix, uri);
}

void ModelParser3mf::begin(const XmlElement& element) {
  const std::string_view space = element.name.space;
  if (space == core_space || space.empty())
    begin_core(element);
  else if (space == material_space)
    begin_material(element);
  else
    ignore_extension(element.name);
}

void ModelParser3mf::end(const XmlName& name) {
  if (name.space != core_space && name.space != material_space && !name.space.empty()) return;
  if (name.local == "object") object_ = nullptr;
  if (name.local == "colorgroup" || name.local == "basematerials" || name.local == "texture2dgroup" ||
      name.local == "compositematerials" || name.local == "multiproperties")
    group_ = nullptr;
}

void ModelParser3mf::begin_core(const XmlElement& element) {
  const std::string_view name = element.name.local;
  if (name == "vertex") return add_vertex(element);
  if (name == "triangle") return add_triangle(element);
  if (name == "model") return begin_model(element);
  if (name == "object") return begin_object(element);
  if (name == "base") return add_base(element);
  if (name == "basematerials") {
    begin_group(element, GroupKind::Base);
  } else if (name == "component" && object_ != nullptr) {
    append_charged(object_->components, placement_of(element), budget_);
  } else if (name == "item") {
    append_charged(model_.items, placement_of(element), budget_);
  } else {
    begin_material(element);  // some files, those of the 3MF Consortium among them, leave out the prefix
  }
}

void ModelParser3mf::begin_material(const XmlElement& element) {
  const std::string_view name = element.name.local;
  if (name == "color" && is_within(GroupKind::Color)) {
    append_charged(group_->color, color_of(element, "color"), budget_);
  } else if (name == "colorgroup") {
    begin_group(element, GroupKind::Color);
  } else if (name == "texture2d") {
    add_texture(element);
  } else if (name == "texture2dgroup") {
    begin_group(element, GroupKind::Texture);
    if (group_ != nullptr) group_->texture = index_of(element, "texid");
  } else if (name == "tex2coord" && is_within(GroupKind::Texture)) {
    const float2 uv{number_of(element.find("u").value_or("")), number_of(element.find("v").value_or(""))};
    append_charged(group_->uv, is_finite(float3{uv.x, uv.y, 0}) ? float2{uv.x, 1 - uv.y} : float2{0, 0}, budget_);
  } else if (name == "compositematerials") {
    begin_group(element, GroupKind::Composite);
    materials_ = index_of(element, "matid");
    constituents_.clear();
    for (const std::string_view word : words_of(element.find("matindices").value_or("")))
      constituents_.push_back(index_of(word));
  } else if (name == "composite") {
    add_composite(element);
  } else if (name == "multiproperties") {
    begin_multi(element);
  } else if (name == "multi") {
    add_multi(element);
  } else if (name.ends_with("displayproperties")) {
    flaws_.add_note("display properties (of the materials extension) are not drawn");
  }
}

void ModelParser3mf::begin_model(const XmlElement& element) {
  const std::string_view unit = element.find("unit").value_or("millimeter");
  if (const auto millimetres = find_unit(unit))
    model_.unit = *millimetres;
  else
    flaws_.add(Flaw::Transform, [&] { return fmt::format("unit \"{}\" is none of 3MF, taken as millimeter", unit); });
  for (const std::string_view prefix : words_of(element.find("requiredextensions").value_or(""))) {
    const auto space = spaces_.find(prefix);
    if (space != spaces_.end() && is_known(space->second)) continue;
    flaws_.add(Flaw::Extension, [&] {
      return fmt::format("requires the extension {}, which is not read: what is known of it is drawn",
                         space == spaces_.end() ? prefix : std::string_view(space->second));
    });
  }
}

void ModelParser3mf::ignore_extension(const XmlName& name) {
  for (const Ignored& extension : ignored_extensions)
    if (name.local == extension.element && name.space.find(extension.space) != std::string_view::npos)
      flaws_.add_note(std::string(extension.text));
}

Placement ModelParser3mf::placement_of(const XmlElement& element) {
  Placement out;
  out.object = index_of(element, "objectid");
  out.path = element.find("path", production_space).value_or("");
  budget_.take(out.path.size());
  const auto text = element.find("transform");
  if (!text) return out;
  if (const auto matrix = find_matrix(*text, model_.unit))
    out.to_from_object = *matrix;
  else
    flaws_.add(Flaw::Transform, [&] {
      return fmt::format("{} of object {}: its transform is not twelve numbers: it is left out", element.name.local,
                         out.object);
    });
  return out;
}

void ModelParser3mf::begin_object(const XmlElement& element) {
  const std::uint32_t id = index_of(element, "id");
  if (object_ != nullptr) flaws_.add(Flaw::Reference, [&] { return rest_is_left_out(id, *object_); });
  const std::string_view name = element.find("name").value_or("");
  budget_.take(2 * sizeof(Object) + name.size());
  const auto [entry, is_new] = model_.objects.try_emplace(id);
  object_ = is_new ? &entry->second : nullptr;
  if (!is_new)
    return flaws_.add(Flaw::Reference,
                      [&] { return fmt::format("object {} is there twice: the first one counts", id); });
  object_->name = name.empty() ? fmt::format("object {}", id) : std::string(name);
  object_->is_other = element.find("type") == "other";
  object_->group = index_of(element, "pid");
  object_->index = index_of(element, "pindex");
}

void ModelParser3mf::add_vertex(const XmlElement& element) {
  if (object_ == nullptr) return;
  std::array<std::string_view, 3> coordinates;
  for (const XmlAttribute& a : element.attributes) {
    if (a.name.local.size() != 1 || !a.name.space.empty()) continue;
    const char axis = a.name.local.front();
    if (axis >= 'x' && axis <= 'z') coordinates[static_cast<std::size_t>(axis - 'x')] = a.value;
  }
  append_vertex(*object_, coordinates, model_.unit, budget_);
}

void ModelParser3mf::add_triangle(const XmlElement& element) {
  if (object_ == nullptr) return;
  std::array<std::uint32_t, 3> vertex{none, none, none};
  TriangleProperty property;
  for (const XmlAttribute& a : element.attributes) {
    const std::string_view name = a.name.local;
    if (!a.name.space.empty()) continue;
    if (name == "pid") property.group = index_of(a.value);
    if (name.size() != 2 || name[1] < '1' || name[1] > '3') continue;
    const auto corner = static_cast<std::size_t>(name[1] - '1');
    if (name[0] == 'v') vertex[corner] = index_of(a.value);
    if (name[0] == 'p') property.index[corner] = index_of(a.value);
  }
  std::vector<TriangleProperty>& properties = object_->properties;
  const bool has_own = property.group != none || property.index != std::array{none, none, none};
  if (has_own && properties.empty()) {
    const std::size_t count = object_->triangles.size() / 3;
    budget_.take(count * sizeof(TriangleProperty));
    properties.resize(count);
  }
  if (has_own || !properties.empty()) append_charged(properties, property, budget_);
  for (const std::uint32_t v : vertex) append_charged(object_->triangles, v, budget_);
}

void ModelParser3mf::begin_group(const XmlElement& element, GroupKind kind) {
  const std::uint32_t id = index_of(element, "id");
  budget_.take(2 * sizeof(PropertyGroup));
  const auto [entry, is_new] = model_.groups.try_emplace(id);
  group_ = is_new ? &entry->second : nullptr;
  if (!is_new)
    return flaws_.add(Flaw::Property,
                      [&] { return fmt::format("property group {} is there twice: the first one counts", id); });
  group_kind_ = kind;
  group_->is_base = kind == GroupKind::Base || kind == GroupKind::Composite;
  group_->has_alpha = group_->is_base || kind == GroupKind::Multi;
}

float4 ModelParser3mf::color_of(const XmlElement& element, std::string_view attribute) {
  const std::string_view text = element.find(attribute).value_or("");
  if (const auto color = find_hex_color(text)) return *color;
  flaws_.add(Flaw::Property, [&] {
    return fmt::format("{} \"{}\" of a {} is not #RRGGBB or #RRGGBBAA: it is taken as white", attribute,
                       text.substr(0, 32), element.name.local);
  });
  return white;
}

void ModelParser3mf::add_base(const XmlElement& element) {
  if (!is_within(GroupKind::Base)) return;
  const std::string_view name = element.find("name").value_or("");
  budget_.take(name.size());
  append_charged(group_->names, std::string(name), budget_);
  float4 color = color_of(element, "displaycolor");
  if (color.w == 0) {  // some programs do not use alpha
    flaws_.add_note("the alpha of a base material is 0, taken as 1");
    color.w = 1;
  }
  append_charged(group_->color, color, budget_);
}

void ModelParser3mf::add_texture(const XmlElement& element) {
  Texture texture{std::string(element.find("path").value_or("")), {}};
  budget_.take(2 * sizeof(Texture) + texture.path.size());
  texture.sampler.wrap_u = wrap_of(element.find("tilestyleu"));
  texture.sampler.wrap_v = wrap_of(element.find("tilestylev"));
  if (element.find("filter") == "nearest") texture.sampler.magnify = texture.sampler.minify = TexelFilter::Nearest;
  model_.textures.try_emplace(index_of(element, "id"), std::move(texture));
}

const float4* ModelParser3mf::find_color(std::uint32_t group, std::uint32_t index) {
  const auto found = model_.groups.find(group);
  if (found == model_.groups.end() || index >= found->second.color.size()) {
    flaws_.add(Flaw::Property, [&] { return no_property(group, index); });
    return nullptr;
  }
  return &found->second.color[index];
}

/// The mean of the constituents' colours.
void ModelParser3mf::add_composite(const XmlElement& element) {
  if (!is_within(GroupKind::Composite)) return;
  budget_.check_time();
  const std::vector<std::string_view> words = words_of(element.find("values").value_or(""));
  std::vector<float> shares(constituents_.size(), 0.0f);
  for (std::size_t i = 0; i < std::min(words.size(), shares.size()); ++i) {
    const float share = number_of(words[i]);
    shares[i] = share > 0 ? std::min(share, 1.0f) : 0.0f;
  }
  float sum = std::accumulate(shares.begin(), shares.end(), 0.0f);
  if (!(sum > 0)) std::fill(shares.begin(), shares.end(), 1.0f), sum = static_cast<float>(shares.size());
  float4 color{0, 0, 0, 0};
  for (std::size_t i = 0; i < shares.size(); ++i) {
    const float4* const part = find_color(materials_, constituents_[i]);
    color = color + (part != nullptr ? *part : white) * (shares[i] / sum);
  }
  append_charged(group_->names, std::string("composite"), budget_);
  append_charged(group_->color, shares.empty() ? white : color, budget_);
}

void ModelParser3mf::begin_multi(const XmlElement& element) {
  begin_group(element, GroupKind::Multi);
  layers_.clear(), multiplies_.clear();
  constexpr std::size_t max_layers = 64;
  for (const std::string_view word : words_of(element.find("pids").value_or("")))
    if (layers_.size() < max_layers) layers_.push_back(index_of(word));
  for (const std::string_view word : words_of(element.find("blendmethods").value_or("")))
    multiplies_.push_back(word == "multiply");
  multiplies_.resize(layers_.size());
}

/// Accumulates a layer. A texture cannot be mixed with other layers at a vertex: the highest one stays a texture, over
/// the colour below it.
void ModelParser3mf::add_layer(std::size_t layer, const PropertyGroup& group, std::uint32_t index, MultiLayers& below) {
  // The specification leaves out the first layer if it is a material, with its method, and lays the others over it.
  const auto first = model_.groups.find(layers_[0]);
  const bool is_on_material = layer == 1 && first != model_.groups.end() && first->second.is_base;
  const bool multiplies = layer > 0 && !is_on_material && multiplies_[layer - 1];
  if (!group.uv.empty()) {
    if (layer > 0 && !multiplies && !below.uv)
      below.below_texture = {below.color.x, below.color.y, below.color.z, 1}, below.color = white;
    below.is_approximate = below.is_approximate || below.uv;
    below.uv = group.uv[std::min<std::size_t>(index, group.uv.size() - 1)];
    below.texture = group.texture;
    return;
  }
  float4 own = group.color[index];
  if (layer == 0 && !group.has_alpha) own.w = 1;
  below.is_approximate = below.is_approximate || (below.uv && !multiplies);
  if (layer == 0)
    below.color = own;
  else if (multiplies)
    below.color = below.color * own;
  else if (!below.uv)
    below.color = mixed(below.color, own);
}

void ModelParser3mf::add_multi(const XmlElement& element) {
  if (!is_within(GroupKind::Multi)) return;
  const std::vector<std::string_view> words = words_of(element.find("pindices").value_or(""));
  MultiLayers all;
  for (std::size_t layer = 0; layer < layers_.size(); ++layer) {
    const auto found = model_.groups.find(layers_[layer]);
    const std::uint32_t index = layer < words.size() ? index_of(words[layer]) : 0;
    if (found != model_.groups.end() && &found->second != group_ && index < found->second.size())
      add_layer(layer, found->second, index, all);
    else
      flaws_.add(Flaw::Property, [&] { return no_property(layers_[layer], index); });
  }
  if (all.uv) {
    const bool is_first = group_->texture == none;
    all.is_approximate =
        all.is_approximate || (!is_first && (all.texture != group_->texture || all.below_texture != group_->below));
    if (is_first) group_->texture = all.texture, group_->below = all.below_texture;
  }
  if (all.is_approximate)
    flaws_.add_note("layers of colours and textures (of multiproperties) are approximated by one texture");
  append_charged(group_->color, all.color, budget_);
  if (group_->texture == none) return;
  while (group_->uv.size() < group_->color.size()) append_charged(group_->uv, all.uv.value_or(float2{0, 0}), budget_);
}

}  // namespace zoneplate
