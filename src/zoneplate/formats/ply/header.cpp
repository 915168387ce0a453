// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/ply/header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "zoneplate/base/error.h"

namespace zoneplate {
namespace {

/// More than real files have; the limits bound the work for a malicious file.
constexpr std::size_t max_properties = 1024, max_line = 4096;

std::optional<PlyType> find_type(std::string_view word) {
  static constexpr std::string_view names[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                                  {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                                  {"float", "float32"}, {"double", "float64"}};
  for (std::size_t i = 0; i < std::size(names); ++i)
    if (word == names[i][0] || word == names[i][1]) return static_cast<PlyType>(i);
  return std::nullopt;
}

/// Parses the header line by line.
class HeaderReader {
 public:
  HeaderReader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  PlyHeader read() {
    if (!next_line() || words_.empty() || words_[0] != "ply") fail("does not begin with 'ply'");
    bool has_format = false;
    while (next_line()) {
      if (words_.empty() || words_[0] == "obj_info") continue;
      if (words_[0] == "end_header") {
        if (!has_format) fail("the header names no format");
        header_.size = at_;
        return std::move(header_);
      }
      if (words_[0] == "comment")
        read_comment();
      else if (words_[0] == "format")
        has_format = true, read_format();
      else if (words_[0] == "element")
        read_element();
      else if (words_[0] == "property")
        read_property();
      else
        ignore_line();
    }
    fail("the header has no end_header");
  }

 private:
  [[noreturn]] void fail(const std::string& cause) const {
    throw Error(ErrorKind::Input, fmt::format("{}: line {}: {}", file_, line_number_, cause));
  }

  bool next_line() {
    if (at_ >= text_.size()) return false;
    ++line_number_;
    const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    line_ = text_.substr(at_, end - at_);
    if (line_.size() > max_line || line_.find('\0') != line_.npos) fail("the header is not text");
    at_ = end + (text_.substr(end, 2) == "\r\n" ? 2 : 1);
    if (at_ > text_.size()) at_ = text_.size();
    words_.clear();
    for (std::size_t i = 0; i < line_.size();) {
      const std::size_t begin = line_.find_first_not_of(" \t", i);
      if (begin == line_.npos) break;
      i = std::min(line_.find_first_of(" \t", begin), line_.size());
      words_.push_back(line_.substr(begin, i - begin));
    }
    return true;
  }

  void ignore_line() {
    constexpr std::size_t max_named = 20;
    if (header_.warnings.size() < max_named)
      header_.warnings.push_back(fmt::format("{}: line {}: '{}' is not a word of a PLY header, the line is ignored",
                                             file_, line_number_, words_[0].substr(0, 40)));
  }

  void read_comment() {
    if (words_.size() < 3 || words_[1] != "TextureFile") return;
    if (header_.textures.size() == max_properties) fail("too many textures");
    const std::size_t begin = static_cast<std::size_t>(words_[2].data() - line_.data());
    header_.textures.emplace_back(line_.substr(begin, line_.find_last_not_of(" \t") + 1 - begin));
  }

  void read_format() {
    if (words_.size() != 3) fail("format requires a name and a version");
    static constexpr std::string_view names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
    const auto found = std::find(std::begin(names), std::end(names), words_[1]);
    if (found == std::end(names))
      fail(fmt::format("format '{}', expected ascii, binary_little_endian or binary_big_endian",
                       words_[1].substr(0, 40)));
    header_.order = static_cast<PlyOrder>(found - names);
    if (words_[2] != "1.0") fail(fmt::format("version '{}', expected 1.0", words_[2].substr(0, 40)));
  }

  void read_element() {
    if (words_.size() != 3) fail("element requires a name and a number");
    PlyElement element;
    element.name = words_[1];
    const char* const end = words_[2].data() + words_[2].size();
    const auto [stop, trouble] = std::from_chars(words_[2].data(), end, element.count);
    if (trouble != std::errc{} || stop != end || element.count >= std::uint64_t{1} << 48)
      fail(fmt::format("element {}: '{}' is not a number of elements", element.name, words_[2].substr(0, 40)));
    if (header_.elements.size() == max_properties) fail("too many elements");
    header_.elements.push_back(std::move(element));
  }

  PlyType type(std::string_view word) const {
    const std::optional<PlyType> found = find_type(word);
    if (!found) fail(fmt::format("property: '{}' is not a type", word.substr(0, 40)));
    return *found;
  }

  void read_property() {
    if (header_.elements.empty()) fail("a property before the first element");
    if (header_.elements.back().properties.size() == max_properties) fail("too many properties");
    PlyProperty p;
    p.is_list = words_.size() > 1 && words_[1] == "list";
    if (words_.size() != (p.is_list ? 5u : 3u))
      fail("property requires a type and a name, or list, two types and a name");
    if (p.is_list) p.count_type = type(words_[2]);
    if (p.count_type >= PlyType::Float) fail("the count of a list is not an integer type");
    p.type = p.stated = type(words_[words_.size() - 2]);
    p.name = words_.back();
    header_.elements.back().properties.push_back(std::move(p));
  }

  std::string_view text_, line_;
  const std::string& file_;
  std::size_t at_ = 0, line_number_ = 0;
  std::vector<std::string_view> words_;
  PlyHeader header_;
};

}  // namespace

std::size_t size_of(PlyType type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

double one_of(PlyType type, double greatest) {
  constexpr double ones[] = {127, 255, 32767, 65535, 2147483647, 4294967295, 1, 1}, of_bytes = 255;
  const double one = ones[static_cast<std::size_t>(type)];
  constexpr double max_light = 2;  // floats above it are no colours of [0, 1]
  const bool are_bytes = one < of_bytes ? greatest > std::max(one, max_light) : greatest <= of_bytes;
  return are_bytes ? of_bytes : one;
}

PlyHeader parse_ply_header(std::span<const std::uint8_t> bytes, const std::string& file) {
  return HeaderReader({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file).read();
}

}  // namespace zoneplate
