// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/chunk.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "zoneplate/base/deadline.h"
#include "zoneplate/formats/import/text_scan.h"

namespace zoneplate {
namespace {

/// Thrown if an element refers to data outside of the part.
struct NeedsMore {};

/// The counts of the parts before this one, and of the whole file.
struct LineContext {
  ObjCounts before, all;
};

class PartReader {
 public:
  /// `known` is null in the first pass, before the counts of other parts are available.
  PartReader(std::string_view text, char separator, const LineContext* known, ObjPart& part)
      : at_(text.data()),
        end_(text.data() + text.size()),
        separator_(separator),
        known_(known),
        part_(part),
        chunk_(part.chunk),
        vertices_(part.vertices),
        next_line_(known ? known->before.lines + 1 : 1) {}

  void read() {
    const std::string_view text(at_, static_cast<std::size_t>(end_ - at_));
    const std::size_t last = separator_ == '\n' ? text.rfind('\n') : text.npos;
    // The end of all lines except perhaps an unterminated last one.
    const char* const last_end = last == text.npos ? at_ : at_ + last;
    while (at_ != end_)
      if (at_ >= last_end || !read_plain()) read_any();
  }

  ObjCounts counts() const {
    return {next_line_ - 1 - (known_ ? known_->before.lines : 0), vertices_.positions.size(), vertices_.uvs.size(),
            vertices_.normals.size()};
  }

 private:
  /// Reads any logical line.
  void read_any() {
    constexpr std::uint64_t lines_per_check = 4096;
    if (next_line_ % lines_per_check == 0) check_deadline();
    TextLines lines({at_, static_cast<std::size_t>(end_ - at_)}, next_line_, separator_);
    lines.next();
    line_ = lines.number();
    LineWords words(lines.line());
    read_statement(words.next(), words);
    at_ = lines.rest();
    next_line_ = lines.next_number();
  }

  /// The fast path for nearly all lines: vertices and faces in their usual form. Moves behind the line; false if
  /// read_statement has to parse it. The line is terminated, so that scanning needs no bounds checks.
  bool read_plain() {
    const char* at = at_;
    if (at[0] == 'f' && at[1] == ' ') return read_plain_face(at + 1);
    if (at[0] != 'v') return false;
    const char kind = at[1];
    if (kind != ' ' && ((kind != 't' && kind != 'n') || at[2] != ' ')) return false;
    std::array<float, 3> v{};
    at = scan_numbers(at + (kind == ' ' ? 1 : 2), kind == 't' ? 2 : 3, v);
    if (at == nullptr || !ends_line(at)) return false;
    if (kind == 't')
      vertices_.uvs.push_back({v[0], v[1]});
    else if (kind == 'n')
      add_normal(v);
    else
      vertices_.positions.push_back({v[0], v[1], v[2]});
    return true;
  }

  /// Scans n consecutive numbers; null if the text has another form.
  const char* scan_numbers(const char* at, std::size_t n, std::array<float, 3>& out) const {
    for (std::size_t i = 0; i < n && at != nullptr; ++i) {
      while (*at == ' ') ++at;
      at = scan_number(at, end_, out[i]);
    }
    return at;
  }

  /// If the rest of the line is empty, moves to the next line and returns true.
  bool ends_line(const char* at) {
    while (*at == ' ' || *at == '\r') ++at;
    if (*at != '\n') return false;
    at_ = at + 1;
    ++next_line_;
    return true;
  }

  /// Scans an unsigned index of an existing element and moves `at` behind it. Returns the zero-based index; -1 for any
  /// other text.
  std::int32_t scan_index(const char*& at, std::uint64_t ObjCounts::*kind) {
    std::uint64_t value = 0;
    const char* const first = at;
    for (; *at >= '0' && *at <= '9'; ++at) value = value * 10 + static_cast<std::uint64_t>(*at - '0');
    const std::uint64_t most = known_ ? known_->all.*kind : max_obj_items;
    if (at - first > 10 || value == 0 || value > most) return -1;
    part_.named.*kind = std::max(part_.named.*kind, value);
    return static_cast<std::int32_t>(value - 1);
  }

  /// Whether the text at `at` is the same number as `digits`.
  bool is_repeated(std::string_view digits, const char* at) const {
    const std::size_t n = digits.size();
    if (n >= 8 || end_ - at < 8) return false;
    std::uint64_t a, b;
    std::memcpy(&a, digits.data(), sizeof a);
    std::memcpy(&b, at, sizeof b);
    return (a ^ b) << (64 - 8 * n) == 0 && !(at[n] >= '0' && at[n] <= '9');
  }

  /// Scans the index of a texture coordinate or normal, which is often the same number as the position's.
  std::int32_t scan_other_index(const char*& at, std::uint64_t ObjCounts::*kind, std::string_view position,
                                std::int32_t index) {
    if (!is_repeated(position, at)) return scan_index(at, kind);
    const auto value = static_cast<std::uint64_t>(index) + 1;
    if (known_ && value > known_->all.*kind) return -1;
    part_.named.*kind = std::max(part_.named.*kind, value);
    at += position.size();
    return index;
  }

  bool read_plain_face(const char* at) {
    const std::size_t first = chunk_.corners.size();
    const auto give_up = [&] {
      chunk_.corners.shorten(first);
      return false;
    };
    while (true) {
      while (*at == ' ') ++at;
      if (*at == '\n' || *at == '\r') break;
      ObjCorner corner;
      const char* const digits = at;
      if ((corner.position = scan_index(at, &ObjCounts::positions)) < 0) return give_up();
      const std::string_view text(digits, static_cast<std::size_t>(at - digits));
      if (*at == '/') {
        ++at;
        if (*at != '/' && (corner.uv = scan_other_index(at, &ObjCounts::uvs, text, corner.position)) < 0)
          return give_up();
        if (*at == '/' && (corner.normal = scan_other_index(++at, &ObjCounts::normals, text, corner.position)) < 0)
          return give_up();
      }
      if (*at != ' ' && *at != '\r' && *at != '\n') return give_up();
      chunk_.corners.push_back(corner);
    }
    const std::size_t n = chunk_.corners.size() - first;
    if (n < 3 || chunk_.corners.size() >= max_obj_items || !ends_line(at)) return give_up();
    chunk_.elements.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(n), ObjKind::Face});
    return true;
  }

  void read_statement(std::string_view word, LineWords& words) {
    if (word.empty()) return;
    if (word == "v") return read_position(words);
    if (word == "vt") return read_uv(words);
    if (word == "vn") return read_normal(words);
    if (word == "f" || word == "fo") return read_element(ObjKind::Face, 3, words);
    if (word == "l") return read_element(ObjKind::Line, 2, words);
    if (word == "p") return read_element(ObjKind::Point, 1, words);
    if (word == "o") return add_state(ObjStateKind::Object, words);
    if (word == "g") return add_state(ObjStateKind::Group, words);
    if (word == "usemtl") return add_state(ObjStateKind::Material, words);
    if (word == "s") return add_state(ObjStateKind::Smoothing, words);
    if (word == "mtllib") return add_state(ObjStateKind::Library, words);
    constexpr std::string_view silent[] = {"lod",    "bevel",      "c_interp",  "d_interp", "mg", "maplib",
                                           "usemap", "shadow_obj", "trace_obj", "call",     "csh"};
    if (std::find(std::begin(silent), std::end(silent), word) != std::end(silent)) return;
    constexpr std::string_view free_form[] = {"vp",    "cstype", "deg",  "bmat", "step", "curv", "curv2", "surf",
                                              "parm",  "trim",   "hole", "scrv", "sp",   "end",  "con",   "ctech",
                                              "stech", "bzp",    "bsp",  "res",  "cdc",  "cdp"};
    const bool is_free_form = std::find(std::begin(free_form), std::end(free_form), word) != std::end(free_form);
    note(is_free_form ? ObjNote::FreeForm : ObjNote::Unknown, word.substr(0, 40));
  }

  void note(ObjNote kind, std::string_view word) {
    ObjTally& tally = chunk_.notes[static_cast<std::size_t>(kind)];
    if (tally.count++ == 0) tally.line = line_, tally.word = word;
  }

  /// Errors are reported in the second pass only, in which line numbers are known.
  [[noreturn]] void fail(std::string cause) const {
    if (!known_) throw NeedsMore{};
    throw ObjLineError{line_, std::move(cause)};
  }

  /// Reads the numbers of the line, at most as many as `out` has elements.
  template <std::size_t n>
  std::size_t read_numbers(const char* what, std::size_t least, LineWords& words, std::array<float, n>& out) {
    std::size_t i = 0;
    for (; i < n; ++i) {
      const std::string_view word = words.next();
      if (word.empty()) break;
      const std::optional<float> number = find_number(word);
      if (!number) fail(fmt::format("{}: '{}' is not a number", what, word.substr(0, 40)));
      out[i] = *number;
    }
    if (i < least) fail(fmt::format("{} has {} numbers, expected {}", what, i, least));
    return i;
  }

  void read_position(LineWords& words) {
    // x y z, then optionally a weight (which only free-form geometry uses), or a colour with optional alpha.
    std::array<float, 7> v{0, 0, 0, 1, 1, 1, 1};
    const std::size_t n = read_numbers("vertex", 3, words, v);
    if (n >= 6) vertices_.colors.push_back({vertices_.positions.size(), {v[3], v[4], v[5], n == 7 ? v[6] : 1}});
    vertices_.positions.push_back({v[0], v[1], v[2]});
    vertices_.has_odd_position = vertices_.has_odd_position || !is_finite(vertices_.positions.back());
  }

  void read_uv(LineWords& words) {
    std::array<float, 2> v{};
    read_numbers("texture coordinate", 1, words, v);
    const bool is_fine = std::isfinite(v[0]) && std::isfinite(v[1]);
    if (!is_fine) note(ObjNote::UvNotFinite, "vt");
    vertices_.uvs.push_back(is_fine ? float2{v[0], v[1]} : float2{0, 0});
  }

  void read_normal(LineWords& words) {
    std::array<float, 3> v{};
    read_numbers("normal", 3, words, v);
    add_normal(v);
  }

  void add_normal(const std::array<float, 3>& v) {
    // In double, so that squares neither overflow nor underflow.
    const double x = v[0], y = v[1], z = v[2], length = std::sqrt(x * x + y * y + z * z);
    const bool is_fine = std::isfinite(length) && length > 0;
    vertices_.normals.push_back(
        is_fine ? float3{static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length)}
                : float3{0, 0, 0});
    vertices_.has_odd_normal = vertices_.has_odd_normal || !is_fine;
  }

  /// Reads the next index of a corner's text, which is not empty: positive ones count from 1, negative ones back from
  /// the last element so far. Returns the zero-based index; -1 if there is no such element; nothing if the text is no
  /// number.
  std::optional<std::int32_t> read_index(const char*& at, const char* end, std::uint64_t ObjCounts::*kind) {
    std::int64_t value = 0;
    const char* const begin = at != end && *at == '+' ? at + 1 : at;
    const auto [stop, trouble] = std::from_chars(begin, end, value);
    if (trouble == std::errc::invalid_argument) return std::nullopt;
    at = stop;
    if (trouble != std::errc{}) value = std::numeric_limits<std::int64_t>::max();
    if (!known_ && (value <= 0 || value > static_cast<std::int64_t>(max_obj_items))) throw NeedsMore{};
    const std::uint64_t so_far = known_ ? known_->before.*kind + counts().*kind : 0;
    const std::uint64_t all = known_ ? known_->all.*kind : max_obj_items;
    const std::int64_t index = value < 0 ? static_cast<std::int64_t>(so_far) + value : value - 1;
    if (index < 0 || index >= static_cast<std::int64_t>(all)) return -1;
    part_.named.*kind = std::max(part_.named.*kind, static_cast<std::uint64_t>(index) + 1);
    return static_cast<std::int32_t>(index);
  }

  /// Reads an index that may be that of a missing element: its corner goes without. False if it is no number.
  bool read_optional_index(const char*& at, const char* end, std::uint64_t ObjCounts::*kind, const char* what,
                           ObjNote missing, std::int32_t& out) {
    const std::optional<std::int32_t> found = read_index(at, end, kind);
    if (found && *found < 0) note(missing, what);
    out = found.value_or(-1);
    return found.has_value();
  }

  /// Nothing if the word is not v, v/vt, v//vn or v/vt/vn with a v that exists.
  std::optional<ObjCorner> read_corner(std::string_view word) {
    const char* at = word.data();
    const char* const end = at + word.size();
    ObjCorner corner;
    const std::optional<std::int32_t> position = read_index(at, end, &ObjCounts::positions);
    if (!position || *position < 0) return std::nullopt;
    corner.position = *position;
    if (at != end && *at == '/') {
      ++at;
      if (at != end && *at != '/' &&
          !read_optional_index(at, end, &ObjCounts::uvs, "texture coordinate", ObjNote::NoSuchUv, corner.uv))
        return std::nullopt;
      if (at != end && *at == '/' && ++at != end &&
          !read_optional_index(at, end, &ObjCounts::normals, "normal", ObjNote::NoSuchNormal, corner.normal))
        return std::nullopt;
    }
    return at == end ? std::optional(corner) : std::nullopt;
  }

  void read_element(ObjKind kind, std::size_t least, LineWords& words) {
    const char* what = kind == ObjKind::Face ? "face" : kind == ObjKind::Line ? "line" : "point";
    const std::size_t first = chunk_.corners.size();
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      const std::optional<ObjCorner> corner = read_corner(word);
      if (corner) {
        chunk_.corners.push_back(*corner);
        continue;
      }
      if (!known_) throw NeedsMore{};  // the line's number and the number of vertices are part of the warning
      chunk_.corners.shorten(first);
      return note(ObjNote::BadCorner, fmt::format("{} with the corner '{}' ({} vertices)", what, word.substr(0, 40),
                                                  known_->all.positions));
    }
    const std::size_t n = chunk_.corners.size() - first;
    if (n < least) {
      chunk_.corners.shorten(first);
      return note(ObjNote::FewCorners, what);
    }
    if (chunk_.corners.size() >= max_obj_items) fail("too many corners in one statement");
    chunk_.elements.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(n), kind});
  }

  /// Adds a state change. It replaces one of the same kind between the same two elements, because the last one holds.
  void add_state(ObjStateKind kind, LineWords& words) {
    ObjState state{kind, static_cast<std::uint32_t>(chunk_.elements.size()), words.rest()};
    constexpr std::ptrdiff_t kinds = 5;
    auto& all = chunk_.states;
    for (auto at = all.rbegin(); kind != ObjStateKind::Library && at != all.rend() && at - all.rbegin() < kinds; ++at) {
      if (at->before != state.before) break;
      if (at->kind != kind) continue;
      at->text = std::move(state.text);
      return;
    }
    all.push_back(std::move(state));
  }

  const char *at_, *end_;
  char separator_;
  const LineContext* known_;
  ObjPart& part_;
  ObjChunk& chunk_;
  ObjVertices& vertices_;
  std::uint64_t line_ = 0, next_line_;
};

ObjCounts count(std::string_view text, char separator) {
  ObjCounts counts;
  TextLines lines(text, 0, separator);
  while (lines.next()) {
    const std::string_view line = lines.line();
    if (line.empty() || (line[0] > ' ' && line[0] != 'v')) continue;
    const std::string_view word = LineWords(line).next();
    counts.positions += word == "v";
    counts.uvs += word == "vt";
    counts.normals += word == "vn";
  }
  counts.lines = lines.next_number();
  return counts;
}

}  // namespace

bool read_obj_part(std::string_view text, char separator, ObjPart& part) {
  try {
    PartReader reader(text, separator, nullptr, part);
    reader.read();
    part.counts = reader.counts();
    return true;
  } catch (const NeedsMore&) {
    part = {};
    part.counts = count(text, separator);
    return false;
  }
}

void read_obj_part(std::string_view text, char separator, const ObjCounts& before, const ObjCounts& all,
                   ObjPart& part) {
  part = {};
  const LineContext known{before, all};
  PartReader reader(text, separator, &known, part);
  reader.read();
  part.counts = reader.counts();
}

void read_obj_positions(std::string_view text, char separator, double3 origin, std::span<float3> out) {
  TextLines lines(text, 0, separator);
  for (std::size_t i = 0; i < out.size() && lines.next();) {
    LineWords words(lines.line());
    if (words.next() != "v") continue;
    const auto number = [&] { return find_double(words.next()).value_or(std::numeric_limits<double>::quiet_NaN()); };
    out[i++] = narrowed(double3{number(), number(), number()} - origin);
  }
}

}  // namespace zoneplate
