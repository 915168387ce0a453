// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/stl/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/import/text_scan.h"
#include "zoneplate/scene/geometry/triangulate.h"

namespace zoneplate {
namespace {

constexpr std::size_t chunk_bytes = std::size_t{1} << 20;

bool is_space(char c) { return static_cast<unsigned char>(c) <= ' '; }

/// Compares words case-insensitively; `word` is in lower case.
bool is_word(std::string_view text, std::string_view word) {
  return text.size() == word.size() && std::equal(text.begin(), text.end(), word.begin(), [](char a, char b) {
           return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
         });
}

bool begins_comment(std::string_view text) { return text[0] == ';' || text[0] == '#' || text.substr(0, 2) == "//"; }

/// Whether the word that begins at `at` is "facet".
bool is_facet(std::string_view text, std::size_t at) {
  return is_word(text.substr(at, 5), "facet") && at + 5 < text.size() && is_space(text[at + 5]);
}

/// An error and its position in the text; it is thrown and caught within a part.
struct TextError {
  const char* at;
  std::string cause;
};

/// Parses one part of the text independently of the others.
class PartReader {
 public:
  PartReader(std::string_view part, double3 origin)
      : at_(part.data()), end_(part.data() + part.size()), origin_(origin), is_far_(origin != double3{}) {}

  StlText read() {
    constexpr std::uint64_t statements_per_check = 4096;
    for (std::uint64_t i = 1; read_statement(); ++i)
      if (i % statements_per_check == 0) check_deadline();
    end_loop();
    return std::move(out_);
  }

 private:
  std::string_view next() {
    while (at_ != end_ && is_space(*at_)) ++at_;
    const char* const begin = at_;
    while (at_ != end_ && !is_space(*at_)) ++at_;
    return {begin, static_cast<std::size_t>(at_ - begin)};
  }

  std::string_view rest_of_line() {
    const char* begin = at_;
    while (at_ != end_ && *at_ != '\n' && *at_ != '\r') ++at_;
    const char* last = at_;
    while (begin != last && is_space(*begin)) ++begin;
    while (last != begin && is_space(last[-1])) --last;
    return {begin, static_cast<std::size_t>(last - begin)};
  }

  /// The rest of the line, or the words before "facet normal" where a program writes all in one line.
  std::string_view name_of_solid() {
    const char* const begin = at_;
    const std::string_view line = rest_of_line();
    const char* const line_end = at_;
    at_ = begin;
    for (std::string_view word = next(); !word.empty() && word.data() < line_end; word = next()) {
      const char* const behind = at_;
      if (is_word(word, "facet") && is_word(next(), "normal")) {
        at_ = word.data();
        std::string_view name = line.substr(0, static_cast<std::size_t>(word.data() - line.data()));
        while (!name.empty() && is_space(name.back())) name.remove_suffix(1);
        return name;
      }
      at_ = behind;
    }
    at_ = line_end;
    return line;
  }

  template <class T>
  T number(std::optional<T> (*find)(std::string_view)) {
    const std::string_view word = next();
    const std::optional<T> value = find(word);
    if (!value) throw TextError{word.data(), fmt::format("'{}' is not a number", word.substr(0, 40))};
    return *value;
  }

  float3 triple() {
    const float x = number(find_number), y = number(find_number);
    return {x, y, number(find_number)};
  }

  float3 place() {
    if (!is_far_) return triple();
    const double x = number(find_double), y = number(find_double);
    return narrowed(double3{x, y, number(find_double)} - origin_);
  }

  void end_loop() {
    if (out_.vertices.size() > begin_) out_.loops.push_back(begin_);
    begin_ = out_.vertices.size();
  }

  bool read_statement() {
    const std::string_view word = next();
    if (word.empty()) return false;
    if (is_word(word, "vertex")) {
      out_.vertices.push_back(place());
    } else if (is_word(word, "normal")) {
      triple();
    } else if (is_word(word, "solid")) {
      end_loop();
      add_solid(out_.solids, {out_.loops.size(), std::string(name_of_solid().substr(0, 200))});
    } else if (is_word(word, "endsolid")) {
      rest_of_line();
    } else if (is_word(word, "endloop") || is_word(word, "endfacet") || is_word(word, "facet")) {
      end_loop();
    } else if (begins_comment(word)) {
      rest_of_line();
    } else if (!is_word(word, "outer") && !is_word(word, "loop")) {
      throw TextError{word.data(), fmt::format("'{}' is not a word of STL", word.substr(0, 40))};
    }
    return true;
  }

  const char* at_;
  const char* end_;
  double3 origin_;
  bool is_far_;
  std::uint64_t begin_ = 0;  ///< the first vertex of the open loop
  StlText out_;
};

[[noreturn]] void throw_at_line(std::string_view text, const TextError& error, const std::string& file) {
  const auto line = 1 + std::count(text.data(), error.at, '\n');
  throw Error(ErrorKind::Input, fmt::format("{}: line {}: {}", file, line, error.cause));
}

StlText join(std::vector<StlText>& parts, ImportBudget& budget) {
  std::uint64_t vertices = 0, loops = 0;
  for (const StlText& part : parts) vertices += part.vertices.size(), loops += part.loops.size();
  budget.take(vertices * sizeof(float3) + loops * sizeof(std::uint64_t));
  StlText out;
  out.vertices.reserve(vertices);
  out.loops.reserve(loops + 1);
  for (StlText& part : parts) {
    for (StlText::Solid& s : part.solids) add_solid(out.solids, {out.loops.size() + s.before, std::move(s.name)});
    for (const std::uint64_t l : part.loops) out.loops.push_back(out.vertices.size() + l);
    out.vertices.insert(out.vertices.end(), part.vertices.begin(), part.vertices.end());
    part = {};
  }
  out.loops.push_back(out.vertices.size());
  return out;
}

}  // namespace

std::size_t find_stl_solid(std::string_view text) {
  std::size_t at = text.substr(0, 3) == "\xef\xbb\xbf" ? 3 : 0;
  while (true) {
    while (at < text.size() && is_space(text[at])) ++at;
    if (at == text.size() || !begins_comment(text.substr(at))) break;
    at = std::min(text.find_first_of("\r\n", at), text.size());
  }
  return is_word(text.substr(at, 5), "solid") ? at : std::string_view::npos;
}

std::vector<std::string_view> cut_stl_text(std::string_view text, const std::function<void(std::string_view)>& done) {
  if (const std::size_t solid = find_stl_solid(text); solid != text.npos) text.remove_prefix(solid);
  std::vector<std::string_view> parts;  // slightly larger than `chunk_bytes`
  while (!text.empty()) {
    std::size_t end = std::min(chunk_bytes, text.size());
    while (end < text.size()) {
      end = std::min(text.find_first_of("\r\n", end), text.size());
      std::size_t word = end;
      while (word < text.size() && is_space(text[word])) ++word;
      if (is_facet(text, word)) break;
      end = word;
    }
    parts.push_back(text.substr(0, end));
    text.remove_prefix(end);
    done(parts.back());
  }
  return parts;
}

StlText parse_stl_part(std::string_view text, std::string_view part, const std::string& file) {
  try {
    StlText out = PartReader(part, double3{}).read();
    out.loops.push_back(out.vertices.size());
    return out;
  } catch (const TextError& error) {
    throw_at_line(text, error, file);
  }
}

void add_solid(std::vector<StlText::Solid>& solids, StlText::Solid solid) {
  if (!solids.empty() && solids.back().before == solid.before)
    solids.back() = std::move(solid);
  else
    solids.push_back(std::move(solid));
}

std::uint64_t add_stl_triangles(const StlText& text, std::uint64_t begin, std::uint64_t end, const ImportBudget& budget,
                                std::vector<float3>& corners) {
  constexpr std::size_t many_corners = 64;  // triangulating a loop of more corners may take long
  constexpr std::uint64_t loops_per_check = 4096;
  std::uint64_t too_short = 0;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint64_t l = begin; l < end; ++l) {
    const std::span<const float3> loop(&text.vertices[text.loops[l]], text.loops[l + 1] - text.loops[l]);
    if ((loop.size() > many_corners || l % loops_per_check == 0) && !budget.has_time()) break;
    triangles.clear();
    if (loop.size() == 3 || !std::all_of(loop.begin(), loop.end(), is_finite))
      triangles.push_back({0, 1, 2});  // non-finite triangles are dropped later
    else
      triangulate(loop, triangles);
    if (loop.size() < 3) triangles.clear(), ++too_short;
    for (const auto& triangle : triangles)
      for (const std::uint32_t i : triangle) corners.push_back(loop[i]);
  }
  return too_short;
}

StlText parse_stl_text(std::string_view text, ImportBudget& budget, double3 origin) {
  const std::vector<std::string_view> cuts = cut_stl_text(text);
  std::vector<StlText> parts(cuts.size());
  std::vector<std::optional<TextError>> errors(cuts.size());
  // A vertex takes at least nine characters, and 40 in most files.
  budget.take(text.size() / 9 * sizeof(float3));
  // Each solid becomes a mesh, and its name also that of an object.
  constexpr std::size_t max_name = 200;
  constexpr std::size_t solid_bytes =
      2 * (sizeof(StlText::Solid) + sizeof(std::string) + sizeof(Mesh) + sizeof(Instance) + max_name);
  std::atomic<std::uint64_t> solids = 0;
  parallel_for(cuts.size(), [&](std::size_t i) {
    if (!budget.has_time() || solids * solid_bytes > budget.memory_left()) return;
    try {
      parts[i] = PartReader(cuts[i], origin).read();
    } catch (TextError& error) {
      errors[i] = std::move(error);
    }
    solids += parts[i].solids.size();
  });
  budget.check_time();
  budget.take(solids * solid_bytes);
  for (const std::optional<TextError>& error : errors)
    if (error) throw_at_line(text, *error, budget.file());
  return join(parts, budget);
}

}  // namespace zoneplate
