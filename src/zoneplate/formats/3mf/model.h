// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/formats/3mf/flaws.h"
#include "zoneplate/formats/xml/xml.h"
#include "zoneplate/math/affine.h"
#include "zoneplate/scene/geometry/origin.h"
#include "zoneplate/scene/material.h"

namespace zoneplate {

// The contents of the model parts of a 3MF package. Its parts refer to each other by these identifiers; none stands for
// a reference that a file does not make.
namespace model_3mf {

inline constexpr std::uint32_t none = 0xffffffff;

/// What places an object: an item of the build or a component of another object.
struct Placement {
  std::uint32_t object = none;
  std::string path;       ///< of the model part that has the object; empty: the same part
  Affine to_from_object;  ///< millimetres in both spaces
};

/// The properties of a triangle; those that are none are those of the object, and p2 and p3 are then p1.
struct TriangleProperty {
  std::uint32_t group = none;
  std::array<std::uint32_t, 3> index{none, none, none};
};

/// The places of vertices, in millimetres, kept until two blocks of them are near their origin.
struct FarPlaces {
  std::vector<double3> place;
  OriginChoice choice;  ///< of the last block of vertices
  int near_blocks = 0;
  bool is_near = false;  ///< then no places are kept
};

/// An object, which has a mesh or components.
struct Object {
  std::string name;
  bool is_other = false;  ///< of the type "other": not a part of what is built
  std::uint32_t group = none, index = none;
  std::vector<float3> position;              ///< in millimetres, relative to `centre`
  double3 centre;                            ///< in millimetres; 0 for an object near its own origin
  FarPlaces far;                             ///< of the vertices so far; empty after finish_objects
  std::vector<std::uint32_t> triangles;      ///< three indices each; all are valid after finish_objects
  std::vector<TriangleProperty> properties;  ///< one for each triangle, or none if no triangle has its own
  std::vector<Placement> components;
};

/// A group of properties, which triangles refer to by an index. Colours are linear, alpha is straight.
struct PropertyGroup {
  bool is_base = false;            ///< materials: not interpolated
  bool has_alpha = false;          ///< alpha counts; that of a colour group does so in layers of multiproperties only
  std::vector<float4> color;       ///< empty: white
  std::vector<std::string> names;  ///< of materials
  std::vector<float2> uv;          ///< with (0,0) at the top left; empty: no texture
  std::uint32_t texture = none;
  /// The colour that a texture with alpha lies on; transparent black: alpha is ignored.
  float4 below{0, 0, 0, 0};

  std::size_t size() const { return std::max(color.size(), uv.size()); }
};

struct Texture {
  std::string path;
  Sampler sampler;
};

/// A model part.
struct Model {
  std::string part;  ///< its name, as part_name returns it
  double unit = 1;   ///< millimetres
  std::map<std::uint32_t, Object> objects;
  std::map<std::uint32_t, PropertyGroup> groups;
  std::map<std::uint32_t, Texture> textures;
  std::vector<Placement> items;
};

/// Appends a vertex; a coordinate whose text is no number is NaN.
void append_vertex(Object& object, const std::array<std::string_view, 3>& coordinates, double unit,
                   ImportBudget& budget);

/// Makes the vertices of objects far from their own origins relative to their centres, and leaves out the triangles of
/// all objects with a vertex that is not there or not finite, which are flaws. It is called once for each model, after
/// its whole document.
void finish_objects(Model& model, FlawList& flaws, ImportBudget& budget);

/// What to say of an object inside another one, which ends there.
std::string rest_is_left_out(std::uint32_t inner, const Object& outer);

}  // namespace model_3mf

/// Parses one model part.
///
/// Source    3MF Core Specification 1.3, Materials and Properties Extension 1.2, Production Extension 1.1.
class ModelParser3mf : public XmlHandler {
 public:
  /// Requires  the arguments outlive the parser.
  ModelParser3mf(model_3mf::Model& model, FlawList& flaws, ImportBudget& budget);

  void begin(const XmlElement& element) override;
  void end(const XmlName& name) override;
  void declare(std::string_view prefix, std::string_view uri) override;
  /// Leaves out what is invalid, after the whole document.
  void finish() { model_3mf::finish_objects(model_, flaws_, budget_); }

 private:
  using Object = model_3mf::Object;
  using PropertyGroup = model_3mf::PropertyGroup;
  /// The layers of one multi, accumulated so far.
  struct MultiLayers {
    float4 color{1, 1, 1, 1};
    std::optional<float2> uv;
    std::uint32_t texture = model_3mf::none;
    float4 below_texture{0, 0, 0, 0};
    bool is_approximate = false;
  };

  void begin_core(const XmlElement& element);
  void begin_material(const XmlElement& element);
  void begin_model(const XmlElement& element);
  void begin_object(const XmlElement& element);
  void add_vertex(const XmlElement& element);
  void add_triangle(const XmlElement& element);
  void add_base(const XmlElement& element);
  void add_texture(const XmlElement& element);
  void add_composite(const XmlElement& element);
  void begin_multi(const XmlElement& element);
  void add_multi(const XmlElement& element);
  void ignore_extension(const XmlName& name);

  /// The kinds of property groups; each takes its own elements only.
  enum class GroupKind { Base, Color, Texture, Composite, Multi };
  void begin_group(const XmlElement& element, GroupKind kind);
  bool is_within(GroupKind kind) const { return group_ != nullptr && group_kind_ == kind; }
  void add_layer(std::size_t layer, const PropertyGroup& group, std::uint32_t index, MultiLayers& below);
  float4 color_of(const XmlElement& element, std::string_view attribute);
  const float4* find_color(std::uint32_t group, std::uint32_t index);
  model_3mf::Placement placement_of(const XmlElement& element);

  model_3mf::Model& model_;
  FlawList& flaws_;
  ImportBudget& budget_;
  std::map<std::string, std::string, std::less<>> spaces_;
  Object* object_ = nullptr;
  PropertyGroup* group_ = nullptr;
  GroupKind group_kind_ = GroupKind::Base;
  std::uint32_t materials_ = model_3mf::none;  ///< of the composite materials
  std::vector<std::uint32_t> constituents_;    ///< of the composite materials: indices into materials_
  std::vector<std::uint32_t> layers_;          ///< of the multiproperties: groups
  std::vector<bool> multiplies_;               ///< of the multiproperties, for each layer after the first
};

}  // namespace zoneplate
