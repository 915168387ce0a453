// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/formats/import/model_path.h"
#include "zoneplate/formats/json/json.h"
#include "zoneplate/formats/json/json_edits.h"
#include "zoneplate/os/file.h"

namespace zoneplate {

/// The bytes of a resource: a part of the model file, a separate file, or decoded from a data: URI.
struct GltfBytes {
  std::span<const std::uint8_t> bytes;
  std::optional<FileBytes> file;
  std::vector<std::uint8_t> decoded;
};

/// An open glTF file: its JSON, the binary chunk of a .glb, and its buffers, which are loaded at their first use.
///
/// Every returned range of bytes is within the buffer view and within the existing bytes.
class GltfFile {
 public:
  /// Errors    ErrorKind::Input: unreadable, neither JSON nor GLB 2, chunks that overrun the file, not glTF 2; Gltf1Error
  ///           (gltf.h).
  GltfFile(const std::string& path, const LoadLimits& limits);
  /// A file that is read in parts: the caller maps its bytes, and files that it names may be larger than memory too.
  GltfFile(const std::string& path, const LoadLimits& limits, std::span<const std::uint8_t> bytes);

  const JsonView& root() const { return *root_; }
  ImportBudget& budget() { return budget_; }

  std::size_t count(const char* list) const { return root_->count(list); }

  /// The changes that animations made to the properties of the file.
  JsonEdits& edits() { return edits_; }

  /// The bytes of a buffer view; unpacked, where KHR_meshopt_compression or EXT_meshopt_compression packs them.
  std::span<const std::uint8_t> view(std::size_t i);
  /// The byte stride of a buffer view; 0 if it states none.
  std::uint64_t view_stride(std::size_t i) const;

  /// The bytes of a URI: a data: URI, or a file relative to the model's folder.
  ///
  /// Errors    ErrorKind::Input naming `owner`: another scheme, a path outside the folder (unless allowed), invalid
  ///           base64, an unreadable file.
  GltfBytes load_uri(const JsonView& owner, const std::string& uri);

  /// Stores values of an accessor that are decoded from compressed data, tightly packed, with the accessor's shape.
  void set_decoded(std::size_t accessor, std::vector<std::uint8_t> bytes) { decoded_[accessor] = std::move(bytes); }
  bool has_decoded(std::size_t accessor) const { return decoded_.contains(accessor); }
  std::span<const std::uint8_t> decoded(std::size_t accessor) const { return decoded_.at(accessor); }

  /// Counts elements of the scene that come from accessors without bytes.
  ///
  /// Errors    ErrorKind::Input beyond a total limit, so that a small file cannot exhaust memory.
  void take_zeros(const JsonView& accessor, std::uint64_t count);
  /// Resets the count of take_zeros, for another scene of the file.
  void forget_zeros() { zeros_ = 0; }

  /// Lets the system reclaim the memory of the buffers' files.
  void forget() const;

  /// Reads a part that the picture can do without. An invalid one is left out with a warning, or is an error if the
  /// limits are strict.
  ///
  /// Errors    exceeded limits; errors that are not of the file.
  template <class Read>
  void read_optional(const Read& read) {
    try {
      read();
    } catch (const Error& error) {
      leave_out(error);
    }
  }
  /// The error of the first part that read_optional left out.
  const std::optional<Error>& first_loss() const { return first_loss_; }

  /// Adds a warning about ignored content; equal texts are added once. The number of warnings is limited.
  void warn(const std::string& text);
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void read(std::span<const std::uint8_t> bytes);
  void read_chunks(std::span<const std::uint8_t> bytes);
  void check_asset();
  void leave_out(const Error& error);
  std::span<const std::uint8_t> buffer(std::size_t i);
  std::span<const std::uint8_t> part_of_buffer(const JsonView& json);

  std::string path_;
  ImportBudget budget_;
  PathFinder finder_;
  std::optional<FileBytes> file_;  ///< nothing: the caller has the bytes
  std::span<const std::uint8_t> json_bytes_, binary_;
  bool has_binary_ = false;
  JsonValue json_;
  JsonEdits edits_{json_};
  std::optional<JsonView> root_;
  std::map<std::size_t, GltfBytes> buffers_;
  std::map<std::size_t, std::vector<std::uint8_t>> unpacked_;  ///< by index of the compressed buffer view
  std::map<std::size_t, std::vector<std::uint8_t>> decoded_;   ///< by index of the accessor
  std::uint64_t zeros_ = 0;
  std::optional<Error> first_loss_;
  std::vector<std::string> warnings_;
  std::set<std::string> warned_;
};

}  // namespace zoneplate
