// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <utility>

#include "zoneplate/scene/stream/triangle_stream.h"

namespace zoneplate {

/// The triangles of a scene in memory that has one instance, of one mesh, as those of a file.
class MeshStream : public TriangleStream {
 public:
  explicit MeshStream(Scene scene) : scene_(std::move(scene)) {}

  std::size_t count() const override { return mesh().primitives(); }
  void read(std::size_t first, std::size_t count, float3* corners) const override {
    for (std::size_t i = 3 * first; i < 3 * (first + count); ++i) *corners++ = mesh().position[mesh().index[i]];
  }
  void examine(std::size_t, std::size_t count, const float3*) override { examined += count; }
  void read_ahead(std::size_t, std::size_t) const override {}
  void forget() const override {}
  Scene head() const override {
    Scene head = scene_;
    head.meshes[0] = {};
    head.meshes[0].material = mesh().material;
    return head;
  }
  Mesh mesh(std::span<const std::uint32_t> triangles) const override {
    const auto add = [](const auto& from, std::uint32_t v, auto& to) {
      if (!from.empty()) to.push_back(from[v]);
    };
    Mesh out;
    for (const std::uint32_t t : triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = mesh().index[3 * t + k];
        out.index.push_back(static_cast<std::uint32_t>(out.position.size()));
        add(mesh().position, v, out.position), add(mesh().normal, v, out.normal), add(mesh().uv0, v, out.uv0);
        add(mesh().color, v, out.color);
      }
    return out;
  }

  std::atomic<std::size_t> examined = 0;

 private:
  const Mesh& mesh() const { return scene_.meshes.at(0); }
  Scene scene_;
};

}  // namespace zoneplate
