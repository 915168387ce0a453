// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace zoneplate {

enum class PlyType : std::uint8_t { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float, Double };
enum class PlyOrder : std::uint8_t { Ascii, Little, Big };

/// The size of a value in a binary file, in bytes.
std::size_t size_of(PlyType type);
/// The value that represents 1 in colours of a type, of which `greatest` is the greatest value: the type's maximum, or
/// 1 for floats. In wider types than a byte most programs store 0 to 255; then it is 255.
double one_of(PlyType type, double greatest);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::Float;    ///< the type of the stored value, or of the items of a list
  PlyType stated = PlyType::Float;  ///< the type in the header, which defines the range
  bool is_list = false;
  PlyType count_type = PlyType::Uint8;
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyOrder order = PlyOrder::Ascii;
  std::vector<PlyElement> elements;
  std::vector<std::string> textures;  ///< the file names of "TextureFile" comments, as written by MeshLab
  std::vector<std::string> warnings;  ///< of ignored lines, naming the file
  std::size_t size = 0;               ///< bytes up to the end of the header's last line
};

/// Parses the header of a PLY file with any kind of line ends. A line with another word than those of the format is
/// ignored, with a warning.
///
/// Errors    ErrorKind::Input naming `file`, line and cause.
PlyHeader parse_ply_header(std::span<const std::uint8_t> bytes, const std::string& file);

}  // namespace zoneplate
