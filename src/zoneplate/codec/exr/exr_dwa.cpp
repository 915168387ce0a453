// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/exr/exr_dwa.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <optional>
#include <string>

#include "zoneplate/base/lower_case.h"
#include "zoneplate/image/half.h"
#include "zoneplate/math/elementary.h"

namespace zoneplate {
namespace {

using ExrBytes = std::span<const std::uint8_t>;
using Halves = std::vector<std::uint16_t>;

struct Damaged {};

/// Takes bytes from the front.
ExrBytes take(ExrBytes& bytes, std::uint64_t size) {
  if (size > bytes.size()) throw Damaged();
  const ExrBytes front = bytes.first(static_cast<std::size_t>(size));
  bytes = bytes.subspan(front.size());
  return front;
}
template <class T>
T take(ExrBytes& bytes) {
  T value;
  std::memcpy(&value, take(bytes, sizeof value).data(), sizeof value);
  return value;
}

/// Inflates bytes to `size`, of which there are fewer in the file than `most`.
std::vector<std::uint8_t> inflated(ExrBytes bytes, std::uint64_t size, std::uint64_t most) {
  if (size > most) throw Damaged();
  std::vector<std::uint8_t> out(static_cast<std::size_t>(size));
  auto length = static_cast<uLongf>(size);
  if (size == 0 && bytes.empty()) return out;
  if (::uncompress(out.data(), &length, bytes.data(), static_cast<uLong>(bytes.size())) != Z_OK || length != size)
    throw Damaged();
  return out;
}

Halves halves_of(ExrBytes bytes) {
  Halves out(bytes.size() / 2);
  if (!out.empty()) std::memcpy(out.data(), bytes.data(), out.size() * sizeof out[0]);
  return out;
}

/// Undoes the predictor of ZIP compression: differences of bytes, those at even positions before the others.
std::vector<std::uint8_t> without_predictor(std::vector<std::uint8_t> bytes) {
  for (std::size_t i = 1; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(bytes[i - 1] + bytes[i] - 128);
  std::vector<std::uint8_t> out(bytes.size());
  const std::size_t middle = (bytes.size() + 1) / 2;
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = bytes[i / 2 + (i % 2 ? middle : 0)];
  return out;
}

/// Undoes run-length encoding: -n bytes as they are, or one byte n + 1 times.
std::vector<std::uint8_t> without_runs(ExrBytes bytes, std::uint64_t size) {
  std::vector<std::uint8_t> out;
  while (!bytes.empty()) {
    const int count = take<std::int8_t>(bytes);
    const auto n = static_cast<std::size_t>(count < 0 ? -count : count + 1);
    if (n > size - out.size()) throw Damaged();
    if (count < 0) {
      const ExrBytes literal = take(bytes, n);
      out.insert(out.end(), literal.begin(), literal.end());
    } else {
      out.insert(out.end(), n, take<std::uint8_t>(bytes));
    }
  }
  if (out.size() != size) throw Damaged();
  return out;
}

/// Bits from the most significant one of each byte on.
class BitReader {
 public:
  BitReader(ExrBytes bytes, std::uint64_t count) : bytes_(bytes), count_(count) {
    if (count > 8 * std::uint64_t{bytes.size()}) throw Damaged();
  }
  bool is_at_end() const { return at_ == count_; }
  std::uint64_t read(int bits) {
    std::uint64_t value = 0;
    for (int i = 0; i < bits; ++i) {
      if (at_ == count_) throw Damaged();
      value = value << 1 | (bytes_[static_cast<std::size_t>(at_ / 8)] >> (7 - at_ % 8) & 1);
      ++at_;
    }
    return value;
  }
  /// The bytes that have been begun.
  std::size_t used() const { return static_cast<std::size_t>((at_ + 7) / 8); }

 private:
  ExrBytes bytes_;
  std::uint64_t count_, at_ = 0;
};

/// The canonical Huffman code of OpenEXR: longer codes are smaller numbers; codes of a length ascend with the symbols.
class HuffmanCode {
 public:
  /// `lengths` of the symbols from `first` on; 0: a symbol does not occur.
  HuffmanCode(std::uint32_t first, std::span<const std::uint8_t> lengths) {
    std::array<std::uint64_t, max_length + 1> counts{};
    for (const std::uint8_t length : lengths) ++counts[length];
    std::uint64_t code = 0;
    for (std::size_t l = max_length; l > 0; --l) {
      first_[l] = code;
      if (code + counts[l] > std::uint64_t{1} << l) throw Damaged();
      code = (code + counts[l]) >> 1;
    }
    for (std::size_t i = 0; i < lengths.size(); ++i)
      if (lengths[i] > 0) symbols_[lengths[i]].push_back(first + static_cast<std::uint32_t>(i));
  }

  std::uint32_t read(BitReader& bits) const {
    std::uint64_t code = 0;
    for (std::size_t l = 1; l <= max_length; ++l) {
      code = code << 1 | bits.read(1);
      if (code >= first_[l] && code - first_[l] < symbols_[l].size())
        return symbols_[l][static_cast<std::size_t>(code - first_[l])];
    }
    throw Damaged();
  }

  static constexpr std::size_t max_length = 58;

 private:
  std::array<std::uint64_t, max_length + 1> first_{};
  std::array<std::vector<std::uint32_t>, max_length + 1> symbols_;
};

/// Lengths of 6 bits; 59 to 62 are 2 to 5 zeros, 63 is 6 zeros and as many as 8 bits state.
std::vector<std::uint8_t> code_lengths(BitReader& bits, std::size_t count) {
  std::vector<std::uint8_t> out;
  while (out.size() < count) {
    const auto length = static_cast<std::size_t>(bits.read(6));
    const std::size_t zeros = length == 63                       ? 6 + static_cast<std::size_t>(bits.read(8))
                              : length > HuffmanCode::max_length ? length - 57
                                                                 : 0;
    if (zeros > count - out.size()) throw Damaged();
    if (zeros > 0)
      out.insert(out.end(), zeros, std::uint8_t{0});
    else
      out.push_back(static_cast<std::uint8_t>(length));
  }
  return out;
}

/// Decodes Huffman encoded numbers of 16 bits: the last symbol repeats the number before it as often as 8 bits state.
Halves decode_huffman(ExrBytes bytes, std::uint64_t count) {
  constexpr std::uint32_t symbols = 65537;
  Halves out;
  if (bytes.empty() && count == 0) return out;
  const auto first = take<std::uint32_t>(bytes), last = take<std::uint32_t>(bytes);
  take<std::uint32_t>(bytes);  // bytes of the table, which follow from it
  const auto data_bits = take<std::uint32_t>(bytes);
  take<std::uint32_t>(bytes);  // reserved
  if (first > last || last >= symbols) throw Damaged();
  BitReader table(bytes, 8 * std::uint64_t{bytes.size()});
  const HuffmanCode code(first, code_lengths(table, last - first + 1));
  take(bytes, table.used());
  BitReader bits(bytes, data_bits);
  while (!bits.is_at_end()) {
    const std::uint32_t symbol = code.read(bits);
    if (symbol != last) {
      out.push_back(static_cast<std::uint16_t>(symbol));
    } else {
      if (out.empty()) throw Damaged();
      out.insert(out.end(), static_cast<std::size_t>(bits.read(8)), out.back());
    }
    if (out.size() > count) throw Damaged();
  }
  if (out.size() != count) throw Damaged();
  return out;
}

/// How a channel is packed; the values are those of the format.
enum class Scheme { Deflated = 0, Lossy = 1, Runs = 2 };

/// The channels that are packed in one way: those with the last component of their names, and of a type.
struct Rule {
  std::string suffix;
  Scheme scheme = Scheme::Deflated;
  ExrType type = ExrType::Half;
  int color = -1;  ///< 0 to 2: red, green, blue of three that are Y'CbCr
  bool ignores_case = false;

  bool fits(const std::string& name, ExrType of) const {
    return type == of && (ignores_case ? lower_case(name) == suffix : name == suffix);
  }
};

/// The rules of a chunk: 2 bytes of their size, and each a name with a zero, the scheme and the type.
std::vector<Rule> take_rules(ExrBytes& bytes) {
  const auto size = take<std::uint16_t>(bytes);
  if (size < sizeof size) throw Damaged();
  ExrBytes list = take(bytes, size - sizeof size);
  std::vector<Rule> rules;
  while (!list.empty()) {
    const auto end = std::ranges::find(list, std::uint8_t{0});
    if (end == list.end()) throw Damaged();
    Rule rule{.suffix = {list.begin(), end}};
    take(list, rule.suffix.size() + 1);
    const auto bits = take<std::uint8_t>(list), type = take<std::uint8_t>(list);
    const int scheme = bits >> 2 & 3;
    rule.color = (bits >> 4) - 1;
    rule.ignores_case = (bits & 1) != 0;
    if (rule.ignores_case) rule.suffix = lower_case(rule.suffix);
    if (rule.color > 2 || scheme > 2 || type > 2) throw Damaged();
    rule.scheme = static_cast<Scheme>(scheme), rule.type = static_cast<ExrType>(type);
    rules.push_back(std::move(rule));
  }
  return rules;
}

/// The rules of files before these were stored.
std::vector<Rule> first_rules() {
  std::vector<Rule> rules;
  const auto add = [&](Scheme scheme, int color, std::initializer_list<const char*> names) {
    for (const char* const name : names)
      for (const ExrType type : {ExrType::Number, ExrType::Half, ExrType::Float})
        if (scheme == Scheme::Runs || type != ExrType::Number) rules.push_back({name, scheme, type, color, true});
  };
  add(Scheme::Lossy, 0, {"r", "red"});
  add(Scheme::Lossy, 1, {"g", "grn", "green"});
  add(Scheme::Lossy, 2, {"b", "blu", "blue"});
  add(Scheme::Lossy, -1, {"y", "by", "ry"});
  add(Scheme::Runs, -1, {"a"});
  return rules;
}

/// The amplitudes of the cosines: [frequency][position].
using Cosines = std::array<std::array<float, 8>, 8>;

Cosines cosines() {
  Cosines out{};
  for (int u = 0; u < 8; ++u)
    for (int x = 0; x < 8; ++x) {
      const auto angle = static_cast<float>((2 * x + 1) * u % 32) * std::numbers::pi_v<float> / 16;
      out[static_cast<std::size_t>(u)][static_cast<std::size_t>(x)] =
          u == 0 ? std::numbers::sqrt2_v<float> / 4 : cos(angle) / 2;
    }
  return out;
}

/// The row and column of the coefficients in their order: along the diagonals, in turn down and up.
std::array<std::uint8_t, 64> zigzag() {
  std::array<std::uint8_t, 64> out{};
  std::size_t i = 0;
  for (int sum = 0; sum < 15; ++sum)
    for (int k = std::max(0, sum - 7); k <= std::min(sum, 7); ++k) {
      const int row = sum % 2 ? k : sum - k;
      out[i++] = static_cast<std::uint8_t>(8 * row + sum - row);
    }
  return out;
}

using Block = std::array<float, 64>;

/// The sum of the cosines of a block.
Block inverse_transform(const Block& coefficients, const Cosines& cosine) {
  Block rows{}, out{};
  for (std::size_t v = 0; v < 8; ++v)
    for (std::size_t u = 0; u < 8; ++u) {
      const float c = coefficients[8 * v + u];
      if (c == 0) continue;
      for (std::size_t x = 0; x < 8; ++x) rows[8 * v + x] += c * cosine[u][x];
    }
  for (std::size_t v = 0; v < 8; ++v)
    for (std::size_t y = 0; y < 8; ++y)
      for (std::size_t x = 0; x < 8; ++x) out[8 * y + x] += rows[8 * v + x] * cosine[v][y];
  return out;
}

/// The unpacked data of a chunk, by scheme, and where the next channel begins.
struct Streams {
  Halves first, others;  ///< coefficients of the lossy channels
  std::vector<std::uint8_t> deflated, runs;
  std::size_t at_first = 0, at_others = 0, at_deflated = 0, at_runs = 0;
};

/// Takes a block's other coefficients. 0xff00 ends them, 0xffNN are NN zeros.
void take_others(Streams& streams, Block& block) {
  static const std::array<std::uint8_t, 64> order = zigzag();
  for (std::size_t i = 1; i < 64;) {
    if (streams.at_others == streams.others.size()) throw Damaged();
    const std::uint16_t value = streams.others[streams.at_others++];
    if (value == 0xff00) return;
    if (value >> 8 == 0xff)
      i += value & 0xff;
    else
      block[order[i++]] = half_value(value);
  }
}

int blocks_along(int samples) { return (samples + 7) / 8; }

/// The channels of a chunk, and where their rows begin in the unpacked one.
class DwaChunk {
 public:
  DwaChunk(std::span<const DwaChannel> channels, int first_row, std::span<std::uint8_t> out,
           const std::vector<std::uint16_t>& linear)
      : channels_(channels),
        out_(out),
        linear_(linear),
        rows_(channels.size()),
        schemes_(channels.size()),
        is_colored_(channels.size()) {
    std::size_t at = 0, left = 0;
    for (const DwaChannel& c : channels) left += static_cast<std::size_t>(c.height);
    for (int y = first_row; left > 0; ++y)
      for (std::size_t i = 0; i < channels.size(); ++i) {
        const DwaChannel& c = channels[i];
        if (y % c.row_step != 0 || rows_[i].size() == static_cast<std::size_t>(c.height)) continue;
        rows_[i].push_back(at), --left;
        at += row_size(c);
      }
    if (at != out.size()) throw Damaged();
  }

  void unpack(ExrBytes packed) {
    std::array<std::uint64_t, 11> sizes{};
    for (std::uint64_t& size : sizes) size = take<std::uint64_t>(packed);
    const auto [version, deflated_size, deflated_packed, others_packed, first_packed, runs_packed, runs_deflated,
                runs_size, others, first, others_packing] = sizes;
    if (version > 2) throw Damaged();
    classify(version < 2 ? first_rules() : take_rules(packed));
    const ExrBytes deflated_bytes = take(packed, deflated_packed), others_bytes = take(packed, others_packed),
                   first_bytes = take(packed, first_packed), runs_bytes = take(packed, runs_packed);
    // No more than all samples as a scheme stores them.
    std::uint64_t max_blocks = 0;
    for (const DwaChannel& c : channels_)
      max_blocks +=
          static_cast<std::uint64_t>(blocks_along(c.width)) * static_cast<std::uint64_t>(blocks_along(c.height));
    if (others > 63 * max_blocks || first > max_blocks || runs_size > out_.size()) throw Damaged();
    Streams streams;
    streams.deflated = inflated(deflated_bytes, deflated_packed == 0 ? 0 : deflated_size, out_.size());
    streams.others = others_packing == 0 ? decode_huffman(others_bytes, others_packed == 0 ? 0 : others)
                                         : halves_of(inflated(others_bytes, 2 * others, 126 * max_blocks));
    streams.first = halves_of(without_predictor(inflated(first_bytes, 2 * first, 2 * max_blocks)));
    if (runs_size > 0)
      streams.runs = without_runs(inflated(runs_bytes, runs_deflated, 2 * std::uint64_t{out_.size()}), runs_size);
    for (const std::array<std::size_t, 3>& colors : colors_) unpack_lossy(colors, streams);
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      if (is_colored_[i]) continue;
      if (schemes_[i] == Scheme::Lossy)
        unpack_lossy(std::span(&i, 1), streams);
      else if (schemes_[i] == Scheme::Runs)
        unpack_runs(i, streams);
      else
        unpack_deflated(i, streams);
    }
  }

 private:
  static std::size_t sample_size(const DwaChannel& c) { return c.type == ExrType::Half ? 2 : 4; }
  static std::size_t row_size(const DwaChannel& c) { return static_cast<std::size_t>(c.width) * sample_size(c); }

  /// The scheme of each channel, and the layers with three colours, in the order of the layers' names.
  void classify(const std::vector<Rule>& rules) {
    constexpr std::size_t none = ~std::size_t{0};
    std::map<std::string, std::array<std::size_t, 3>> layers;
    for (std::size_t i = 0; i < channels_.size(); ++i) {
      const std::string name(channels_[i].name);
      const std::size_t dot = name.rfind('.');
      const std::string prefix = dot == name.npos ? "" : name.substr(0, dot), suffix = name.substr(dot + 1);
      std::array<std::size_t, 3>& layer = layers.try_emplace(prefix, std::array{none, none, none}).first->second;
      for (const Rule& rule : rules) {
        if (!rule.fits(suffix, channels_[i].type)) continue;
        schemes_[i] = rule.scheme;
        if (rule.color >= 0) layer[static_cast<std::size_t>(rule.color)] = i;
      }
    }
    for (const auto& [prefix, layer] : layers) {
      if (std::ranges::find(layer, none) != layer.end()) continue;
      const DwaChannel& red = channels_[layer[0]];
      const auto is_alike = [&](std::size_t i) {
        return channels_[i].width == red.width && channels_[i].height == red.height &&
               channels_[i].row_step == red.row_step;
      };
      if (!std::ranges::all_of(layer, is_alike)) continue;
      if (std::ranges::any_of(layer, [&](std::size_t i) { return schemes_[i] != Scheme::Lossy; })) throw Damaged();
      colors_.push_back(layer);
      for (const std::size_t i : layer) is_colored_[i] = true;
    }
  }

  /// One channel, or three as Y'CbCr, block by block. First coefficients are stored channel after channel, the others
  /// block after block.
  void unpack_lossy(std::span<const std::size_t> members, Streams& streams) {
    static const Cosines cosine = cosines();
    const DwaChannel& shape = channels_[members[0]];
    const int across = blocks_along(shape.width), down = blocks_along(shape.height);
    const auto blocks = static_cast<std::size_t>(across) * static_cast<std::size_t>(down);
    if (blocks * members.size() > streams.first.size() - streams.at_first) throw Damaged();
    for (int by = 0; by < down; ++by)
      for (int bx = 0; bx < across; ++bx) {
        std::array<Block, 3> values{};
        for (std::size_t k = 0; k < members.size(); ++k) {
          const auto block =
              static_cast<std::size_t>(by) * static_cast<std::size_t>(across) + static_cast<std::size_t>(bx);
          values[k][0] = half_value(streams.first[streams.at_first + k * blocks + block]);
          take_others(streams, values[k]);
          values[k] = inverse_transform(values[k], cosine);
        }
        if (members.size() == 3) make_rgb(values);
        for (std::size_t k = 0; k < members.size(); ++k) {
          const bool is_linear = members.size() == 1 && shape.is_linear;
          store(members[k], {8 * bx, 8 * by}, values[k], is_linear);
        }
      }
    streams.at_first += blocks * members.size();
  }

  /// R'G'B' of Y'CbCr, of ITU-R BT.709.
  static void make_rgb(std::array<Block, 3>& values) {
    for (std::size_t i = 0; i < values[0].size(); ++i) {
      const float y = values[0][i], cb = values[1][i], cr = values[2][i];
      values[0][i] = y + 1.5747f * cr;
      values[1][i] = y - 0.1873f * cb - 0.4682f * cr;
      values[2][i] = y + 1.8556f * cb;
    }
  }

  void store(std::size_t channel, int2 at, const Block& block, bool is_linear) {
    const DwaChannel& c = channels_[channel];
    for (int y = at.y; y < std::min(at.y + 8, c.height); ++y)
      for (int x = at.x; x < std::min(at.x + 8, c.width); ++x) {
        const float v = block[static_cast<std::size_t>(8 * (y - at.y) + x - at.x)];
        // Undefined coefficients make undefined values.
        std::uint16_t half = std::isnan(v) ? std::uint16_t{0} : half_bits(v);
        if (!is_linear) half = linear_[half];
        std::uint8_t* const to =
            &out_[rows_[channel][static_cast<std::size_t>(y)] + static_cast<std::size_t>(x) * sample_size(c)];
        if (c.type == ExrType::Half) {
          std::memcpy(to, &half, sizeof half);
        } else {
          const float wide = half_value(half);
          std::memcpy(to, &wide, sizeof wide);
        }
      }
  }

  void unpack_deflated(std::size_t channel, Streams& streams) {
    const std::size_t size = row_size(channels_[channel]);
    for (const std::size_t row : rows_[channel]) {
      if (size > streams.deflated.size() - streams.at_deflated) throw Damaged();
      std::copy_n(streams.deflated.begin() + static_cast<std::ptrdiff_t>(streams.at_deflated), size,
                  out_.begin() + static_cast<std::ptrdiff_t>(row));
      streams.at_deflated += size;
    }
  }

  /// The first bytes of all samples, then the second ones, and so on.
  void unpack_runs(std::size_t channel, Streams& streams) {
    const DwaChannel& c = channels_[channel];
    const auto width = static_cast<std::size_t>(c.width);
    const std::size_t count = width * rows_[channel].size(), size = sample_size(c);
    if (count * size > streams.runs.size() - streams.at_runs) throw Damaged();
    for (std::size_t y = 0; y < rows_[channel].size(); ++y)
      for (std::size_t x = 0; x < width; ++x)
        for (std::size_t byte = 0; byte < size; ++byte)
          out_[rows_[channel][y] + x * size + byte] = streams.runs[streams.at_runs + byte * count + y * width + x];
    streams.at_runs += count * size;
  }

  std::span<const DwaChannel> channels_;
  std::span<std::uint8_t> out_;
  const std::vector<std::uint16_t>& linear_;
  std::vector<std::vector<std::size_t>> rows_;  ///< of each channel: where they begin in `out_`
  std::vector<Scheme> schemes_;
  std::vector<std::array<std::size_t, 3>> colors_;
  std::vector<bool> is_colored_;  ///< by channel: it is one of `colors_`
};

}  // namespace

/// The perceptual scale is a power up to 1, and a logarithm above, with one slope at 1.
DwaDecoder::DwaDecoder() : linear_(65536) {
  constexpr float power = 2.2f, base = 9.02501329156f;  // e to the power 2.2
  constexpr std::uint16_t infinity = 0x7c00;
  for (std::size_t i = 0; i < linear_.size(); ++i) {
    const auto bits = static_cast<std::uint16_t>(i);
    if ((bits & infinity) == infinity) continue;  // 0
    const float value = half_value(bits), size = std::abs(value);
    const float light = size <= 1 ? pow(size, power) : pow(base, size - 1);
    linear_[i] = half_bits(std::copysign(light, value));
  }
}

bool DwaDecoder::unpack(std::span<const std::uint8_t> packed, std::span<const DwaChannel> channels, int first_row,
                        std::span<std::uint8_t> out) const try {
  DwaChunk(channels, first_row, out, linear_).unpack(packed);
  return true;
} catch (const Damaged&) {
  return false;
}

}  // namespace zoneplate
