#pragma once

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// A file that lives in memory only, so that thousands can be written in a second.
class MemoryFile {
 public:
  MemoryFile() : number_(memfd_create("model", 0)) {}
  ~MemoryFile() { close(number_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string write(const std::vector<std::uint8_t>& bytes) const {
    EXPECT_EQ(ftruncate(number_, static_cast<off_t>(bytes.size())), 0);
    EXPECT_EQ(pwrite(number_, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
    return "/proc/self/fd/" + std::to_string(number_);
  }

 private:
  int number_;
};

template <class V>
bool all_finite(const std::vector<V>& values) {
  const float* f = reinterpret_cast<const float*>(values.data());
  for (std::size_t i = 0; i < values.size() * sizeof(V) / sizeof(float); ++i)
    if (!std::isfinite(f[i])) return false;
  return true;
}

template <class V>
bool fits(const std::vector<V>& values, const Mesh& m) {
  return (values.empty() || values.size() == m.position.size()) && all_finite(values);
}

/// Everything that scene.h, mesh.h and material.h promise.
inline void expect_sound(const Scene& s) {
  const auto is_image = [&](const TextureUse& use) {
    return use.image >= -1 && use.image < static_cast<int>(s.images.size()) && (use.uv_set == 0 || use.uv_set == 1);
  };
  for (const Mesh& m : s.meshes) {
    ASSERT_TRUE(all_finite(m.position) && fits(m.normal, m) && fits(m.tangent, m) && fits(m.uv0, m) && fits(m.uv1, m) &&
                fits(m.color, m));
    ASSERT_EQ(m.index.size() % static_cast<std::size_t>(m.vertices_per_primitive()), 0u);
    for (const std::uint32_t i : m.index) ASSERT_LT(i, m.position.size());
    if (m.topology == Topology::Triangles) {
      ASSERT_EQ(m.normal.size(), m.position.size());
      for (const std::uint32_t i : m.index) ASSERT_NEAR(length(m.normal[i]), 1, 1e-5f);
    }
    ASSERT_TRUE(m.material >= 0 && m.material < static_cast<int>(s.materials.size()));
  }
  for (const Instance& i : s.instances) {
    ASSERT_TRUE(i.mesh >= 0 && i.mesh < static_cast<int>(s.meshes.size()));
    ASSERT_TRUE(i.object >= 0 && i.object < static_cast<int>(s.objects.size()));
  }
  for (const Material& m : s.materials)
    ASSERT_TRUE(is_image(m.base_color_texture) && is_image(m.emissive_texture) && is_image(m.normal_texture) &&
                is_image(m.occlusion_texture) && is_image(m.metallic_roughness_texture));
  if (!s.instances.empty()) {
    const Box box = s.bounds();
    ASSERT_TRUE(is_finite(box.low) && is_finite(box.high));
  }
  for (const std::string& w : s.warnings) ASSERT_EQ(w.find('\n'), std::string::npos) << w;
}

/// Loads a file with `load(path, limits)`; the message, or nothing if it was loaded.
template <class Load>
std::string load_soundly(const Load& load, const std::string& path) {
  try {
    expect_sound(load(path, {.memory = 1 << 24, .pixels = 1 << 20, .seconds = 5}));
    return "";
  } catch (const Error& e) {
    EXPECT_EQ(e.trouble(), Trouble::Input);
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    return e.what();
  }
}

}  // namespace zoneplate
