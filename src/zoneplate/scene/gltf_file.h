#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/base/file.h"
#include "zoneplate/scene/gltf_json.h"

namespace zoneplate {

/// Bytes of a resource: a part of the model file, a file of its own, or decoded from a data: URI.
struct GltfBytes {
  std::span<const std::uint8_t> bytes;
  std::optional<FileBytes> file;
  std::vector<std::uint8_t> decoded;
};

/// A glTF file that is open: its JSON, the binary part of a .glb, and its buffers as they are asked for.
///
/// Every range of bytes that it hands out lies within what the file says and within what is really there.
class GltfFile {
 public:
  /// Errors    Trouble::Input: unreadable, neither JSON nor GLB 2, chunks that overrun the file, not glTF 2.
  GltfFile(const std::string& path, const LoadLimits& limits);

  const JsonView& root() const { return *root_; }
  GltfBudget& budget() { return budget_; }

  std::size_t count(const char* list) const { return root_->count(list); }

  /// The bytes of a buffer view.
  std::span<const std::uint8_t> view(std::size_t i);
  /// The byte stride that a buffer view states, 0 where it states none.
  std::uint64_t view_stride(std::size_t i) const;

  /// The bytes that a URI names: of a data: URI or of a file relative to the model's folder.
  ///
  /// Errors    Trouble::Input naming `owner`: another scheme, a path outside the folder (unless allowed), bad base64,
  ///           unreadable.
  GltfBytes load_uri(const JsonView& owner, const std::string& uri);

  /// Notes what was passed over, each text once.
  void warn(const std::string& text);
  std::vector<std::string> take_warnings() { return std::move(warnings_); }

 private:
  void read_chunks(std::span<const std::uint8_t> bytes);
  void check_asset() const;
  std::span<const std::uint8_t> buffer(std::size_t i);

  std::string path_;
  GltfBudget budget_;
  FileBytes file_;
  std::span<const std::uint8_t> json_bytes_, binary_;
  bool has_binary_ = false;
  JsonValue json_;
  std::optional<JsonView> root_;
  std::map<std::size_t, GltfBytes> buffers_;
  std::vector<std::string> warnings_;
  std::set<std::string> warned_;
};

}  // namespace zoneplate
