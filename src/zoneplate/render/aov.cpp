// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/aov.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "zoneplate/render/cryptomatte.h"

namespace zoneplate {
namespace {

template <Plane<float> Frame::*plane>
void add_value(const Frame& frame, DataChannels& out, std::string name) {
  out.list.push_back({std::move(name), ChannelPrecision::Float, (frame.*plane).values().data()});
}

// Adds one channel for each letter of `letters`: "N." and "XYZ" give N.X, N.Y and N.Z. The channels of an empty plane
// have no values.
template <typename Vector>
void add_vector(const Plane<Vector>& plane, std::string_view letters, ChannelPrecision type, std::string_view layer,
                DataChannels& out) {
  const std::span<const Vector> values = plane.values();
  for (std::size_t i = 0; i < letters.size(); ++i)
    out.list.push_back({fmt::format("{}{}", layer, letters[i]), type, values.empty() ? nullptr : &values[0].x + i,
                        nullptr, letters.size()});
}

template <Plane<std::uint32_t> Frame::*ids>
void add_ids(const Frame& frame, DataChannels& out, std::string name) {
  out.list.push_back({std::move(name), ChannelPrecision::Number, nullptr, (frame.*ids).values().data()});
}

template <MatteKind kind>
void add_matte(const Frame& frame, const Scene& scene, DataChannels& out) {
  Cryptomatte matte = make_cryptomatte(frame, scene, kind);
  for (std::size_t i = 0; i < matte.ranks.size(); ++i) {
    const Plane<float4>& plane = out.made.emplace_back(std::move(matte.ranks[i]));
    add_vector(plane, "RGBA", ChannelPrecision::Float, fmt::format("{}{:02}.", matte.layer, i), out);
  }
  out.attributes.insert(out.attributes.end(), matte.attributes.begin(), matte.attributes.end());
}

void add_depth(const Frame& frame, const Scene&, DataChannels& out) { add_value<&Frame::depth>(frame, out, "Z"); }
void add_normal(const Frame& frame, const Scene&, DataChannels& out) {
  add_vector(frame.normal, "XYZ", ChannelPrecision::Float, "N.", out);
}
// Positions in the coordinates of the file; those of empty pixels stay 0.
void add_position(const Frame& frame, const Scene& scene, DataChannels& out) {
  if (scene.origin == double3{} || frame.position.empty())
    return add_vector(frame.position, "XYZ", ChannelPrecision::Float, "P.", out);
  Plane<float3>& places = out.places.emplace_back(frame.position);
  for (std::size_t i = 0; i < places.values().size(); ++i)
    if (frame.instance.values()[i] != Frame::no_id)
      places.values()[i] = narrowed(scene.in_file(frame.position.values()[i]));
  add_vector(places, "XYZ", ChannelPrecision::Float, "P.", out);
  const double3 o = scene.origin;
  const double farthest = std::max({std::abs(o.x), std::abs(o.y), std::abs(o.z)});
  out.attributes.emplace_back(
      "position",
      fmt::format("coordinates of the file, rounded to floats: multiples of {} at {}",
                  std::ldexp(1.0, std::ilogb(farthest) - std::numeric_limits<float>::digits + 1), farthest));
}
void add_albedo(const Frame& frame, const Scene&, DataChannels& out) {
  add_vector(frame.albedo, "RGB", ChannelPrecision::Half, "albedo.", out);
}
void add_uv(const Frame& frame, const Scene&, DataChannels& out) {
  add_vector(frame.uv, "UV", ChannelPrecision::Float, "UV.", out);
}
void add_motion(const Frame& frame, const Scene&, DataChannels& out) {
  add_vector(frame.motion, "XY", ChannelPrecision::Float, "motion.", out);
  out.attributes.emplace_back("motion",
                              "pixels, +x right, +y down: position now minus position in the last frame, no jitter");
}
void add_flow(const Frame& frame, const Scene&, DataChannels& out) {
  add_vector(frame.flow, "XY", ChannelPrecision::Float, "flow.", out);
  out.attributes.emplace_back("flow",
                              "pixels, +x right, +y down: position in the next frame minus position now, no jitter");
}
void add_object_id(const Frame& frame, const Scene&, DataChannels& out) {
  add_ids<&Frame::object_id>(frame, out, "objectId");
}
void add_material_id(const Frame& frame, const Scene&, DataChannels& out) {
  add_ids<&Frame::material_id>(frame, out, "materialId");
}
void add_primitive_id(const Frame& frame, const Scene&, DataChannels& out) {
  add_ids<&Frame::primitive_id>(frame, out, "primId");
}
void add_coverage(const Frame& frame, const Scene&, DataChannels& out) {
  add_value<&Frame::coverage>(frame, out, "coverage");
}
void add_error(const Frame& frame, const Scene&, DataChannels& out) { add_value<&Frame::error>(frame, out, "error"); }

void add_mip_level(const Frame& frame, const Scene&, DataChannels& out) {
  add_value<&Frame::mip_level>(frame, out, "mipLevel");
}
void add_anisotropy(const Frame& frame, const Scene&, DataChannels& out) {
  add_value<&Frame::anisotropy>(frame, out, "anisotropy");
}

template <std::size_t component>
void add_light(const Frame& frame, const Scene&, DataChannels& out) {
  constexpr std::string_view layers[] = {"diffuse.", "specular.", "transmission.", "emission."};
  add_vector(frame.light[component], "RGB", ChannelPrecision::Half, layers[component], out);
}

constexpr Aov all[] = {
    {"depth", "distance along the view axis, near black, far white", &Planes::depth, add_depth},
    {"normal", "world-space normal as colour", &Planes::normal, add_normal},
    {"position", "world-space position as colour", &Planes::position, add_position},
    {"albedo", "base colour without light", &Planes::albedo, add_albedo},
    {"uv", "texture coordinates as red and green", &Planes::uv, add_uv},
    {"motion", "way on the screen since the last frame: direction as hue, length as saturation", &Planes::motion,
     add_motion},
    {"flow", "the same to the next frame", &Planes::flow, add_flow},
    {"object-id", "a false colour for each object", &Planes::object_id, add_object_id},
    {"material-id", "a false colour for each material", &Planes::material_id, add_material_id},
    {"primitive-id", "a false colour for each triangle of a mesh", &Planes::primitive_id, add_primitive_id},
    {"crypto-object", "Cryptomatte of objects by name", &Planes::sample_triangles, add_matte<MatteKind::Object>},
    {"crypto-material", "Cryptomatte of materials by name", &Planes::sample_triangles, add_matte<MatteKind::Material>},
    {"mip-level", "level of detail in the base colour's texture as false colour", &Planes::mip_level, add_mip_level},
    {"anisotropy", "longer over shorter axis of the footprint in that texture as false colour", &Planes::anisotropy,
     add_anisotropy},
    {"diffuse", "light of diffuse reflection", &Planes::diffuse, add_light<0>},
    {"specular", "light of highlights and reflections", &Planes::specular, add_light<1>},
    {"transmission", "light through transmissive surfaces", &Planes::transmission, add_light<2>},
    {"emission", "emitted light, and the colour of unlit surfaces", &Planes::emission, add_light<3>},
    {"coverage", "fraction of the pixel that surfaces cover", &Planes::coverage, add_coverage},
    {"error", "estimated standard error of the colour, from methods that have one", &Planes::error, add_error}};

}  // namespace

std::span<const Aov> aovs() { return all; }

}  // namespace zoneplate
