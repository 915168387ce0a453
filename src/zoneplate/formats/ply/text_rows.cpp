// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/ply/text_rows.h"

#include <algorithm>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

constexpr std::size_t chunk_bytes = std::size_t{1} << 20;

std::size_t count_words(std::string_view text, std::size_t begin, std::size_t end) {
  std::size_t words = !is_ply_space(text[begin]) && (begin == 0 || is_ply_space(text[begin - 1])) ? 1 : 0;
  const char* const at = text.data();
  for (std::size_t i = begin + 1; i < end; ++i) words += !is_ply_space(at[i]) && is_ply_space(at[i - 1]) ? 1 : 0;
  return words;
}

/// Calls visit(begin, end) for the chunks of the text from `body` on, some at a time.
template <class Visit>
void for_chunks(std::string_view text, std::size_t body, const ImportBudget& budget,
                const std::function<void(std::string_view)>& done, const Visit& visit) {
  constexpr std::size_t step = 64;
  const std::size_t chunks = (text.size() - body + chunk_bytes - 1) / chunk_bytes;
  for (std::size_t first = 0; first < chunks; first += step) {
    const std::size_t count = std::min(step, chunks - first), begin = body + first * chunk_bytes;
    parallel_for(count, [&](std::size_t i) {
      const std::size_t at = begin + i * chunk_bytes;
      visit(first + i, at, std::min(at + chunk_bytes, text.size()));
    });
    budget.check_time();
    done(text.substr(begin, count * chunk_bytes));
  }
}

}  // namespace

std::optional<PlyTextRows::Layout> PlyTextRows::lay_out(std::string_view text, std::size_t body, const Shape& shape,
                                                        const ImportBudget& budget,
                                                        const std::function<void(std::string_view)>& done) {
  std::vector<std::uint64_t> before((text.size() - body + chunk_bytes - 1) / chunk_bytes + 1);  // words, by chunk
  for_chunks(text, body, budget, done, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    before[chunk + 1] = count_words(text, begin, end);
  });
  for (std::size_t i = 1; i < before.size(); ++i) before[i] += before[i - 1];
  // Each word has a character and a space, so that no product of a file's own numbers overflows.
  for (int e = 0; e < 2; ++e)
    if (shape.values[e] == 0 || shape.rows[e] > text.size() / shape.values[e]) return std::nullopt;
  const std::uint64_t of_first = shape.rows[0] * shape.values[0];
  if (before.back() != of_first + shape.rows[1] * shape.values[1]) return std::nullopt;

  std::vector<std::uint64_t> words;  // at which the parts begin
  for (int e = 0; e < 2; ++e)
    for (std::uint64_t row = 0; row < shape.rows[e]; row += block)
      words.push_back((e == 0 ? 0 : of_first) + row * shape.values[e]);
  Layout layout(words.size() + 1, text.size());
  for_chunks(text, body, budget, done, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    std::uint64_t word = before[chunk];
    auto next = std::lower_bound(words.begin(), words.end(), word);
    for (std::size_t i = begin; i < end && next != words.end() && *next < before[chunk + 1]; ++i) {
      if (is_ply_space(text[i]) || (i > 0 && !is_ply_space(text[i - 1]))) continue;
      if (word++ == *next) layout[static_cast<std::size_t>(next++ - words.begin())] = i;
    }
  });
  return layout;
}

PlyTextRows::PlyTextRows(std::string_view text, const Shape& shape, Layout layout, std::string file,
                         std::uint64_t capacity)
    : text_(text),
      shape_(shape),
      layout_(std::move(layout)),
      file_(std::move(file)),
      parts_(layout_.size() - 1, capacity, [this](std::size_t part) { return read(part); }) {}

PlyNumbers PlyTextRows::read(std::size_t part) const {
  const int element = part < first_part(1) ? 0 : 1;
  const std::uint64_t first = (part - first_part(element)) * block;
  const std::uint64_t rows = std::min<std::uint64_t>(block, shape_.rows[element] - first);
  PlyNumbers out{parse_ply_numbers(text_, static_cast<std::size_t>(layout_[part]),
                                   static_cast<std::size_t>(layout_[part + 1]), file_)};
  if (out.values.size() != rows * shape_.values[element])
    throw Error(ErrorKind::Input, file_ + ": was changed while it was read");
  out.values.shrink_to_fit();
  return out;
}

}  // namespace zoneplate
