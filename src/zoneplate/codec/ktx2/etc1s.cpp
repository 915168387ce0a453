// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/ktx2/etc1s.h"

#include <algorithm>
#include <utility>

#include "zoneplate/base/deadline.h"

namespace zoneplate::ktx2 {
namespace {

constexpr std::size_t max_length_codes = 21;

}  // namespace

HuffmanCode::HuffmanCode(std::span<const std::uint8_t> lengths, const Place& place) {
  for (const std::uint8_t length : lengths)
    if (length > 0) ++count_[length];
  std::uint32_t left = 1;
  for (unsigned length = 1; length <= longest; ++length) {
    left *= 2;
    if (count_[length] > left) place.fail("a Huffman code has too many words");
    left -= count_[length];
  }
  for (unsigned length = 1; length <= longest; ++length)
    for (std::size_t s = 0; s < lengths.size(); ++s)
      if (lengths[s] == length) symbols_.push_back(static_cast<std::uint16_t>(s));
}

/// The lengths are symbols of a Huffman code of their own: 0 to 16, runs of zeros (17, 18) and of the length before
/// (19, 20).
HuffmanCode::HuffmanCode(BitReader& bits) {
  static constexpr std::uint8_t order[max_length_codes] = {17, 18, 19, 20, 0,  8, 7,  9, 6,  10, 5,
                                                           11, 4,  12, 3,  13, 2, 14, 1, 15, 16};
  const std::size_t count = bits.take(14), codes = bits.take(5);
  if (count == 0) return;  // a code that is not used
  if (codes < 1 || codes > max_length_codes) bits.place().fail("a Huffman code has no lengths");
  std::array<std::uint8_t, max_length_codes> sizes{};
  for (std::size_t i = 0; i < codes; ++i) sizes[order[i]] = static_cast<std::uint8_t>(bits.take(3));
  const HuffmanCode of_lengths(sizes, bits.place());

  struct Run {
    unsigned bits;
    std::size_t least;
  };
  static constexpr Run runs[] = {{3, 3}, {7, 11}, {2, 3}, {7, 7}};
  std::vector<std::uint8_t> lengths;
  while (lengths.size() < count) {
    const std::uint32_t symbol = of_lengths.decode(bits);
    if (symbol <= longest) {
      lengths.push_back(static_cast<std::uint8_t>(symbol));
      continue;
    }
    const Run& run = runs[symbol - 17];
    const std::size_t length = run.least + bits.take(run.bits);
    if (symbol >= 19 && (lengths.empty() || lengths.back() == 0)) bits.place().fail("a Huffman code repeats nothing");
    lengths.insert(lengths.end(), length, symbol >= 19 ? lengths.back() : std::uint8_t{0});
  }
  if (lengths.size() != count) bits.place().fail("a Huffman code has too many lengths");
  *this = HuffmanCode(lengths, bits.place());
}

std::uint32_t HuffmanCode::decode(BitReader& bits) const {
  std::uint32_t code = 0, first = 0, index = 0;
  for (unsigned length = 1; length <= longest; ++length) {
    code = code << 1 | bits.bit();
    first <<= 1;
    if (code - first < count_[length]) return symbols_[index + (code - first)];
    index += count_[length], first += count_[length];
  }
  bits.place().fail("a Huffman code has no such word");
}

namespace {

std::vector<BasisGlobals::Endpoint> read_endpoints(const BasisSections& sections, const Place& place) {
  BitReader bits(sections.endpoints, place);
  const HuffmanCode delta[3] = {HuffmanCode(bits), HuffmanCode(bits), HuffmanCode(bits)};
  const HuffmanCode table_delta(bits);
  const bool is_grey = bits.bit() != 0;
  std::vector<BasisGlobals::Endpoint> endpoints;
  endpoints.reserve(sections.endpoint_count);
  // Each value is the sum of the one before it and a difference, whose code depends on the value before.
  BasisGlobals::Endpoint last{16, 16, 16, 0};
  const auto next = [&](std::uint8_t value) {
    const HuffmanCode& code = delta[value <= 9 ? 0 : value <= 21 ? 1 : 2];
    return static_cast<std::uint8_t>((value + code.decode(bits)) & 31);
  };
  for (std::uint32_t i = 0; i < sections.endpoint_count; ++i) {
    last.table = static_cast<std::uint8_t>((last.table + table_delta.decode(bits)) & 7);
    last.red = next(last.red);
    last.green = is_grey ? last.red : next(last.green);
    last.blue = is_grey ? last.red : next(last.blue);
    endpoints.push_back(last);
  }
  return endpoints;
}

std::vector<BasisGlobals::Selector> read_selectors(const BasisSections& sections, const Place& place) {
  BitReader bits(sections.selectors, place);
  if (bits.take(2) != 0) place.fail("reserved bits of its selectors are set");
  const bool is_raw = bits.bit() != 0;
  const HuffmanCode delta = is_raw ? HuffmanCode() : HuffmanCode(bits);
  std::vector<BasisGlobals::Selector> selectors;
  selectors.reserve(sections.selector_count);
  for (std::uint32_t i = 0; i < sections.selector_count; ++i) {
    BasisGlobals::Selector s;
    for (std::size_t row = 0; row < s.size(); ++row) {
      const bool is_whole = is_raw || i == 0;
      const std::uint32_t value = is_whole ? bits.take(8) : delta.decode(bits) ^ selectors.back()[row];
      s[row] = static_cast<std::uint8_t>(value);
    }
    selectors.push_back(s);
  }
  return selectors;
}

/// The numbers of the selectors that were used last, in about that order.
class History {
 public:
  explicit History(std::uint32_t size) : values_(size, 0), rover_(size / 2) {}

  std::size_t size() const { return values_.size(); }
  void add(std::uint32_t value) {
    if (values_.empty()) return;
    values_[rover_++] = value;
    if (rover_ == values_.size()) rover_ = values_.size() / 2;
  }
  std::uint32_t use(std::size_t index) {
    const std::uint32_t value = values_[index];
    std::swap(values_[index / 2], values_[index]);
    return value;
  }

 private:
  std::vector<std::uint32_t> values_;
  std::size_t rover_;
};

/// Numbers in groups of bits, each with a flag whether another one follows.
std::uint32_t take_groups(BitReader& bits, unsigned size) {
  std::uint32_t value = 0;
  for (unsigned at = 0;; at += size) {
    if (at >= 32) bits.place().fail("a number is too long");
    const std::uint32_t group = bits.take(size + 1);
    value |= (group & ((1u << size) - 1)) << at;
    if (group >> size == 0) return value;
  }
}

/// The endpoint and the selector of each block of a slice, block by block.
class SliceReader {
 public:
  SliceReader(const BasisGlobals& globals, std::span<const std::uint8_t> slice, std::size_t columns, const Place& place)
      : globals_(globals),
        bits_(slice, place),
        row_predictions_((columns + 1) / 2),
        above_(columns),
        history_(globals.history_size) {}

  struct Block {
    std::uint32_t endpoint, selector;
  };
  /// Requires  blocks are read row by row.
  Block read(std::size_t x, std::size_t y) {
    const std::uint32_t endpoint = read_endpoint(x, y);
    if (endpoint >= globals_.endpoints.size()) bits_.place().fail("a block has no such endpoint");
    upper_left_ = above_[x];
    above_[x] = left_ = endpoint;
    const std::uint32_t selector = read_selector();
    if (selector >= globals_.selectors.size()) bits_.place().fail("a block has no such selector");
    return {endpoint, selector};
  }

 private:
  static constexpr std::uint32_t repeat_prediction = 256, min_prediction_run = 3, min_selector_run = 3;
  static constexpr std::uint32_t long_selector_run = 63;

  /// How the endpoints of 2 × 2 blocks are predicted: two bits for each block, those of the lower row are kept.
  std::uint32_t read_predictions() {
    if (prediction_run_ > 0) {
      --prediction_run_;
      return last_predictions_;
    }
    const std::uint32_t symbol = globals_.endpoint_prediction.decode(bits_);
    if (symbol > repeat_prediction) bits_.place().fail("a prediction is unknown");
    if (symbol == repeat_prediction)
      prediction_run_ = take_groups(bits_, 4) + min_prediction_run - 1;
    else
      last_predictions_ = symbol;
    return last_predictions_;
  }

  std::uint32_t read_endpoint(std::size_t x, std::size_t y) {
    if (x % 2 == 0) {
      if (y % 2 == 0) {
        predictions_ = read_predictions();
        row_predictions_[x / 2] = static_cast<std::uint8_t>(predictions_ >> 4);
      } else {
        predictions_ = row_predictions_[x / 2];
      }
    }
    const std::uint32_t prediction = predictions_ & 3;
    predictions_ >>= 2;
    const bool has_left = x > 0, has_above = y > 0;
    if (prediction == 0 && has_left) return left_;
    if (prediction == 1 && has_above) return above_[x];
    if (prediction == 2 && has_left && has_above) return upper_left_;
    if (prediction != 3) bits_.place().fail("a block refers to a block outside of the image");
    const std::uint32_t endpoint = globals_.endpoint_delta.decode(bits_) + left_;
    const auto count = static_cast<std::uint32_t>(globals_.endpoints.size());
    return endpoint >= count ? endpoint - count : endpoint;
  }

  std::uint32_t read_selector() {
    const auto count = static_cast<std::uint32_t>(globals_.selectors.size());
    std::uint32_t symbol = count;
    if (selector_run_ > 0) {
      --selector_run_;
    } else {
      symbol = globals_.selector.decode(bits_);
      if (symbol == count + globals_.history_size) {
        const std::uint32_t run = globals_.selector_run.decode(bits_);
        selector_run_ = (run == long_selector_run ? take_groups(bits_, 7) : run) + min_selector_run - 1;
        symbol = count;
      }
    }
    if (symbol < count) {
      history_.add(symbol);
      return symbol;
    }
    if (symbol - count >= history_.size()) bits_.place().fail("a block has no such selector");
    return history_.use(symbol - count);
  }

  const BasisGlobals& globals_;
  BitReader bits_;
  std::uint32_t predictions_ = 0, last_predictions_ = 0, prediction_run_ = 0, selector_run_ = 0;
  std::vector<std::uint8_t> row_predictions_;
  std::vector<std::uint32_t> above_;  ///< the endpoints of the row above, and of this row to the left
  std::uint32_t left_ = 0, upper_left_ = 0;
  History history_;
};

/// The colours of a block: its endpoint, brighter or darker by one of four steps.
std::array<Rgba8, 4> colors_of(const BasisGlobals::Endpoint& e) {
  static constexpr int steps[8][2] = {{2, 8}, {5, 17}, {9, 29}, {13, 42}, {18, 60}, {24, 80}, {33, 106}, {47, 183}};
  const int small = steps[e.table][0], large = steps[e.table][1];
  std::array<Rgba8, 4> colors;
  const int step[4] = {-large, -small, small, large};
  for (std::size_t k = 0; k < 4; ++k) {
    const auto value = [&](std::uint8_t five) {
      return static_cast<std::uint8_t>(std::clamp((five << 3 | five >> 2) + step[k], 0, 255));
    };
    colors[k] = {value(e.red), value(e.green), value(e.blue), 255};
  }
  return colors;
}

}  // namespace

BasisGlobals read_basis_globals(const BasisSections& sections, const Place& place) {
  BasisGlobals globals;
  globals.endpoints = read_endpoints(sections, place);
  globals.selectors = read_selectors(sections, place);
  BitReader bits(sections.tables, place);
  globals.endpoint_prediction = HuffmanCode(bits), globals.endpoint_delta = HuffmanCode(bits);
  globals.selector = HuffmanCode(bits), globals.selector_run = HuffmanCode(bits);
  globals.history_size = bits.take(13);
  return globals;
}

void decode_etc1s(const BasisGlobals& globals, std::span<const std::uint8_t> slice, bool is_alpha, const Place& place,
                  Rgba8Image& image) {
  const int columns = (image.width() + 3) / 4, rows = (image.height() + 3) / 4;
  SliceReader reader(globals, slice, static_cast<std::size_t>(columns), place);
  for (int j = 0; j < rows; ++j) {
    check_deadline();
    for (int i = 0; i < columns; ++i) {
      const auto block = reader.read(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
      const std::array<Rgba8, 4> colors = colors_of(globals.endpoints[block.endpoint]);
      const BasisGlobals::Selector& selector = globals.selectors[block.selector];
      for (int y = 4 * j; y < std::min(4 * j + 4, image.height()); ++y)
        for (int x = 4 * i; x < std::min(4 * i + 4, image.width()); ++x) {
          const Rgba8 color = colors[selector[static_cast<std::size_t>(y % 4)] >> (2 * (x % 4)) & 3u];
          Rgba8& texel = image(x, y);
          if (is_alpha)
            texel.a = color.g;
          else
            texel = color;
        }
    }
  }
}

}  // namespace zoneplate::ktx2
