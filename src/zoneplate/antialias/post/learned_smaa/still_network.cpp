// SPDX-License-Identifier: Apache-2.0
// The features are whole numbers from 0 to 127, computed from codes: half of each channel, 64 and what SMAA adds to
// each channel, how much luma is below and above the extremes of 3 × 3 pixels, and 64 and half of the difference to the
// luma of the four neighbours.
#include "zoneplate/antialias/post/learned_smaa/still_network.h"

#include <algorithm>
#include <vector>

#include "zoneplate/antialias/post/encoded.h"

namespace zoneplate::antialias {
namespace {

constexpr int most = 127;
std::int16_t feature(int v) { return static_cast<std::int16_t>(std::clamp(v, 0, most)); }

/// Rec. 709 luma, nearly: exact in whole numbers.
int luma_of(const Rgba8& c) { return (2 * c.r + 5 * c.g + c.b) / 8; }

/// The lumas of a row, with the outermost one repeated on either side.
void luma_row(const Rgba8Image& image, int y, std::vector<int>& out) {
  const auto row = image.row(std::clamp(y, 0, image.height() - 1));
  std::ranges::transform(row, out.begin() + 1, luma_of);
  out.front() = out[1], out.back() = out[out.size() - 2];
}

}  // namespace

StillCorrections::StillCorrections(const Rgba8Image& image, const Rgba8Image& smooth, int x, int y, int first,
                                   const network::Network& network, int outputs)
    : network_(network),
      outputs_(outputs),
      width_(image.width()),
      begin_(std::max(first - radius, 0)),
      left_(x % 2),
      top_((y + begin_) % 2),
      frame_(width_ + left_, std::min(first + band + radius, image.height()) - begin_ + top_, features) {
  describe(image, smooth);
  network_.read(frame_);
}

void StillCorrections::describe(const Rgba8Image& image, const Rgba8Image& smooth) {
  for_rows(frame_.features.height, [&](int at) {
    const int y = begin_ + std::max(at - top_, 0);
    const auto size = static_cast<std::size_t>(width_) + 2;
    std::vector<int> rows[3] = {std::vector<int>(size), std::vector<int>(size), std::vector<int>(size)};
    for (int k = 0; k < 3; ++k) luma_row(image, y + k - 1, rows[k]);
    std::int16_t* out = frame_.features.at(left_, at);
    for (int x = 0; x < width_; ++x, out += features) {
      const Rgba8 c = image(x, y), s = smooth(x, y);
      const auto i = static_cast<std::size_t>(x) + 1;
      int low = rows[1][i], high = low;
      for (const std::vector<int>& row : rows)
        for (std::size_t k = i - 1; k <= i + 1; ++k) low = std::min(low, row[k]), high = std::max(high, row[k]);
      const int luma = rows[1][i];
      const auto step = [&](int neighbour) { return feature(64 + ((neighbour - luma) >> 1)); };
      out[0] = feature(c.r / 2), out[1] = feature(c.g / 2), out[2] = feature(c.b / 2);
      out[3] = feature(64 + s.r - c.r), out[4] = feature(64 + s.g - c.g), out[5] = feature(64 + s.b - c.b);
      out[6] = feature(high - luma), out[7] = feature(luma - low);
      out[8] = step(rows[1][i - 1]), out[9] = step(rows[1][i + 1]);
      out[10] = step(rows[0][i]), out[11] = step(rows[2][i]);
    }
    if (left_ == 1) std::copy_n(frame_.features.at(1, at), features, frame_.features.at(0, at));
  });
}

void StillCorrections::write_row(int y, float* out) const {
  network_.write(frame_, left_, y - begin_ + top_, width_, 0, outputs_, out);
}

}  // namespace zoneplate::antialias
