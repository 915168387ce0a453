// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/stl/stream.h"

#include <atomic>
#include <cstring>
#include <filesystem>

#include "zoneplate/formats/import/model_folder.h"
#include "zoneplate/formats/stl/facets.h"

namespace zoneplate {
namespace {

class StlStream : public FileStream {
 public:
  StlStream(const std::string& path, const LoadLimits& limits) : FileStream(path, limits) {
    head_.up = {0, 0, 1};
    head_.materials = {plain_material("default")};
    head_.objects.push_back(std::filesystem::path(path).stem().string());
    head_.instances.push_back({});
    head_.meshes.emplace_back();
    if (!is_text()) facets_ = find_stl_facets(file().bytes(), head_, budget());
  }

  bool is_text() const { return is_stl_text(file().bytes()); }

  std::size_t count() const override { return facets_.count; }

  std::uint64_t bytes_in_memory() const override {
    // Positions, normals and indices, then the interleaved vertices and the screen vertices of the renderer.
    return facets_.count * (3 * (12 + 12 + 4) + 3 * (32 + 16));
  }

  void read(std::size_t first, std::size_t count, float3* corners) const override {
    for (std::size_t f = first; f < first + count; ++f, corners += 3)
      std::memcpy(corners, facets_.facet(f) + StlFacets::corners_at, 3 * sizeof(float3));
  }

  void examine(std::size_t first, std::size_t count, const float3*) override {
    attributes_ |= facets_.attributes(first, first + count);
  }

  void read_ahead(std::size_t first, std::size_t count) const override {
    file().read_ahead(facets_.facet(first), count * StlFacets::facet_bytes);
  }

  Scene head() const override {
    Scene scene = head_;
    if (facets_.are_colored(attributes_)) scene.materials[0].base_color = {1, 1, 1, 1};
    return scene;
  }

  Mesh mesh(std::span<const std::uint32_t> triangles) const override {
    std::vector<std::uint8_t> some(triangles.size() * StlFacets::facet_bytes);
    in_steps(triangles.size(), [&](std::size_t i) {
      std::memcpy(&some[i * StlFacets::facet_bytes], facets_.facet(triangles[i]), StlFacets::facet_bytes);
    });
    ImportBudget limits = budget();
    return read_stl_facets({facets_.header, some.data(), triangles.size()}, limits, attributes_.load());
  }

 private:
  Scene head_;
  StlFacets facets_;
  std::atomic<std::uint32_t> attributes_ = 0;  ///< the bits that any facet has
};

}  // namespace

std::unique_ptr<FileStream> open_stl_stream(const std::string& path, const LoadLimits& limits) {
  auto stream = std::make_unique<StlStream>(path, limits);
  if (stream->is_text()) return nullptr;
  return stream;
}

}  // namespace zoneplate
