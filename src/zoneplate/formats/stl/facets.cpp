// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/stl/facets.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>
#include <numeric>
#include <string_view>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/large_array.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/stl/text.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/scene/geometry/flat_normals.h"

namespace zoneplate {
namespace {

using Bytes = std::span<const std::uint8_t>;
constexpr std::size_t header_bytes = StlFacets::header_bytes, facet_bytes = StlFacets::facet_bytes;
constexpr std::size_t block = 1024;  // facets whose data stay in the cache between loops

std::uint32_t read_u32(const std::uint8_t* at) {
  return at[0] | std::uint32_t{at[1]} << 8 | std::uint32_t{at[2]} << 16 | std::uint32_t{at[3]} << 24;
}
std::uint32_t read_u16(const std::uint8_t* at) { return at[0] | std::uint32_t{at[1]} << 8; }
/// Decodes the colours of facets: 5 bits per channel, and one bit that marks the colour as valid.
class FacetColor {
 public:
  explicit FacetColor(Bytes header) {
    static constexpr std::string_view word = "COLOR=";
    const auto found = std::search(header.begin(), header.begin() + 80, word.begin(), word.end());
    is_magics_ = found != header.begin() + 80 && header.begin() + 80 - found >= 10;
    for (std::size_t i = 0; i < 32; ++i) linear_[i] = decode_srgb(static_cast<float>(i) / 31);
    if (!is_magics_) return;
    const auto c = found + 6;
    whole_ = {decode_srgb8(c[0]), decode_srgb8(c[1]), decode_srgb8(c[2]), static_cast<float>(c[3]) / 255};
    if (whole_.w == 0) whole_.w = 1;  // programs without transparency write alpha 0
  }

  bool is_own(std::uint32_t attribute) const { return (attribute >> 15 != 0) != is_magics_; }
  bool colors_all() const { return is_magics_; }
  float4 of_all() const { return whole_; }  ///< that of the header, if `colors_all`
  float4 operator()(std::uint32_t attribute) const {
    if (!is_own(attribute)) return whole_;
    const float low = linear_[attribute & 31], middle = linear_[attribute >> 5 & 31],
                high = linear_[attribute >> 10 & 31];
    return is_magics_ ? float4{low, middle, high, 1} : float4{high, middle, low, 1};
  }

 private:
  bool is_magics_ = false;
  float4 whole_{1, 1, 1, 1};
  std::array<float, 32> linear_{};
};

/// Allocates arrays for `count` separate triangles. It does so in parallel, because page faults dominate the time.
Mesh make_triangles(std::uint64_t count) {
  Mesh mesh;
  const std::size_t corners = 3 * static_cast<std::size_t>(count);
  parallel_for(3, [&](std::size_t i) {
    if (i == 0) make_large(mesh.position, corners);
    if (i == 1) make_large(mesh.normal, corners);
    if (i == 2) make_large(mesh.index, corners);
  });
  return mesh;
}

}  // namespace

bool is_stl_text(std::span<const std::uint8_t> bytes) {
  if (bytes.size() >= header_bytes && bytes.size() == header_bytes + facet_bytes * read_u32(&bytes[80])) return false;
  constexpr std::size_t looked_at = 512;
  const Bytes front = bytes.first(std::min(bytes.size(), looked_at));
  return std::find(front.begin(), front.end(), 0) == front.end() &&
         find_stl_solid({reinterpret_cast<const char*>(front.data()), front.size()}) != std::string_view::npos;
}

std::uint32_t StlFacets::attributes(std::size_t begin, std::size_t end) const {
  std::uint32_t any = 0;
  for (std::size_t f = begin; f < end; ++f) any |= read_u16(facet(f) + StlFacets::attribute_at);
  return any;
}

bool StlFacets::are_colored(std::uint32_t any_attribute) const {
  const FacetColor color({header, header_bytes});
  return color.colors_all() || color.is_own(any_attribute);
}

StlFacets find_stl_facets(std::span<const std::uint8_t> bytes, Scene& scene, const ImportBudget& budget) {
  if (bytes.size() < header_bytes)
    throw Error(ErrorKind::Input, fmt::format("{}: neither ASCII STL nor binary STL: {} bytes, expected {} at least",
                                              budget.file(), bytes.size(), header_bytes));
  const std::uint64_t said = read_u32(&bytes[80]), held = (bytes.size() - header_bytes) / facet_bytes;
  const bool is_whole = bytes.size() == header_bytes + held * facet_bytes;
  // Where the file is whole facets, its size is more credible than a count that programs left at 0 or at -1.
  const bool is_wrong = said != held && is_whole && held > 0 && (said > held || said == 0);
  const std::uint64_t count = is_wrong ? held : said;
  if (count > held)
    throw Error(ErrorKind::Input,
                fmt::format("{}: not an STL file, or cut off: its header states {} triangles, the file has {}",
                            budget.file(), said, held));
  if (is_wrong)
    budget.warn_of_flaw(
        scene.warnings,
        fmt::format("{}: its header states {} triangles, the file has {}, which are drawn", budget.file(), said, held));
  else if (bytes.size() > header_bytes + said * facet_bytes)
    scene.warnings.push_back(fmt::format("{}: {} bytes after the last triangle are ignored", budget.file(),
                                         bytes.size() - header_bytes - said * facet_bytes));
  if (count > 0xffffffffu / 3) throw Error(ErrorKind::Input, budget.file() + ": more than 2^32 corners");
  return {bytes.data(), bytes.data() + header_bytes, static_cast<std::size_t>(count)};
}

Mesh read_stl_facets(const StlFacets& facets, ImportBudget& budget, std::optional<std::uint32_t> any_attribute) {
  const std::size_t count = facets.count;
  budget.take(count * 3 * (2 * sizeof(float3) + sizeof(std::uint32_t)));
  Mesh mesh = make_triangles(count);
  std::atomic<std::uint32_t> attributes = 0;
  parallel_ranges(count, block, [&](std::size_t begin, std::size_t end) {
    if (!budget.has_time()) return;
    for (std::size_t f = begin; f < end; ++f)
      std::memcpy(&mesh.position[3 * f], facets.facet(f) + StlFacets::corners_at, 3 * sizeof(float3));
    attributes |= facets.attributes(begin, end);
    std::iota(&mesh.index[3 * begin], &mesh.index[3 * begin] + 3 * (end - begin),
              static_cast<std::uint32_t>(3 * begin));
    FlatNormalKernels::of().make(facets.facet(begin) + StlFacets::corners_at, facet_bytes, end - begin,
                                 &mesh.normal[3 * begin].x);
  });
  budget.check_time();
  const std::uint32_t any = any_attribute.value_or(attributes);
  if (!facets.are_colored(any)) return mesh;
  const FacetColor color({facets.header, header_bytes});
  budget.take(count * 3 * sizeof(float4));
  make_large(mesh.color, mesh.position.size());
  // Attributes that are all 0 are left out, not black.
  parallel_ranges(count, block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      std::fill_n(&mesh.color[3 * f], 3, any != 0 ? color(facets.attributes(f, f + 1)) : color.of_all());
  });
  return mesh;
}

}  // namespace zoneplate
