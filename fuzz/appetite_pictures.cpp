// SPDX-License-Identifier: Apache-2.0
// JPEG, WebP, Radiance and KTX2 images of many pixels in few bytes.
#include "appetite.h"

namespace zoneplate::appetite {
namespace {

/// Bits of a JPEG's scan, the first the most significant, with a zero after each byte of ones.
class JpegBits {
 public:
  void put(std::uint32_t bits, int count) {
    for (int i = count - 1; i >= 0; --i) {
      byte_ = byte_ << 1 | (bits >> i & 1);
      if (++filled_ == 8) flush();
    }
  }
  Bytes take() {
    while (filled_ != 0) put(1, 1);
    return std::move(out_);
  }

 private:
  void flush() {
    out_.push_back(static_cast<std::uint8_t>(byte_));
    if (byte_ == 0xff) out_.push_back(0);
    byte_ = 0, filled_ = 0;
  }
  Bytes out_;
  std::uint32_t byte_ = 0;
  int filled_ = 0;
};

void append(Bytes& out, const Bytes& more) { out.insert(out.end(), more.begin(), more.end()); }

std::uint8_t high(unsigned v) { return static_cast<std::uint8_t>(v >> 8); }
std::uint8_t low(unsigned v) { return static_cast<std::uint8_t>(v); }

/// The beginning of a grey JPEG; `frame` is 0xc0 for one scan, 0xc2 for many.
Bytes begin_jpeg(std::uint8_t frame, unsigned width, unsigned height) {
  Bytes out{0xff, 0xd8, 0xff, 0xdb, 0, 67, 0};
  out.resize(out.size() + 64, 1);
  append(out, {0xff, frame, 0, 11, 8, high(height), low(height), high(width), low(width), 1, 1, 0x11, 0});
  // Codes of differences: one, of one bit, for none. Of the other coefficients: 0 for a run of blocks of 14 bits, 10
  // for one of 5 bits, 110 for the end of one block.
  append(out, {0xff, 0xc4, 0, 20, 0x00, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
  append(out, {0xff, 0xc4, 0, 22, 0x10, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xe0, 0x50, 0x00});
  return out;
}

/// A scan of coefficients `first` to `last`, in which bit `bit` follows on bit `before` (0: on none).
void append_scan(Bytes& out, int first, int last, int before, int bit, const Bytes& data) {
  append(out, {0xff, 0xda, 0, 8, 1, 1, 0x00, static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(last),
               static_cast<std::uint8_t>(before << 4 | bit)});
  append(out, data);
}

/// A grey image whose coefficients are all zero, coded in one scan of differences and many of one bit of one
/// coefficient.
Bytes progressive_jpeg(unsigned side, int scans) {
  const std::uint32_t blocks = side / 8 * (side / 8);
  JpegBits differences, run;
  for (std::uint32_t i = 0; i < blocks; ++i) differences.put(0, 1);
  std::uint32_t left = blocks;
  for (; left >= 32767; left -= 32767) run.put(0, 1), run.put(0x3fff, 14);
  for (; left >= 32; left -= std::min(left, 63u)) run.put(2, 2), run.put(std::min(left, 63u) - 32, 5);
  for (; left > 0; --left) run.put(6, 3);
  Bytes out = begin_jpeg(0xc2, side, side);
  append_scan(out, 0, 0, 0, 0, differences.take());
  const Bytes zeros = run.take();
  constexpr int bits = 13;
  for (int scan = 0; scan + 1 < scans; ++scan) {
    const int coefficient = 1 + scan / (bits + 1), bit = bits - scan % (bits + 1);
    append_scan(out, coefficient, coefficient, bit == bits ? 0 : bit + 1, bit, zeros);
  }
  append(out, {0xff, 0xd9});
  return out;
}

/// A grey image of one scan, two codes a block.
Bytes baseline_jpeg(unsigned side) {
  JpegBits bits;
  for (std::uint32_t i = 0; i < side / 8 * (side / 8); ++i) bits.put(6, 4);
  Bytes out = begin_jpeg(0xc0, side, side);
  append_scan(out, 0, 63, 0, 0, bits.take());
  append(out, {0xff, 0xd9});
  return out;
}

void add_jpeg(Collection& out) {
  out.add_picture("jpeg-scans", "jpeg-197-scans", ".jpg", progressive_jpeg(8192, 197), within_limits);
  out.add_picture("jpeg-scans", "jpeg-197-scans-4k", ".jpg", progressive_jpeg(4096, 197), within_limits);
  out.add_picture("jpeg-scans", "jpeg-800-scans", ".jpg", progressive_jpeg(4096, 800), within_limits);
  out.add_picture("jpeg-scans", "jpeg-100-scans-16k", ".jpg", progressive_jpeg(16384, 100), within_limits);
  out.add_picture("jpeg-large", "jpeg-baseline-16k", ".jpg", baseline_jpeg(16384), within_limits);
  Bytes cut = begin_jpeg(0xc2, 16000, 16000);
  append_scan(cut, 0, 0, 0, 0, {});
  out.add_picture("jpeg-large", "jpeg-cut-off", ".jpg", cut, within_limits);
  Bytes claim = begin_jpeg(0xc0, 65500, 65500);
  append_scan(claim, 0, 63, 0, 0, {});
  out.add_picture("jpeg-large", "jpeg-claim", ".jpg", claim, within_limits);
}

/// A lossless WebP image of one colour: no pixel takes a bit.
Bytes flat_webp(unsigned width, unsigned height) {
  std::uint64_t bits = (width - 1) | std::uint64_t{height - 1} << 14;  // the rest of the header is zero
  Bytes data{0x2f};
  for (int i = 0; i < 4; ++i, bits >>= 8) data.push_back(static_cast<std::uint8_t>(bits));
  // No transform, no cache of colours, one group of codes; five codes of one symbol, 0: the bits 1, 0, 0, 0 each.
  std::uint32_t codes = 0;
  for (int i = 0; i < 5; ++i) codes |= 1u << (3 + 4 * i);
  for (int i = 0; i < 3; ++i, codes >>= 8) data.push_back(static_cast<std::uint8_t>(codes));
  data.resize(10);
  Bytes out{'R', 'I', 'F', 'F', static_cast<std::uint8_t>(12 + data.size()), 0, 0, 0, 'W', 'E', 'B', 'P',
            'V', 'P', '8', 'L', static_cast<std::uint8_t>(data.size()),      0, 0, 0};
  append(out, data);
  return out;
}

Bytes radiance(const std::string& header, const std::string& size) {
  const std::string text = "#?RADIANCE\n" + header + "FORMAT=32-bit_rle_rgbe\n\n" + size + "\n";
  return {text.begin(), text.end()};
}

void add_hdr(Collection& out) {
  // Runs of the old kind: a pixel, then 255 of it and 63 times 256 of it.
  Bytes runs = radiance("", "-Y 16384 +X 16384");
  for (int y = 0; y < 16384; ++y) append(runs, {90, 80, 70, 129, 1, 1, 1, 255, 1, 1, 1, 63});
  out.add_picture("hdr", "hdr-16k", ".hdr", runs, within_limits);
  Bytes small = radiance("", "-Y 4096 +X 4096");  // 1 + 255 + 15 * 256
  for (int y = 0; y < 4096; ++y) append(small, {90, 80, 70, 129, 1, 1, 1, 255, 1, 1, 1, 15});
  out.add_picture("hdr", "hdr-4k", ".hdr", small, within_limits);
  out.add_picture("hdr", "hdr-claim", ".hdr", radiance("", "-Y 2147483647 +X 2147483647"), within_limits);
  Bytes sky = radiance("", "-Y 1024 +X 2048");  // 1 + 255 + 7 * 256
  for (int y = 0; y < 1024; ++y) append(sky, {90, 80, 70, 129, 1, 1, 1, 255, 1, 1, 1, 7});
  out.add_environment("environment", "environment-2k", ".hdr", sky, within_limits);
  out.add_environment("environment", "environment-16k", ".hdr", runs, within_limits);
  out.add_environment("environment", "environment-claim", ".hdr", radiance("", "-Y 2147483647 +X 2147483647"), refused);
  out.add_environment("environment", "environment-cut", ".hdr", radiance("", "-Y 512 +X 1024"), refused);
  out.add_picture("hdr", "hdr-header", ".hdr", radiance(repeated("# a remark\n", 500000), "-Y 1 +X 1"), within_limits);
}

/// The header of a KTX2 image of one level, and a level of these bytes, which unpack to `unpacked` bytes.
Bytes ktx2(std::uint32_t side, std::uint8_t model, std::uint32_t supercompression, const Bytes& level,
           std::uint64_t unpacked) {
  Bytes out{0xab, 'K', 'T', 'X', ' ', '2', '0', 0xbb, '\r', '\n', 0x1a, '\n'};
  const auto put = [&](std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  };
  constexpr std::uint32_t descriptor_at = 104, descriptor_size = 44, level_at = descriptor_at + descriptor_size;
  put(0, 4), put(1, 4), put(side, 4), put(side, 4), put(0, 4), put(0, 4), put(1, 4), put(1, 4);
  put(supercompression, 4), put(descriptor_at, 4), put(descriptor_size, 4), put(0, 4), put(0, 4);
  // Global data, of BasisLZ: 65535 endpoints and selectors in sections that are empty.
  const bool has_globals = supercompression == 1;
  put(has_globals ? level_at + level.size() : 0, 8), put(has_globals ? 40 : 0, 8);
  put(level_at, 8), put(level.size(), 8), put(unpacked, 8);
  put(descriptor_size, 4), put(0, 4), put(0x280002, 4), put(model, 4);
  out.resize(level_at);
  append(out, level);
  if (has_globals) put(0xffffffff, 4), out.resize(out.size() + 36);
  return out;
}

/// Zstandard data of `count` runs of 131072 zeros.
Bytes zstandard_zeros(std::uint32_t count) {
  const std::uint64_t size = std::uint64_t{count} << 17;
  Bytes out{0x28, 0xb5, 0x2f, 0xfd, 0xe0};
  for (int i = 0; i < 8; ++i) out.push_back(static_cast<std::uint8_t>(size >> (8 * i)));
  for (std::uint32_t i = 1; i <= count; ++i) {
    const std::uint32_t block = (i == count ? 1u : 0u) | 1u << 1 | 1u << 20;  // the last, a run, its size
    for (int k = 0; k < 3; ++k) out.push_back(static_cast<std::uint8_t>(block >> (8 * k)));
    out.push_back(0);
  }
  return out;
}

void add_ktx2(Collection& out) {
  constexpr std::uint8_t etc1s = 163, uastc = 166;
  const auto add = [&](const char* name, const Bytes& bytes) {
    out.add_picture("ktx2", name, ".ktx2", bytes, within_limits);
  };
  // A byte a texel: 2^20 and 2^28 of them.
  add("ktx2-1k", ktx2(1024, uastc, 2, zstandard_zeros(8), 1 << 20));
  add("ktx2-16k", ktx2(16384, uastc, 2, zstandard_zeros(2048), 1 << 28));
  add("ktx2-more-than-stated", ktx2(1024, uastc, 2, zstandard_zeros(32768), 1 << 20));
  add("ktx2-claim", ktx2(0xffffffff, uastc, 0, {}, 0));
  add("ktx2-basis-claim", ktx2(16384, etc1s, 1, {}, 0));
}

/// A texture that fits, and tables of it that do not.
void add_filters(Collection& out) {
  for (const char* filter : {"sat", "ripmap", "ewa", "stochastic"})
    for (const unsigned side : {1500u, 3000u})
      out.add_picture("filters", std::string("filter-") + filter + "-" + std::to_string(side), ".webp",
                      flat_webp(side, side), within_limits, {{"texture-filter", filter}});
}

}  // namespace

void add_pictures(Collection& out) {
  add_jpeg(out);
  out.add_picture("webp", "webp-16383", ".webp", flat_webp(16383, 16383), within_limits);
  out.add_picture("webp", "webp-5000", ".webp", flat_webp(5000, 5000), within_limits);
  add_hdr(out);
  add_ktx2(out);
  add_filters(out);
}

}  // namespace zoneplate::appetite
