// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/obj/parse.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/large_array.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/scene/geometry/origin.h"

namespace zoneplate {
namespace {

constexpr std::size_t chunk_bytes = std::size_t{1} << 20;

/// Cuts the text after line ends that are not continued by a backslash. A part is slightly larger than `chunk_bytes`.
std::vector<std::string_view> cut(std::string_view text, char separator,
                                  const std::function<void(std::string_view)>& done) {
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
    done(parts.back());
  }
  return parts;
}

/// The counts before each part, followed by the totals.
std::vector<ObjCounts> accumulate(const std::vector<ObjPart>& parts) {
  std::vector<ObjCounts> before(1);
  for (const ObjPart& part : parts) {
    const ObjCounts &own = part.counts, sum = before.back();
    before.push_back(
        {sum.lines + own.lines, sum.positions + own.positions, sum.uvs + own.uvs, sum.normals + own.normals});
  }
  return before;
}

/// Concatenates one kind of data of all parts, and frees it in the parts.
template <class V, class Member>
void join(std::vector<ObjPart>& parts, Member member, std::uint64_t count, std::vector<V>& out) {
  if (parts.size() == 1) return std::swap(out, parts.front().vertices.*member);
  reserve_large(out, count);
  for (ObjPart& part : parts) {
    std::vector<V> own = std::move(part.vertices.*member);
    out.insert(out.end(), own.begin(), own.end());
  }
}

void join_colors(const std::vector<ObjPart>& parts, const std::vector<ObjCounts>& before, ImportBudget& budget,
                 ObjFile& file) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].vertices.colors.empty()) continue;
    if (file.colors.empty()) {
      budget.take(file.positions.size() * sizeof(float4));
      file.colors.assign(file.positions.size(), {1, 1, 1, 1});
    }
    for (const auto& [index, color] : parts[i].vertices.colors) file.colors[before[i].positions + index] = color;
  }
}

/// The origin of the vertices that an element uses; of all, in a file without elements. Stops at a near part of a
/// chunk.
double3 choose_origin(const ObjFile& file) {
  constexpr std::size_t some = 64;
  std::vector<OriginChoice> parts(file.chunks.size());
  const auto add = [&](std::size_t chunk, std::size_t most) {
    const auto& corners = file.chunks[chunk].corners;
    for (std::size_t i = 0; i < std::min<std::size_t>(corners.size(), most); ++i)
      parts[chunk].add(file.positions[corners.position(i)]);
  };
  for (std::size_t k = 0; k < parts.size(); ++k) {
    add(k, some);
    if (parts[k].is_near()) return {};
  }
  parallel_for(parts.size(), [&](std::size_t k) { add(k, file.chunks[k].corners.size()); });
  OriginChoice choice;
  for (const OriginChoice& part : parts) choice.add(part);
  if (choice.is_empty()) choice.add(file.positions);
  return choice.origin();
}

/// Reads the positions again where floats lose too much of them: in files far from the origin.
void center_far_positions(const ObjText& text, const std::vector<ObjCounts>& before, ImportBudget& budget,
                          const std::function<void(std::string_view)>& done, ObjFile& file) {
  file.origin = choose_origin(file);
  if (file.origin == double3{}) return;
  const std::span<float3> positions = file.positions;
  parallel_for(text.parts.size(), [&](std::size_t i) {
    if (!budget.has_time()) return;
    const auto begin = static_cast<std::size_t>(before[i].positions);
    const std::size_t count = static_cast<std::size_t>(before[i + 1].positions) - begin;
    read_obj_positions(text.parts[i], text.separator, file.origin, positions.subspan(begin, count));
    done(text.parts[i]);
  });
  budget.check_time();
}

}  // namespace

ObjText cut_obj(std::span<const std::uint8_t> bytes, const std::string& file,
                const std::function<void(std::string_view)>& done) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (const std::string_view mark = text.substr(0, 2); mark == "\xff\xfe" || mark == "\xfe\xff")
    throw Error(ErrorKind::Input, file + ": is text in UTF-16, expected UTF-8 or ASCII");
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);
  const char separator = text.find('\n') == text.npos && text.find('\r') != text.npos ? '\r' : '\n';
  return {separator, cut(text, separator, done)};
}

std::vector<ObjCounts> read_obj_parts(const ObjText& text, ImportBudget& budget,
                                      const std::function<void(std::string_view)>& done,
                                      const std::function<void(std::size_t, ObjPart&)>& keep,
                                      std::vector<ObjPart>& parts) {
  const std::vector<std::string_view>& texts = text.parts;
  parts.resize(texts.size());
  std::vector<char> is_read(parts.size());
  std::atomic<std::uint64_t> bytes = 0;
  parallel_for(parts.size(), [&](std::size_t i) {
    if (!budget.has_time() || bytes > budget.limits().memory) return;
    is_read[i] = read_obj_part(texts[i], text.separator, parts[i]);
    if (is_read[i]) keep(i, parts[i]);
    bytes += parts[i].bytes();
    done(texts[i]);
  });
  budget.check_time();
  const std::vector<ObjCounts> before = accumulate(parts);
  const ObjCounts& all = before.back();
  if (std::max({all.positions, all.uvs, all.normals}) >= max_obj_items)
    throw Error(ErrorKind::Input, budget.file() + ": more than 2^30 vertices");

  // The first error in the order of the file is reported, independently of the threads.
  std::vector<std::optional<ObjLineError>> errors(parts.size());
  parallel_for(parts.size(), [&](std::size_t i) {
    const ObjCounts& named = parts[i].named;
    const bool are_there = named.positions <= all.positions && named.uvs <= all.uvs && named.normals <= all.normals;
    for (ObjTally& tally : parts[i].chunk.notes) tally.line += before[i].lines;
    if ((is_read[i] && are_there) || !budget.has_time() || bytes > budget.limits().memory) return;
    bytes -= parts[i].bytes();
    try {
      read_obj_part(texts[i], text.separator, before[i], all, parts[i]);
      keep(i, parts[i]);
    } catch (ObjLineError& error) {
      errors[i] = std::move(error);
    }
    bytes += parts[i].bytes();
    done(texts[i]);
  });
  budget.check_time();
  budget.take(bytes);
  for (const std::optional<ObjLineError>& error : errors)
    if (error) throw Error(ErrorKind::Input, fmt::format("{}: line {}: {}", budget.file(), error->line, error->cause));
  return before;
}

void report_obj_notes(const ObjFile& file, const ImportBudget& budget, std::vector<std::string>& warnings) {
  constexpr const char* texts[] = {"has too few corners and is dropped",
                                   "is dropped",
                                   "is free-form geometry, which is not drawn",
                                   "is unknown and ignored",
                                   "is not finite and set to 0",
                                   "index out of range, treated as absent",
                                   "index out of range, treated as absent"};
  for (std::size_t kind = 0; kind < std::size(texts); ++kind) {
    ObjTally sum;
    for (const ObjChunk& chunk : file.chunks) {
      const ObjTally& tally = chunk.notes[kind];
      if (sum.count == 0) sum.line = tally.line, sum.word = tally.word;
      sum.count += tally.count;
    }
    if (sum.count == 0) continue;
    const std::string more = sum.count > 1 ? fmt::format(" (and {} more)", sum.count - 1) : "";
    const std::string text = fmt::format("{}: line {}: {} {}{}", budget.file(), sum.line, sum.word, texts[kind], more);
    if (kind == static_cast<std::size_t>(ObjNote::BadCorner))
      budget.warn_of_flaw(warnings, text);
    else
      warnings.push_back(text);
  }
}

ObjFile parse_obj(const ObjText& text, ImportBudget& budget, const std::function<void(std::string_view)>& done) {
  std::vector<ObjPart> parts;
  const std::vector<ObjCounts> before = read_obj_parts(
      text, budget, done, [](std::size_t, ObjPart&) {}, parts);

  ObjFile file;
  std::uint64_t corners = 0;
  for (const ObjPart& part : parts) {
    corners += part.chunk.corners.size();
    file.has_odd_position = file.has_odd_position || part.vertices.has_odd_position;
    file.has_odd_normal = file.has_odd_normal || part.vertices.has_odd_normal;
  }
  if (corners >= 0xffffffffu) throw Error(ErrorKind::Input, budget.file() + ": more than 2^32 corners");
  const ObjCounts& all = before.back();
  const auto join_kind = [&](std::size_t i) {
    if (i == 0) join(parts, &ObjVertices::positions, all.positions, file.positions);
    if (i == 1) join(parts, &ObjVertices::uvs, all.uvs, file.uvs);
    if (i == 2) join(parts, &ObjVertices::normals, all.normals, file.normals);
  };
  if (parts.size() > 1)
    parallel_for(3, join_kind);
  else
    for (std::size_t i = 0; i < 3; ++i) join_kind(i);
  join_colors(parts, before, budget, file);
  for (ObjPart& part : parts) file.chunks.push_back(std::move(part.chunk));
  center_far_positions(text, before, budget, done, file);
  return file;
}

}  // namespace zoneplate
