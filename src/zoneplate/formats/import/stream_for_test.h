// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/import/file_stream.h"
#include "zoneplate/math/random.h"
#include "zoneplate/scene/stream/stream_outline.h"

namespace zoneplate {

/// Fails the test unless a stream has the scene that its loader gives, of which `share` of the triangles are compared.
///
/// Errors    those of the stream.
inline void expect_scene_of(FileStream& stream, const std::string& path, const Scene& whole, float share) {
  stream.check();
  const StreamOutline outline(stream, path, {});
  const Scene head = stream.head();
  const std::vector<StreamInstance> instances = stream.instances();
  ASSERT_EQ(instances.size(), whole.instances.size());
  ASSERT_EQ(head.instances.size(), whole.instances.size());
  ASSERT_EQ(head.materials.size(), whole.materials.size());
  ASSERT_EQ(head.objects.size(), whole.objects.size());
  EXPECT_EQ(whole.origin, double3{});
  const Box bounds = whole.bounds();
  EXPECT_EQ(outline.bounds().low, bounds.low);
  EXPECT_EQ(outline.bounds().high, bounds.high);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < instances.size(); ++i) {
    SCOPED_TRACE("instance " + std::to_string(i));
    const Mesh& mesh = whole.meshes[static_cast<std::size_t>(whole.instances[i].mesh)];
    const Mesh& own = head.meshes[static_cast<std::size_t>(head.instances[i].mesh)];
    ASSERT_EQ(instances[i].end - begin, mesh.primitives());
    EXPECT_EQ(instances[i].world_from_object, whole.instances[i].world_from_object);
    EXPECT_EQ(head.instances[i].object, whole.instances[i].object);
    EXPECT_EQ(own.material, mesh.material);
    EXPECT_EQ(own.name, mesh.name);
    std::vector<std::uint32_t> some;
    for (std::size_t t = begin; t < instances[i].end; ++t)
      if (unit_float(hash(static_cast<std::uint32_t>(t), 5)) < share) some.push_back(static_cast<std::uint32_t>(t));
    if (some.empty()) some.push_back(static_cast<std::uint32_t>(begin));
    const Mesh part = stream.mesh(some);
    ASSERT_EQ(part.primitives(), some.size());
    for (std::size_t c = 0; c < 3 * some.size(); ++c) {
      const std::uint32_t v = mesh.index[3 * (some[c / 3] - begin) + c % 3], w = part.index[c];
      const auto expect_same = [&](const auto& a, const auto& b) {
        ASSERT_EQ(a.empty(), b.empty());
        if (!a.empty()) {
          ASSERT_EQ(a[w], b[v]) << c;
        }
      };
      expect_same(part.position, mesh.position), expect_same(part.normal, mesh.normal);
      expect_same(part.uv0, mesh.uv0), expect_same(part.uv1, mesh.uv1), expect_same(part.color, mesh.color);
      if (testing::Test::HasFatalFailure()) return;
    }
    begin = instances[i].end;
  }
}

/// How many damaged files a stream and its loader agreed about, and how many a stream refused.
struct DamagedFiles {
  int agreed = 0, refused = 0;

  /// Fails the test unless the stream `open`(path) refuses the file in one line, or has the scene that `load`(path)
  /// gives, which then refuses nothing. A file of which `open` makes no stream does not count.
  template <class Open, class Load>
  void add(const std::string& path, const Open& open, const Load& load, float share) {
    std::unique_ptr<FileStream> stream;
    try {
      stream = open(path);
      if (!stream) return;
      stream->check();
      const StreamOutline outline(*stream, path, {});
      static_cast<void>(stream->head());
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      ++refused;
      return;
    }
    expect_scene_of(*stream, path, load(path), share);
    ++agreed;
  }
};

}  // namespace zoneplate
