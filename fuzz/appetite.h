// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace zoneplate::appetite {

using Bytes = std::vector<std::uint8_t>;

/// Options of `zoneplate render`, by their long names without the dashes, and their values.
using Options = std::vector<std::pair<std::string, std::string>>;

/// The exit codes that the documentation allows for an input, as a list of JSON.
inline constexpr const char* refused = "[3]";            ///< the file promises what it does not hold
inline constexpr const char* within_limits = "[0,1,3]";  ///< drawn, or past a limit of rendering or of reading
inline constexpr const char* not_there = "[2,3]";        ///< the options choose what the file does not have

/// The folder that the inputs are written to, and its list `index.jsonl`: one JSON object a line with the members
/// name (of the file in the folder, or of a built-in scene), kind, exit (the codes allowed), bytes (of the file and
/// what belongs to it) and options (of `zoneplate render`, by name).
class Collection {
 public:
  /// With `has_one_of_each_kind` only the first input of each kind is written.
  Collection(std::filesystem::path folder, bool has_one_of_each_kind);

  /// Adds an input of a kind. `more` is the size of the files beside it.
  void add(std::string_view kind, const std::string& name, const Bytes& bytes, const char* codes,
           const Options& options = {}, std::size_t more = 0);
  void add(std::string_view kind, const std::string& name, std::string_view text, const char* codes,
           const Options& options = {}, std::size_t more = 0) {
    add(kind, name, Bytes(text.begin(), text.end()), codes, options, more);
  }
  /// Adds a built-in scene with options that ask for much.
  void add_builtin(std::string_view kind, const std::string& scene, const char* codes, const Options& options);
  /// Adds a square with an image on it: an OBJ file, its MTL file and the image, `name` and then `extension`.
  void add_picture(std::string_view kind, const std::string& name, const std::string& extension, const Bytes& picture,
                   const char* codes, const Options& options = {});
  /// Adds a triangle in the light of an image: an OBJ file and the image, the OBJ file's name and then `extension`.
  /// Its path is relative to the folder's parent.
  void add_environment(std::string_view kind, const std::string& name, const std::string& extension,
                       const Bytes& picture, const char* codes);
  /// Writes a file that belongs to another.
  void write(const std::string& name, const Bytes& bytes) const;

 private:
  bool is_needed(std::string_view kind);
  void list(std::string_view kind, const std::string& name, std::size_t bytes, const char* codes,
            const Options& options);

  std::filesystem::path folder_;
  bool has_one_of_each_kind_;
  std::set<std::string, std::less<>> kinds_;
  std::ofstream index_;
};

/// `count` times the same text, with something between.
std::string repeated(std::string_view text, std::size_t count, std::string_view between = "");

void add_gltf_claims(Collection& out);  ///< names, instances, nodes, accessors without bytes, poses, JSON
void add_gltf_packed(Collection& out);  ///< Draco, meshopt, GLB chunks, images used often
void add_crowds(Collection& out);       ///< masked, blended, clipped, lit and large images: what rendering takes
void add_png(Collection& out);
void add_pictures(Collection& out);  ///< JPEG, WebP, HDR, KTX2; environments; texture filters
void add_exr(Collection& out);
void add_obj(Collection& out);  ///< with MTL
void add_ply_and_stl(Collection& out);
void add_printed(Collection& out);  ///< 3MF and AMF
void add_foreign(Collection& out);  ///< what the library assimp reads

}  // namespace zoneplate::appetite
