// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/apng.h"

#include <algorithm>
#include <cassert>
#include <deque>
#include <span>
#include <string_view>
#include <utility>

#include "zoneplate/codec/png.h"
#include "zoneplate/codec/png/png_chunk.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t signature_size = 8;
constexpr std::size_t chunk_frame = 12;  // bytes around a chunk's data: length, name and checksum

void put16(Bytes& out, int value) {
  for (const int shift : {8, 0}) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::uint32_t word_at(std::span<const std::uint8_t> bytes) {
  std::uint32_t word = 0;
  for (const std::uint8_t b : bytes.first(4)) word = word << 8 | b;
  return word;
}

/// Calls use(name, data, whole chunk) for each chunk of a PNG file. The file is trusted: it comes from encode_png.
template <class Use>
void for_chunks(std::span<const std::uint8_t> png, Use use) {
  for (std::size_t at = signature_size; at < png.size();) {
    const std::size_t size = word_at(png.subspan(at));
    const auto chunk = png.subspan(at, chunk_frame + size);
    use(std::string_view(reinterpret_cast<const char*>(chunk.data()) + 4, 4), chunk.subspan(8, size), chunk);
    at += chunk.size();
  }
}

struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

/// The bounding box of the pixels in which two frames differ; one pixel if they are equal, because a frame cannot be
/// empty.
Rectangle difference(const Rgba8Image& before, const Rgba8Image& now) {
  int left = now.width(), top = now.height(), right = -1, bottom = -1;
  for (int y = 0; y < now.height(); ++y)
    for (int x = 0; x < now.width(); ++x)
      if (before(x, y) != now(x, y)) {
        left = std::min(left, x), right = std::max(right, x);
        top = std::min(top, y), bottom = y;
      }
  if (right < 0) return {0, 0, 1, 1};
  return {left, top, right - left + 1, bottom - top + 1};
}

Bytes encoded(const Rgba8Image& frame, const Rectangle& r, bool has_alpha) {
  Rgba8Image part(r.width, r.height);
  for (int y = 0; y < r.height; ++y) {
    const auto row = frame.row(r.y + y).subspan(static_cast<std::size_t>(r.x), static_cast<std::size_t>(r.width));
    std::copy(row.begin(), row.end(), part.row(y).begin());
  }
  return encode_png(part, {.has_alpha = has_alpha, .is_small = true});
}

struct EncodedFrame {
  FrameTime time;
  Rectangle rectangle;
  Bytes png;
};

/// Builds the file. The fcTL and fdAT chunks share one sequence of numbers.
class Writer {
 public:
  Writer(const AnimationFormat& format, const std::deque<EncodedFrame>& frames) : format_(format), frames_(frames) {}

  Bytes write() {
    write_first();
    for (std::size_t i = 1; i < frames_.size(); ++i) write_next(frames_[i]);
    put_png_chunk(out_, "IEND", {});
    return std::move(out_);
  }

 private:
  // Writes the file of the first frame, with acTL and fcTL chunks inserted before its data.
  void write_first() {
    const Bytes& png = frames_[0].png;
    out_.assign(png.begin(), png.begin() + signature_size);
    bool is_before_data = true;
    for_chunks(png, [&](std::string_view name, auto, std::span<const std::uint8_t> chunk) {
      if (name == "IEND") return;
      if (name == "IDAT" && is_before_data) {
        Bytes counts;
        put_png_word(counts, static_cast<std::uint32_t>(frames_.size()));
        put_png_word(counts, static_cast<std::uint32_t>(format_.loops));
        put_png_chunk(out_, "acTL", counts);
        write_control(frames_[0]);
        is_before_data = false;
      }
      out_.insert(out_.end(), chunk.begin(), chunk.end());
    });
  }

  void write_next(const EncodedFrame& frame) {
    write_control(frame);
    for_chunks(frame.png, [&](std::string_view name, auto data, auto) {
      if (name != "IDAT") return;
      Bytes numbered;
      put_png_word(numbered, sequence_++);
      numbered.insert(numbered.end(), data.begin(), data.end());
      put_png_chunk(out_, "fdAT", numbered);
    });
  }

  void write_control(const EncodedFrame& frame) {
    const Rectangle& r = frame.rectangle;
    Bytes control;
    put_png_word(control, sequence_++);
    for (const int value : {r.width, r.height, r.x, r.y}) put_png_word(control, static_cast<std::uint32_t>(value));
    put16(control, frame.time.seconds);
    put16(control, frame.time.per);
    control.push_back(0);  // dispose_op: keep the frame as the background of the next one
    control.push_back(0);  // blend_op: replace the pixels below, do not blend
    put_png_chunk(out_, "fcTL", control);
  }

  const AnimationFormat& format_;
  const std::deque<EncodedFrame>& frames_;
  Bytes out_;
  std::uint32_t sequence_ = 0;
};

class ApngEncoder final : public AnimationEncoder {
 public:
  explicit ApngEncoder(const AnimationFormat& format) : format_(format) {}

  std::function<void()> add(std::shared_ptr<const Rgba8Image> frame, std::optional<FrameTime> time) override {
    EncodedFrame& out = frames_.emplace_back();
    out.time = time.value_or(FrameTime{format_.seconds, format_.per});
    return [&out, before = std::exchange(last_, frame), now = frame, has_alpha = format_.has_alpha] {
      out.rectangle = before ? difference(*before, *now) : Rectangle{0, 0, now->width(), now->height()};
      out.png = encoded(*now, out.rectangle, has_alpha);
    };
  }

  Bytes finish() override {
    assert(!frames_.empty());
    return Writer(format_, frames_).write();
  }

 private:
  const AnimationFormat format_;
  std::shared_ptr<const Rgba8Image> last_;
  std::deque<EncodedFrame> frames_;  ///< whose addresses do not change when others are appended
};

}  // namespace

std::unique_ptr<AnimationEncoder> make_apng_encoder(const AnimationFormat& format) {
  return std::make_unique<ApngEncoder>(format);
}

std::vector<std::uint8_t> encode_apng(const Animation& animation) {
  ApngEncoder encoder(animation.format);
  return encode_animation(encoder, animation);
}

}  // namespace zoneplate
