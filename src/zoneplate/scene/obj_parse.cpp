#include "zoneplate/scene/obj_parse.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/scene/obj_text.h"

namespace zoneplate {
namespace {

constexpr std::size_t chunk_bytes = std::size_t{1} << 20;
constexpr std::uint64_t most_items = 1u << 30;  // of one kind, and corners of one chunk

/// How many of each there are: in a chunk, or before it.
struct Counts {
  std::uint64_t lines = 0, positions = 0, uvs = 0, normals = 0;
};

/// A cause of refusal with its line; thrown within a chunk only.
struct LineError {
  std::uint64_t line;
  std::string cause;
};

/// Cuts the text after line ends that no backslash continues, each part a little more than `chunk_bytes`.
std::vector<std::string_view> cut(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (!text.empty()) {
    std::size_t end = std::min(chunk_bytes, text.size());
    while (end < text.size()) {
      end = text.find(separator, end);
      if (end == text.npos) {
        end = text.size();
        break;
      }
      const std::size_t last = separator == '\n' ? text.find_last_not_of('\r', end - 1) : end - 1;
      ++end;
      if (last == text.npos || text[last] != '\\') break;
    }
    parts.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return parts;
}

Counts count(std::string_view part, char separator) {
  Counts counts;
  TextLines lines(part, 0, separator);
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

/// Reads one chunk into its place.
class ChunkReader {
 public:
  ChunkReader(ObjFile& file, ObjChunk& chunk, const Counts& before) : file_(file), chunk_(chunk), at_(before) {}

  /// The colours found: the number of the position, and its colour.
  std::vector<std::pair<std::uint64_t, float4>> colors;

  void read(std::string_view part, char separator) {
    TextLines lines(part, at_.lines + 1, separator);
    while (lines.next()) {
      line_ = lines.number();
      if (read_plain(lines.line())) continue;
      LineWords words(lines.line());
      read_statement(words.next(), words);
    }
  }

 private:
  /// Nearly all lines, at full speed: vertices and faces without surprises. False where read_statement has to look.
  bool read_plain(std::string_view line) {
    const char* const at = line.data();
    const char* const end = at + line.size();
    if (line.size() < 3 || at[line[1] == 't' || line[1] == 'n' ? 2 : 1] != ' ') return false;
    if (at[0] == 'f') return read_plain_face(at + 1, end);
    if (at[0] != 'v') return false;
    std::array<float, 3> v{};
    if (at[1] == 't') {
      if (!scan_numbers(at + 2, end, 2, v)) return false;
      file_.uvs[at_.uvs++] = {v[0], v[1]};
    } else if (!scan_numbers(at + (at[1] == 'n' ? 2 : 1), end, 3, v)) {
      return false;
    } else if (at[1] == 'n') {
      add_normal(v);
    } else {
      file_.positions[at_.positions++] = {v[0], v[1], v[2]};
    }
    return true;
  }

  /// Whether the text is just so many numbers.
  static bool scan_numbers(const char* at, const char* end, std::size_t n, std::array<float, 3>& out) {
    for (std::size_t i = 0; i < n; ++i) {
      while (at != end && *at == ' ') ++at;
      at = scan_number(at, end, out[i]);
      if (at == nullptr) return false;
    }
    while (at != end && (*at == ' ' || *at == '\r')) ++at;
    return at == end;
  }

  /// A whole number from 1 to `most` without a sign, as an index from 0; `at` moves behind it. -1 for anything else.
  static std::int32_t scan_index(const char*& at, const char* end, std::size_t most) {
    std::uint64_t value = 0;
    const char* const first = at;
    for (; at != end && *at >= '0' && *at <= '9'; ++at) value = value * 10 + static_cast<std::uint64_t>(*at - '0');
    return at - first > 10 || value == 0 || value > most ? -1 : static_cast<std::int32_t>(value - 1);
  }

  bool read_plain_face(const char* at, const char* end) {
    const std::size_t first = chunk_.corners.size();
    const auto give_up = [&] {
      chunk_.corners.resize(first);
      return false;
    };
    while (true) {
      while (at != end && (*at == ' ' || *at == '\r')) ++at;
      if (at == end) break;
      ObjCorner corner;
      if ((corner.position = scan_index(at, end, file_.positions.size())) < 0) return give_up();
      if (at != end && *at == '/') {
        ++at;
        if (at != end && *at != '/' && (corner.uv = scan_index(at, end, file_.uvs.size())) < 0) return give_up();
        if (at != end && *at == '/' && (corner.normal = scan_index(++at, end, file_.normals.size())) < 0)
          return give_up();
      }
      if (at != end && *at != ' ' && *at != '\r') return give_up();
      chunk_.corners.push_back(corner);
    }
    const std::size_t n = chunk_.corners.size() - first;
    if (n < 3 || chunk_.corners.size() >= most_items) return give_up();
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
    note(is_free_form ? ObjNote::FreeForm : ObjNote::Unknown, word);
  }

  void note(ObjNote kind, std::string_view word) {
    ObjTally& tally = chunk_.notes[static_cast<std::size_t>(kind)];
    if (tally.count++ == 0) tally.line = line_, tally.word = word.substr(0, 40);
  }

  [[noreturn]] void fail(std::string cause) const { throw LineError{line_, std::move(cause)}; }

  /// The numbers of the line, at most as many as `out` holds.
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
    if (i < least) fail(fmt::format("{} has {} numbers, wants {}", what, i, least));
    return i;
  }

  void read_position(LineWords& words) {
    // x y z, with a weight (which only free-form geometry uses), or with a colour and perhaps its alpha.
    std::array<float, 7> v{0, 0, 0, 1, 1, 1, 1};
    const std::size_t n = read_numbers("vertex", 3, words, v);
    if (n >= 6) colors.push_back({at_.positions, {v[3], v[4], v[5], n == 7 ? v[6] : 1}});
    file_.positions[at_.positions++] = {v[0], v[1], v[2]};
  }

  void read_uv(LineWords& words) {
    std::array<float, 2> v{};
    read_numbers("texture coordinate", 1, words, v);
    const bool is_fine = std::isfinite(v[0]) && std::isfinite(v[1]);
    if (!is_fine) note(ObjNote::UvNotFinite, "vt");
    file_.uvs[at_.uvs++] = is_fine ? float2{v[0], v[1]} : float2{0, 0};
  }

  void read_normal(LineWords& words) {
    std::array<float, 3> v{};
    read_numbers("normal", 3, words, v);
    add_normal(v);
  }

  void add_normal(const std::array<float, 3>& v) {
    // In double, so that neither long nor short normals are lost.
    const double x = v[0], y = v[1], z = v[2], length = std::sqrt(x * x + y * y + z * z);
    const bool is_fine = std::isfinite(length) && length > 0;
    file_.normals[at_.normals++] =
        is_fine ? float3{static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length)}
                : float3{0, 0, 0};
  }

  struct Index {
    std::int64_t given = 0;
    std::int32_t found = -1;  ///< -1 where there is none
  };

  /// The next index of a corner's text: absolute from 1, or negative from the last one so far.
  Index read_index(const char*& at, const char* end, std::uint64_t so_far, std::uint64_t all, const char* what) const {
    std::int64_t value = 0;
    const char* const begin = at != end && *at == '+' ? at + 1 : at;
    const auto [stop, trouble] = std::from_chars(begin, end, value);
    if (trouble == std::errc::invalid_argument)
      fail(fmt::format("{}: '{}' is not an index", what, std::string_view(at, static_cast<std::size_t>(end - at))));
    at = stop;
    if (trouble != std::errc{}) value = std::numeric_limits<std::int64_t>::max();
    const std::int64_t index = value < 0 ? static_cast<std::int64_t>(so_far) + value : value - 1;
    const bool is_there = index >= 0 && index < static_cast<std::int64_t>(all);
    return {value, is_there ? static_cast<std::int32_t>(index) : -1};
  }

  std::int32_t read_optional_index(const char*& at, const char* end, std::uint64_t so_far, std::uint64_t all,
                                   const char* what, ObjNote missing) {
    const std::int32_t found = read_index(at, end, so_far, all, what).found;
    if (found < 0) note(missing, what);
    return found;
  }

  ObjCorner read_corner(std::string_view word, const char* what) {
    const char* at = word.data();
    const char* const end = at + word.size();
    ObjCorner corner;
    const Index position = read_index(at, end, at_.positions, file_.positions.size(), what);
    if (position.found < 0)
      fail(fmt::format("{} index {} out of range ({} vertices)", what, position.given, file_.positions.size()));
    corner.position = position.found;
    if (at != end && *at == '/') {
      ++at;
      if (at != end && *at != '/')
        corner.uv = read_optional_index(at, end, at_.uvs, file_.uvs.size(), "texture coordinate", ObjNote::NoSuchUv);
      if (at != end && *at == '/' && ++at != end)
        corner.normal =
            read_optional_index(at, end, at_.normals, file_.normals.size(), "normal", ObjNote::NoSuchNormal);
    }
    if (at != end) fail(fmt::format("{}: '{}' is not v, v/vt, v//vn or v/vt/vn", what, word.substr(0, 40)));
    return corner;
  }

  void read_element(ObjKind kind, std::size_t least, LineWords& words) {
    const char* what = kind == ObjKind::Face ? "face" : kind == ObjKind::Line ? "line" : "point";
    const std::size_t first = chunk_.corners.size();
    for (std::string_view word = words.next(); !word.empty(); word = words.next())
      chunk_.corners.push_back(read_corner(word, what));
    const std::size_t n = chunk_.corners.size() - first;
    if (n < least) {
      chunk_.corners.resize(first);
      return note(ObjNote::FewCorners, what);
    }
    if (chunk_.corners.size() >= most_items) fail("too many corners in one statement");
    chunk_.elements.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(n), kind});
  }

  void add_state(ObjStateKind kind, LineWords& words) {
    chunk_.states.push_back({kind, static_cast<std::uint32_t>(chunk_.elements.size()), std::string(words.rest())});
  }

  ObjFile& file_;
  ObjChunk& chunk_;
  Counts at_;
  std::uint64_t line_ = 0;
};

/// Replaces each chunk's counts by what comes before it, and gives the sum.
Counts accumulate(std::vector<Counts>& counts) {
  Counts sum;
  for (Counts& c : counts) {
    const Counts own = std::exchange(c, sum);
    sum.lines += own.lines, sum.positions += own.positions, sum.uvs += own.uvs, sum.normals += own.normals;
  }
  return sum;
}

}  // namespace

ObjFile parse_obj(std::string_view text, ImportBudget& budget) {
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  const char separator = text.find('\n') == text.npos && text.find('\r') != text.npos ? '\r' : '\n';
  const std::vector<std::string_view> parts = cut(text, separator);

  // Count first: then every chunk knows what its relative indices mean, and where its vertices go.
  std::vector<Counts> before(parts.size());
  parallel_for(parts.size(), [&](std::size_t i) { before[i] = count(parts[i], separator); });
  const Counts all = accumulate(before);
  if (std::max({all.positions, all.uvs, all.normals}) >= most_items)
    throw Error(Trouble::Input, budget.file() + ": more than 2^30 vertices");
  budget.take(all.positions * sizeof(float3) + all.uvs * sizeof(float2) + all.normals * sizeof(float3));
  ObjFile file;
  file.positions.resize(all.positions);
  file.uvs.resize(all.uvs);
  file.normals.resize(all.normals);
  file.chunks.resize(parts.size());

  // Whichever thread meets an error, the first line that has one is reported.
  std::vector<std::optional<LineError>> errors(parts.size());
  std::vector<std::vector<std::pair<std::uint64_t, float4>>> colors(parts.size());
  parallel_for(parts.size(), [&](std::size_t i) {
    if (!budget.has_time()) return;
    ChunkReader reader(file, file.chunks[i], before[i]);
    try {
      reader.read(parts[i], separator);
    } catch (LineError& error) {
      errors[i] = std::move(error);
    }
    colors[i] = std::move(reader.colors);
  });
  budget.check_time();
  for (const std::optional<LineError>& error : errors)
    if (error) throw Error(Trouble::Input, fmt::format("{}: line {}: {}", budget.file(), error->line, error->cause));

  std::uint64_t corners = 0;
  for (const ObjChunk& chunk : file.chunks) corners += chunk.corners.size();
  if (corners >= 0xffffffffu) throw Error(Trouble::Input, budget.file() + ": more than 2^32 corners");
  for (const ObjChunk& chunk : file.chunks)
    budget.take(chunk.corners.size() * sizeof(ObjCorner) + chunk.elements.size() * sizeof(ObjElement));
  for (const auto& found : colors) {
    if (found.empty()) continue;
    if (file.colors.empty()) {
      budget.take(file.positions.size() * sizeof(float4));
      file.colors.assign(file.positions.size(), {1, 1, 1, 1});
    }
    for (const auto& [index, color] : found) file.colors[index] = color;
  }
  return file;
}

}  // namespace zoneplate
