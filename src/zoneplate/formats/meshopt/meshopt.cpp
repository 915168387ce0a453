// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/meshopt/meshopt.h"

#include <meshoptimizer.h>

#include <string>

#include "zoneplate/formats/meshopt/vertex_stream.h"
#include "zoneplate/os/library.h"

namespace zoneplate {
namespace {

/// The library's functions. The library is loaded by the first file that needs it, because loading it takes as long as
/// rendering a small image.
struct MeshoptLibrary {
  SharedLibrary library;
  decltype(&meshopt_decodeVertexBuffer) attributes = library.find("meshopt_decodeVertexBuffer");
  decltype(attributes) triangles = library.find("meshopt_decodeIndexBuffer");
  decltype(attributes) indices = library.find("meshopt_decodeIndexSequence");
  decltype(&meshopt_decodeFilterOct) octahedral = library.find("meshopt_decodeFilterOct");
  decltype(&meshopt_decodeFilterQuat) quaternion = library.find("meshopt_decodeFilterQuat");
  decltype(&meshopt_decodeFilterExp) exponential = library.find("meshopt_decodeFilterExp");

  explicit MeshoptLibrary(const std::string& place) : library(Library::Meshoptimizer, place) {}
};

void check_stride(const JsonView& json, const std::string& mode, const std::string& filter, std::uint64_t stride) {
  const bool fits_mode =
      mode == "ATTRIBUTES" ? stride % 4 == 0 && stride >= 4 && stride <= 256 : stride == 2 || stride == 4;
  const bool fits_filter = filter == "NONE" || (mode == "ATTRIBUTES" && (filter == "OCTAHEDRAL" || filter == "COLOR"
                                                                             ? stride == 4 || stride == 8
                                                                         : filter == "QUATERNION" ? stride == 8
                                                                                                  : true));
  if (!fits_mode || !fits_filter)
    json.fail("byteStride is " + std::to_string(stride) + ", which does not go with " + mode + " and " + filter);
}

}  // namespace

std::vector<std::uint8_t> decode_meshopt(const JsonView& json, std::span<const std::uint8_t> packed,
                                         ImportBudget& budget) {
  const std::string mode = json.text("mode"), filter = json.text("filter", "NONE");
  if (mode != "ATTRIBUTES" && mode != "TRIANGLES" && mode != "INDICES")
    json.fail("mode is " + quoted(mode) + ", expected ATTRIBUTES, TRIANGLES or INDICES");
  if (filter != "NONE" && filter != "OCTAHEDRAL" && filter != "QUATERNION" && filter != "EXPONENTIAL" &&
      filter != "COLOR")
    json.fail("filter is " + quoted(filter) + ", expected NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL or COLOR");
  const std::uint64_t count = json.whole("count", std::nullopt, std::uint64_t{1} << 32);
  const std::uint64_t stride = json.whole("byteStride", std::nullopt, 256);
  check_stride(json, mode, filter, stride);
  if (mode == "TRIANGLES" && count % 3 != 0) json.fail("count is " + std::to_string(count) + ", not in threes");

  // No codec of the library expands a byte to more: data that claim more are corrupt, and no memory is allocated for
  // them.
  constexpr std::uint64_t max_per_byte = 1024;
  if (count * stride / max_per_byte > packed.size()) json.fail("its data are corrupt");
  budget.check_time();
  budget.take(count * stride);
  std::vector<std::uint8_t> out(static_cast<std::size_t>(count * stride));
  const auto n = static_cast<std::size_t>(count), size = static_cast<std::size_t>(stride);
  const bool is_version1 = mode == "ATTRIBUTES" && is_vertex_stream1(packed);
  if (is_version1 && !decode_vertex_stream1(packed, size, out)) json.fail("its data are corrupt");
  if (filter == "COLOR" && is_version1) filter_colors(out, size);
  if (is_version1 && (filter == "NONE" || filter == "COLOR")) return out;
  const MeshoptLibrary library(json.place());
  const auto decode = mode == "ATTRIBUTES"  ? library.attributes
                      : mode == "TRIANGLES" ? library.triangles
                                            : library.indices;
  if (n > 0 && !is_version1 && decode(out.data(), n, size, packed.data(), packed.size()) != 0)
    json.fail("its data are corrupt");
  if (filter == "COLOR") filter_colors(out, size);
  if (filter == "OCTAHEDRAL") library.octahedral(out.data(), n, size);
  if (filter == "QUATERNION") library.quaternion(out.data(), n, size);
  if (filter == "EXPONENTIAL") library.exponential(out.data(), n, size);
  return out;
}
}  // namespace zoneplate
