// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/amf/parse.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "zoneplate/formats/3mf/values.h"
#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/math/angle.h"

namespace zoneplate {
namespace {

using namespace model_3mf;

constexpr std::uint32_t colors_group = 0, materials_group = 1;
constexpr std::size_t max_text = 256;  // of a number or a name

/// Multiples of 90 degrees are exact.
SineCosine of_degrees(double degrees) {
  constexpr double pi = 3.14159265358979323846;
  const double quarters = degrees / 90;
  const auto nearest = static_cast<std::int64_t>(quarters + (quarters < 0 ? -0.5 : 0.5));
  return turned(static_cast<std::uint64_t>(nearest),
                sine_cosine((degrees - 90 * static_cast<double>(nearest)) * pi / 180));
}

/// Rotations about x, then y, then z.
Affine rotation(double3 degrees) {
  const SineCosine x = of_degrees(degrees.x), y = of_degrees(degrees.y), z = of_degrees(degrees.z);
  const Affine about_x{.x = {1, 0, 0}, .y = {0, x.cosine, x.sine}, .z = {0, -x.sine, x.cosine}, .move = {}};
  const Affine about_y{.x = {y.cosine, 0, -y.sine}, .y = {0, 1, 0}, .z = {y.sine, 0, y.cosine}, .move = {}};
  const Affine about_z{.x = {z.cosine, z.sine, 0}, .y = {-z.sine, z.cosine, 0}, .z = {0, 0, 1}, .move = {}};
  return about_z * about_y * about_x;
}

}  // namespace

AmfParser::AmfParser(Model& model, FlawList& flaws, ImportBudget& budget)
    : model_(model),
      flaws_(flaws),
      budget_(budget),
      colors_(model.groups[colors_group]),
      materials_(model.groups[materials_group]) {
  colors_.has_alpha = materials_.has_alpha = materials_.is_base = true;
}

void AmfParser::begin(const XmlElement& element) {
  const std::string_view name = element.name.local;
  text_.clear();
  if (name == "vertex") {
    owners_.push_back(Owner::Vertex);
    for (std::string& coordinate : vertex_) coordinate.clear();
    vertex_color_ = none;
  } else if (name == "triangle") {
    owners_.push_back(Owner::Triangle);
    corner_ = {none, none, none};
    triangle_color_ = none;
  } else if (name == "color") {
    color_ = {1, 1, 1, 1};
  } else if (name == "volume") {
    owners_.push_back(Owner::Volume);
    volume_color_ = none;
    volume_material_ = index_of(element, "materialid");
  } else if (name == "object" || name == "constellation") {
    owners_.push_back(Owner::Object);
    begin_object(element);
  } else if (name == "material") {
    owners_.push_back(Owner::Material);
    material_id_ = index_of(element, "id");
    material_name_.clear();
  } else if (name == "instance") {
    instance_ = {index_of(element, "objectid"), "", {}};
    shift_ = turn_ = {0, 0, 0};
  } else if (name == "metadata") {
    is_name_ = element.find("type") == "name";
  } else if (name == "texture" || name == "texmap") {
    flaws_.add_note("textures of AMF are not drawn");
  } else if (name == "amf") {
    const std::string_view unit = element.find("unit").value_or("millimeter");
    if (const auto millimetres = find_unit(unit))
      model_.unit = *millimetres;
    else
      flaws_.add(Flaw::Transform, [&] { return fmt::format("unit \"{}\" is none of AMF, taken as millimeter", unit); });
  }
}

void AmfParser::text(std::string_view text) {
  text_.append(text.substr(0, max_text - std::min(text_.size(), max_text)));
}

void AmfParser::end(const XmlName& element) {
  const std::string_view name = element.local;
  if (name == "vertex") return end_owner(Owner::Vertex);
  if (name == "triangle") return end_owner(Owner::Triangle);
  if (name == "volume") return end_owner(Owner::Volume);
  if (name == "object" || name == "constellation") return end_owner(Owner::Object);
  if (name == "material") return end_owner(Owner::Material);
  if (name == "instance") return add_instance();
  if (name == "color" && !owners_.empty()) return set_color(owners_.back());
  if (name == "metadata" && is_name_ && !owners_.empty()) return set_name(owners_.back());
  set_value(name);
}

/// Takes the text of an element that is a number.
void AmfParser::set_value(std::string_view name) {
  const auto at = [&](std::string_view names) {
    return name.size() == 1 ? names.find(name[0]) : std::string_view::npos;
  };
  const auto set_axis = [&](double3& v, char axis) {
    (axis == 'x' ? v.x : axis == 'y' ? v.y : v.z) = double_of(text_);
  };
  if (const std::size_t axis = at("xyz"); axis != std::string_view::npos) {
    vertex_[axis] = text_;
    return;
  }
  if (const std::size_t channel = at("rgba"); channel != std::string_view::npos) {
    const float value = number_of(text_);
    if (!(value == value))
      flaws_.add(Flaw::Property, [&] { return "a colour is no number (formulas are not read): it is taken as white"; });
    color_[channel] = value >= 0 && value <= 1 ? value : value < 0 ? 0.0f : 1.0f;
  } else if (name.size() == 2 && name[0] == 'v' && name[1] >= '1' && name[1] <= '3') {
    corner_[static_cast<std::size_t>(name[1] - '1')] = index_of(text_);
  } else if (name == "deltax" || name == "deltay" || name == "deltaz") {
    set_axis(shift_, name.back());
  } else if (name == "rx" || name == "ry" || name == "rz") {
    set_axis(turn_, name.back());
  }
}

void AmfParser::set_color(Owner owner) {
  const float4 color{decode_srgb(color_[0]), decode_srgb(color_[1]), decode_srgb(color_[2]), color_[3]};
  if (owner == Owner::Material) {
    budget_.take(64 + material_name_.size());
    material_of_id_.try_emplace(material_id_, static_cast<std::uint32_t>(materials_.color.size()));
    append_charged(materials_.color, color, budget_);
    append_charged(materials_.names, material_name_, budget_);
    return;
  }
  const auto number = static_cast<std::uint32_t>(colors_.color.size());
  append_charged(colors_.color, color, budget_);
  (owner == Owner::Object   ? object_color_
   : owner == Owner::Volume ? volume_color_
   : owner == Owner::Vertex ? vertex_color_
                            : triangle_color_) = number;
}

void AmfParser::set_name(Owner owner) {
  if (owner == Owner::Material) material_name_ = text_;
  if (owner == Owner::Object && object_ != nullptr) object_->name = text_;
}

void AmfParser::begin_object(const XmlElement& element) {
  const std::uint32_t id = index_of(element, "id");
  if (object_ != nullptr) flaws_.add(Flaw::Reference, [&] { return rest_is_left_out(id, *object_); });
  object_color_ = volume_color_ = volume_material_ = none;
  vertex_colors_.clear();
  budget_.take(2 * sizeof(Object));
  const auto [entry, is_new] = model_.objects.try_emplace(id);
  object_ = is_new ? &entry->second : nullptr;
  if (is_new)
    object_->name = fmt::format("object {}", id);
  else
    flaws_.add(Flaw::Reference, [&] { return fmt::format("object {} is there twice: the first one counts", id); });
}

void AmfParser::end_owner(Owner owner) {
  if (!owners_.empty()) owners_.pop_back();
  if (object_ == nullptr) return;
  if (owner == Owner::Vertex) {
    append_vertex(*object_, {vertex_[0], vertex_[1], vertex_[2]}, model_.unit, budget_);
    if (vertex_color_ == none && vertex_colors_.empty()) return;
    while (vertex_colors_.size() + 1 < object_->position.size()) append_charged(vertex_colors_, none, budget_);
    append_charged(vertex_colors_, vertex_color_, budget_);
  } else if (owner == Owner::Triangle) {
    add_triangle();
  } else if (owner == Owner::Object) {
    object_ = nullptr;
  }
}

/// The number in colors_ of the colour of the volume's material, which finish() finds.
std::uint32_t AmfParser::color_below() {
  const auto [entry, is_new] =
      color_below_.try_emplace(volume_material_, static_cast<std::uint32_t>(colors_.color.size()));
  if (is_new) budget_.take(64), append_charged(colors_.color, float4{}, budget_);
  return entry->second;
}

/// The colours of the vertices count if the triangle has none of its own; where one has none, it is what is below.
TriangleProperty AmfParser::property_of_triangle() {
  const std::uint32_t whole = triangle_color_ != none ? triangle_color_
                              : volume_color_ != none ? volume_color_
                                                      : object_color_;
  TriangleProperty property{whole != none ? colors_group : none, {whole, whole, whole}};
  const auto has_color = [&](std::uint32_t v) { return v < vertex_colors_.size() && vertex_colors_[v] != none; };
  if (triangle_color_ == none && std::any_of(corner_.begin(), corner_.end(), has_color)) {
    property.group = colors_group;
    for (std::size_t c = 0; c < 3; ++c) {
      if (has_color(corner_[c])) property.index[c] = vertex_colors_[corner_[c]];
      if (property.index[c] == none) property.index[c] = color_below();
    }
  }
  if (property.group == none && volume_material_ != none)
    property = {materials_group, {volume_material_, volume_material_, volume_material_}};
  return property;
}

void AmfParser::add_triangle() {
  const TriangleProperty property = property_of_triangle();
  std::vector<TriangleProperty>& properties = object_->properties;
  if (property.group != none && properties.empty()) {
    const std::size_t count = object_->triangles.size() / 3;
    budget_.take(count * sizeof(TriangleProperty));
    properties.resize(count);
  }
  if (property.group != none || !properties.empty()) append_charged(properties, property, budget_);
  for (const std::uint32_t v : corner_) append_charged(object_->triangles, v, budget_);
}

void AmfParser::add_instance() {
  if (object_ == nullptr) return;
  const Affine moved{.move = {shift_.x * model_.unit, shift_.y * model_.unit, shift_.z * model_.unit}};
  constexpr double max_degrees = 1e6;
  const bool is_valid = std::abs(turn_.x) <= max_degrees && std::abs(turn_.y) <= max_degrees &&
                        std::abs(turn_.z) <= max_degrees && is_finite(narrowed(moved.move));
  if (is_valid)
    instance_.to_from_object = moved * rotation(turn_);
  else
    flaws_.add(Flaw::Transform, [&] {
      return fmt::format("an instance of object {} has a transform that is no number: it is left out",
                         instance_.object);
    });
  append_charged(object_->components, std::move(instance_), budget_);
}

void AmfParser::finish() {
  finish_objects(model_, flaws_, budget_);
  for (const auto& [material, color] : color_below_) {
    const auto found = material == none ? material_of_id_.end() : material_of_id_.find(material);
    colors_.color[color] =
        found != material_of_id_.end() ? materials_.color[found->second] : plain_material("").base_color;
  }
  for (auto& [id, object] : model_.objects) {
    budget_.check_time();
    for (TriangleProperty& property : object.properties) {
      if (property.group != materials_group) continue;
      const auto found = material_of_id_.find(property.index[0]);
      property = found == material_of_id_.end()
                     ? TriangleProperty{}
                     : TriangleProperty{materials_group, {found->second, found->second, found->second}};
    }
  }
}

}  // namespace zoneplate
