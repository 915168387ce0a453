// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/formats/ply/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <type_traits>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
double read_as(const std::uint8_t* at, bool is_big) {
  std::uint8_t bytes[sizeof(T)];
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes[i] = at[is_big ? sizeof(T) - 1 - i : i];
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return static_cast<double>(value);
}

/// The number of a list's items; nothing if the stored value is not a valid count.
std::optional<std::uint32_t> list_count(const std::uint8_t* at, PlyType type, PlyOrder order) {
  const double count = read_ply_value(at, type, order);
  if (!(count >= 0 && count < 0x1p32) || count != std::floor(count)) return std::nullopt;
  return static_cast<std::uint32_t>(count);
}

[[noreturn]] void fail(const ImportBudget& budget, const PlyElement& element, const std::string& cause) {
  throw Error(ErrorKind::Input, fmt::format("{}: element {}: {}", budget.file(), element.name, cause));
}

/// Iterates over rows one by one, and checks that each is within the body.
class Walker {
 public:
  Walker(const PlyElement& element, PlyOrder order, std::span<const std::uint8_t> body, ImportBudget& budget)
      : element_(element), order_(order), body_(body), budget_(budget) {}

  /// The offset of the end of the row at offset `at`.
  std::uint64_t next(std::uint64_t row, std::uint64_t at) const {
    for (const PlyProperty& p : element_.properties) {
      std::uint64_t items = 1;
      if (p.is_list) {
        need(row, at, size_of(p.count_type));
        const std::optional<std::uint32_t> count = list_count(&body_[at], p.count_type, order_);
        if (!count) fail(budget_, element_, fmt::format("row {}: {} has no number of items", row, p.name));
        items = *count;
        at += size_of(p.count_type);
      }
      need(row, at, items * size_of(p.type));
      at += items * size_of(p.type);
    }
    return at;
  }

 private:
  void need(std::uint64_t row, std::uint64_t at, std::uint64_t bytes) const {
    if (bytes > body_.size() - at)
      fail(budget_, element_, fmt::format("the file ends in row {} of {}", row, element_.count));
  }

  const PlyElement& element_;
  PlyOrder order_;
  std::span<const std::uint8_t> body_;
  ImportBudget& budget_;
};

/// Whether the lists of all rows are as long as those of the first row, whose size is `stride` bytes.
bool are_alike(const PlyElement& element, PlyOrder order, const std::uint8_t* data, std::uint64_t stride) {
  struct Check {
    std::uint64_t offset;
    std::size_t size;
  };
  std::vector<Check> checks;
  std::uint64_t offset = 0;
  for (const PlyProperty& p : element.properties) {
    std::uint64_t items = 1;
    if (p.is_list) {
      checks.push_back({offset, size_of(p.count_type)});
      items = list_count(data + offset, p.count_type, order).value_or(0);
      offset += size_of(p.count_type);
    }
    offset += items * size_of(p.type);
  }
  std::atomic<bool> differ = false;
  parallel_ranges(static_cast<std::size_t>(element.count), PlyRows::block, [&](std::size_t begin, std::size_t end) {
    if (differ) return;
    int difference = 0;
    for (const auto& [at, size] : checks) {
      if (size == 1)
        for (std::size_t i = begin; i < end; ++i) difference |= data[i * stride + at] ^ data[at];
      else
        for (std::size_t i = begin; i < end; ++i) difference |= std::memcmp(data + i * stride + at, data + at, size);
    }
    if (difference != 0) differ = true;
  });
  return !differ;
}

/// A word that is not a number.
struct WordError {
  const char* at;
  std::string word;
};

/// Parses integers of up to 15 digits on a fast path, and other numbers with the standard library's exact conversion.
double parse_number(const char* begin, const char* end) {
  const bool is_negative = *begin == '-';
  const char* at = begin + (is_negative || *begin == '+' ? 1 : 0);
  std::int64_t whole = 0;
  const char* const digits = at;
  while (at != end && *at >= '0' && *at <= '9' && at - digits < 15) whole = whole * 10 + (*at++ - '0');
  if (at == end && at != digits) return static_cast<double>(is_negative ? -whole : whole);
  double value = 0;
  const auto [stop, trouble] = std::from_chars(*begin == '+' ? begin + 1 : begin, end, value);
  if (stop != end || trouble == std::errc::invalid_argument)
    throw WordError{begin, std::string(begin, static_cast<std::size_t>(std::min<std::ptrdiff_t>(end - begin, 40)))};
  return value;  // 0 if the number underflows or overflows
}

/// Appends the numbers of a part, up to its end or to a word that is not a number.
void parse_numbers(std::string_view part, std::vector<double>& out) {
  out.reserve(part.size() / 6);
  const char* at = part.data();
  const char* const end = at + part.size();
  while (true) {
    while (at != end && is_ply_space(*at)) ++at;
    if (at == end) return;
    const char* const begin = at;
    while (at != end && !is_ply_space(*at)) ++at;
    out.push_back(parse_number(begin, at));
  }
}

/// Iterates over the lines of a body that hold a word.
class BodyLines {
 public:
  explicit BodyLines(std::string_view body) : rest_(body) {}

  /// The next line; nothing after the last.
  std::optional<std::string_view> next() {
    while (!rest_.empty()) {
      const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
      const std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      if (!std::all_of(line.begin(), line.end(), is_ply_space)) return line;
    }
    return std::nullopt;
  }

 private:
  std::string_view rest_;
};

/// How many of the numbers from the front on belong to a row of an element; nothing if there are fewer.
std::optional<std::size_t> numbers_of_row(const PlyElement& element, std::span<const double> numbers) {
  std::size_t n = 0;
  for (const PlyProperty& p : element.properties) {
    if (n >= numbers.size()) return std::nullopt;
    const double items = p.is_list ? numbers[n] : 1;
    if (p.is_list) ++n;
    if (!(items >= 0) || items > static_cast<double>(numbers.size() - n)) return std::nullopt;
    n += static_cast<std::size_t>(items);
  }
  return n;
}

/// How many of the numbers the rows of all elements take; nothing if there are too few.
std::optional<std::size_t> numbers_of_rows(const PlyHeader& header, std::span<const double> numbers,
                                           ImportBudget& budget) {
  const std::size_t all = numbers.size();
  for (const PlyElement& element : header.elements)
    for (std::uint64_t row = 0; row < element.count && !element.properties.empty(); ++row) {
      if (row % PlyRows::block == 0) budget.check_time();
      const std::optional<std::size_t> own = numbers_of_row(element, numbers);
      if (!own) return std::nullopt;
      numbers = numbers.subspan(*own);
    }
  return all - numbers.size();
}

/// Whether rows have more values than the header states (as VCGLIB writes some), so that only lines separate them:
/// each row has a line of its own, and that of an element's first row has more numbers than it needs.
bool needs_lines(std::string_view body, const PlyHeader& header, ImportBudget& budget) {
  BodyLines lines(body);
  bool has_more = false;
  for (const PlyElement& element : header.elements)
    for (std::uint64_t row = 0; row < element.count; ++row) {
      if (row % PlyRows::block == 0) budget.check_time();
      const std::optional<std::string_view> line = lines.next();
      if (!line) return false;
      if (row > 0) continue;
      std::vector<double> numbers;
      parse_numbers(*line, numbers);
      const std::optional<std::size_t> own = numbers_of_row(element, numbers);
      if (!own) return false;
      has_more = has_more || *own < numbers.size();
    }
  return has_more;
}

/// The numbers of each row's line that belong to its element.
std::vector<double> parse_lines(std::string_view body, const PlyHeader& header, ImportBudget& budget) {
  std::vector<double> out;
  BodyLines lines(body);
  for (const PlyElement& element : header.elements)
    for (std::uint64_t row = 0; row < element.count; ++row) {
      if (row % PlyRows::block == 0) budget.check_time();
      const std::optional<std::string_view> line = lines.next();
      if (!line) return out;  // find_ply_rows reports what is missing
      std::vector<double> numbers;
      parse_numbers(*line, numbers);
      const std::optional<std::size_t> own = numbers_of_row(element, numbers);
      if (!own)
        throw Error(ErrorKind::Input,
                    fmt::format("{}: element {}: row {} has too few values", budget.file(), element.name, row));
      out.insert(out.end(), numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(*own));
    }
  return out;
}

std::vector<std::string_view> cut_at_spaces(std::string_view text) {
  constexpr std::size_t chunk_bytes = std::size_t{1} << 20;
  std::vector<std::string_view> parts;
  while (!text.empty()) {
    std::size_t end = std::min(chunk_bytes, text.size());
    while (end < text.size() && !is_ply_space(text[end])) ++end;
    parts.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return parts;
}

}  // namespace

double read_ply_value(const std::uint8_t* at, PlyType type, PlyOrder order) {
  const bool is_big = order == PlyOrder::Big;
  switch (type) {
    case PlyType::Int8:
      return read_as<std::int8_t>(at, is_big);
    case PlyType::Uint8:
      return *at;
    case PlyType::Int16:
      return read_as<std::int16_t>(at, is_big);
    case PlyType::Uint16:
      return read_as<std::uint16_t>(at, is_big);
    case PlyType::Int32:
      return read_as<std::int32_t>(at, is_big);
    case PlyType::Uint32:
      return read_as<std::uint32_t>(at, is_big);
    case PlyType::Float:
      return static_cast<double>(read_as<float>(at, is_big));
    case PlyType::Double:
      break;
  }
  return read_as<double>(at, is_big);
}

PlyRows find_ply_rows(const PlyElement& element, PlyOrder order, std::span<const std::uint8_t> body,
                      ImportBudget& budget) {
  PlyRows rows{.element = &element, .order = order, .data = body.data()};
  const bool has_list =
      std::any_of(element.properties.begin(), element.properties.end(), [](const PlyProperty& p) { return p.is_list; });
  if (element.count == 0 || element.properties.empty()) return rows;

  // If all rows are as long as the first one, offsets are computed; else all rows are scanned. Counts are below 2^48.
  const Walker walker(element, order, body, budget);
  const std::uint64_t stride = walker.next(0, 0);
  const bool fits = stride <= body.size() / element.count;
  if (!has_list && !fits)
    fail(budget, element,
         fmt::format("{} rows of {} bytes, but {} bytes are left", element.count, stride, body.size()));
  if (fits && are_alike(element, order, body.data(), stride)) {
    rows.stride = stride;
    rows.size = stride * element.count;
    return rows;
  }
  for (std::uint64_t i = 0; i < element.count; ++i) {
    if (i % PlyRows::block == 0) {
      budget.check_time();
      budget.take(sizeof(rows.starts[0]));
      rows.starts.push_back(rows.size);
    }
    rows.size = walker.next(i, rows.size);
  }
  return rows;
}

const std::uint8_t* place_ply_row(const PlyRows& rows, const std::uint8_t* row, std::span<PlyPlace> places) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    const PlyProperty& p = rows.element->properties[i];
    std::uint32_t count = 1;
    if (p.is_list) {
      count = list_count(row, p.count_type, rows.order).value_or(0);
      row += size_of(p.count_type);
    }
    places[i] = {row, count};
    row += count * size_of(p.type);
  }
  return row;
}

std::vector<PlyPlace> first_ply_row(const PlyRows& rows) {
  std::vector<PlyPlace> places(rows.element->properties.size());
  place_ply_row(rows, rows.data, places);
  return places;
}

const std::uint8_t* floats_in_a_row(const PlyRows& rows, std::span<const std::size_t> properties) {
  if (rows.size == 0 || rows.stride == 0 || rows.order == PlyOrder::Big) return nullptr;
  for (std::size_t c = 0; c < properties.size(); ++c)
    if (properties[c] != properties[0] + c || rows.element->properties[properties[c]].type != PlyType::Float)
      return nullptr;
  return first_ply_row(rows)[properties[0]].at;
}

void read_ply_column(const PlyRows& rows, std::size_t begin, std::size_t end, std::size_t property, float* out,
                     std::size_t stride) {
  const PlyType type = rows.element->properties[property].type;
  if (rows.stride == 0) {
    for_ply_rows(rows, begin, end, [&](std::size_t i, std::span<const PlyPlace> places) {
      out[(i - begin) * stride] = static_cast<float>(read_ply_value(places[property].at, type, rows.order));
    });
    return;
  }
  const std::uint8_t* at = first_ply_row(rows)[property].at + begin * rows.stride;
  if (type == PlyType::Float && rows.order != PlyOrder::Big) {
    for (std::size_t i = 0; i < end - begin; ++i, at += rows.stride) std::memcpy(out + i * stride, at, sizeof(float));
  } else if (type == PlyType::Uint8) {
    for (std::size_t i = 0; i < end - begin; ++i, at += rows.stride) out[i * stride] = *at;
  } else {
    for (std::size_t i = 0; i < end - begin; ++i, at += rows.stride)
      out[i * stride] = static_cast<float>(read_ply_value(at, type, rows.order));
  }
}

void state_doubles(PlyHeader& header) {
  for (PlyElement& element : header.elements)
    for (PlyProperty& p : element.properties) p.type = p.count_type = PlyType::Double;
}

std::vector<double> parse_ply_numbers(std::string_view text, std::size_t begin, std::size_t end,
                                      const std::string& file) {
  std::vector<double> numbers;
  try {
    parse_numbers(text.substr(begin, end - begin), numbers);
  } catch (const WordError& error) {
    const auto line = 1 + std::count(text.data(), error.at, '\n');
    throw Error(ErrorKind::Input, fmt::format("{}: line {}: '{}' is not a number", file, line, error.word));
  }
  return numbers;
}

std::vector<double> parse_ply_text(std::string_view body, std::size_t lines_before, PlyHeader& header,
                                   ImportBudget& budget) {
  const std::vector<std::string_view> parts = cut_at_spaces(body);
  std::vector<std::vector<double>> numbers(parts.size());
  std::vector<std::optional<WordError>> errors(parts.size());
  std::atomic<std::uint64_t> made = 0;
  const std::uint64_t most = budget.memory_left();
  parallel_for(parts.size(), [&](std::size_t i) {
    if (!budget.has_time() || made > most) return;
    try {
      parse_numbers(parts[i], numbers[i]);
    } catch (WordError& error) {
      errors[i] = std::move(error);
    }
    made += numbers[i].capacity() * sizeof(double);
  });
  budget.check_time();
  budget.take(made);
  const auto error = std::find_if(errors.begin(), errors.end(), [](const auto& e) { return e.has_value(); });
  if (error != errors.end())
    std::fill(numbers.begin() + (error - errors.begin()) + 1, numbers.end(), std::vector<double>());

  std::vector<std::size_t> first(parts.size() + 1);
  for (std::size_t i = 0; i < parts.size(); ++i) first[i + 1] = first[i] + numbers[i].size();
  budget.take(first.back() * sizeof(double));
  std::vector<double> all(first.back());
  parallel_for(parts.size(), [&](std::size_t i) {
    std::copy(numbers[i].begin(), numbers[i].end(), all.begin() + static_cast<std::ptrdiff_t>(first[i]));
    numbers[i] = {};
  });
  const std::optional<std::size_t> used = numbers_of_rows(header, all, budget);
  if (error != errors.end()) {
    const std::string& word = (*error)->word;
    const auto line = static_cast<std::size_t>(std::count(body.data(), (*error)->at, '\n')) + lines_before + 1;
    if (!used)
      throw Error(ErrorKind::Input, fmt::format("{}: line {}: '{}' is not a number", budget.file(), line, word));
    header.warnings.push_back(
        fmt::format("{}: line {}: '{}' follows the last row, the rest is ignored", budget.file(), line, word));
    all.resize(*used);
  } else if (used != all.size() && needs_lines(body, header, budget)) {
    // Fewer numbers than before, in a list that grows while the rows are read.
    budget.take(2 * all.size() * sizeof(double));
    const std::size_t before = all.size();
    all = {};
    all = parse_lines(body, header, budget);
    budget.give_back((3 * before - all.size()) * sizeof(double));
    header.warnings.push_back(budget.file() + ": rows have more values than the header states, the rest is ignored");
  }
  state_doubles(header);
  return all;
}

}  // namespace zoneplate
