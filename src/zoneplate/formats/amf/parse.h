// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "zoneplate/formats/3mf/flaws.h"
#include "zoneplate/formats/3mf/model.h"
#include "zoneplate/formats/xml/xml.h"

namespace zoneplate {

/// Parses an AMF document as a model of 3MF: constellations become objects with components.
class AmfParser : public XmlHandler {
 public:
  /// Requires  the arguments outlive the parser.
  AmfParser(model_3mf::Model& model, FlawList& flaws, ImportBudget& budget);

  void begin(const XmlElement& element) override;
  void end(const XmlName& name) override;
  void text(std::string_view text) override;
  /// Leaves out what is invalid and finds the materials of the triangles, after the whole document.
  void finish();

 private:
  /// What a colour or a name belongs to.
  enum class Owner { Material, Object, Volume, Vertex, Triangle };

  void set_value(std::string_view name);
  void set_color(Owner owner);
  void set_name(Owner owner);
  void end_owner(Owner owner);
  void begin_object(const XmlElement& element);
  void add_triangle();
  void add_instance();
  model_3mf::TriangleProperty property_of_triangle();
  std::uint32_t color_below();

  model_3mf::Model& model_;
  FlawList& flaws_;
  ImportBudget& budget_;
  model_3mf::PropertyGroup& colors_;     ///< of everything but materials
  model_3mf::PropertyGroup& materials_;  ///< those that have a colour
  std::map<std::uint32_t, std::uint32_t> material_of_id_;
  std::map<std::uint32_t, std::uint32_t> color_below_;  ///< the number in colors_ of a material's colour

  std::vector<Owner> owners_;
  std::string text_;              ///< of the innermost element
  bool is_name_ = false;          ///< the metadata element is a name
  std::array<float, 4> color_{};  ///< red, green, blue, alpha of the current colour, sRGB-encoded

  model_3mf::Object* object_ = nullptr;
  std::uint32_t material_id_ = model_3mf::none;
  std::uint32_t object_color_ = model_3mf::none, volume_color_ = model_3mf::none, volume_material_ = model_3mf::none;
  std::uint32_t triangle_color_ = model_3mf::none, vertex_color_ = model_3mf::none;
  std::string material_name_;
  std::array<std::string, 3> vertex_;  ///< the texts of its coordinates
  std::array<std::uint32_t, 3> corner_{};
  std::vector<std::uint32_t> vertex_colors_;  ///< of the object; empty if no vertex has one
  model_3mf::Placement instance_;
  double3 shift_, turn_;  ///< of the instance; degrees about x, then y, then z
};

}  // namespace zoneplate
