// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/imaging/filter/still.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/codec/inspect/several_images.h"
#include "zoneplate/image/rgb_space.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/imaging/filter/color.h"
#include "zoneplate/math/vec.h"
#include "zoneplate/metrics/backdrop.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/process/exr_layer.h"

namespace zoneplate {
namespace {

/// Pixels that are not finite, from the border of each region inwards.
class Fill {
 public:
  explicit Fill(LinearImage& image) : image_(image), states_(image.width(), image.height(), State::Finite) {
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        if (!metrics::is_finite(image(x, y))) states_(x, y) = State::Undefined, ++undefined_;
  }
  std::size_t undefined() const { return undefined_; }

  void run() {
    std::vector<int2> front;
    for (int y = 0; y < image_.height(); ++y)
      for (int x = 0; x < image_.width(); ++x)
        if (states_(x, y) == State::Undefined && has_finite_neighbour(x, y)) enter(x, y, front);
    while (!front.empty()) {
      std::vector<Linear> means;
      for (const int2 p : front) means.push_back(mean_around(p));
      for (std::size_t i = 0; i < front.size(); ++i)
        image_(front[i].x, front[i].y) = means[i], states_(front[i].x, front[i].y) = State::Finite;
      std::vector<int2> next;
      for (const int2 p : front)
        for_neighbours(p, [&](int x, int y) {
          if (states_(x, y) == State::Undefined) enter(x, y, next);
        });
      front = std::move(next);
    }
  }

 private:
  enum class State : std::uint8_t { Finite, Undefined, Waiting };

  void enter(int x, int y, std::vector<int2>& front) {
    states_(x, y) = State::Waiting;
    front.push_back({x, y});
  }

  template <class Use>
  void for_neighbours(int2 p, const Use& use) const {
    for (int y = std::max(p.y - 1, 0); y <= std::min(p.y + 1, image_.height() - 1); ++y)
      for (int x = std::max(p.x - 1, 0); x <= std::min(p.x + 1, image_.width() - 1); ++x) use(x, y);
  }
  bool has_finite_neighbour(int x, int y) const {
    bool is_found = false;
    for_neighbours({x, y}, [&](int i, int j) { is_found = is_found || states_(i, j) == State::Finite; });
    return is_found;
  }
  Linear mean_around(int2 p) const {
    double sum[4] = {};
    int count = 0;
    for_neighbours(p, [&](int x, int y) {
      if (states_(x, y) != State::Finite) return;
      const Linear& c = image_(x, y);
      sum[0] += static_cast<double>(c.r), sum[1] += static_cast<double>(c.g);
      sum[2] += static_cast<double>(c.b), sum[3] += static_cast<double>(c.a);
      ++count;
    });
    const auto mean = [&](int i) { return static_cast<float>(sum[i] / count); };
    return {mean(0), mean(1), mean(2), mean(3)};
  }

  LinearImage& image_;
  Plane<State> states_;
  std::size_t undefined_ = 0;
};

}  // namespace

Still load_still(const std::string& path, const ExrChoice& exr, Delivery& out) {
  Still still;
  std::string several;
  out.read(path, [&] {
    still.file = metrics::open_image(path);
    still.file.exr = exr;
    several = several_images(still.file.bytes);
  });
  still.picture = load_still(still.file, out);  // first, since a run begins anew where it needs a library
  if (!several.empty()) out.warn(fmt::format("{}: {}, of which the first is filtered", path, several));
  return still;
}

metrics::Picture load_still(const metrics::ImageFile& file, Delivery& out) {
  metrics::Picture picture;
  out.read(file.name, [&] { picture = metrics::decode_file(file, out.limits().pixels); });
  tell_layer(file, out);
  out.warn_of_flaw(picture.flaw), out.warn_of_flaw(picture.color_flaw);
  if (picture.is_scene_linear) warn_of_filled(file.name, fill_not_finite(picture.linear, file.name), out);
  return picture;
}

void warn_of_filled(const std::string& name, std::size_t pixels, Delivery& out) {
  if (pixels > 0)
    out.warn(fmt::format("{}: {} {} not finite, and {} the mean of neighbours", name, pixels,
                         pixels == 1 ? "pixel is" : "pixels are", pixels == 1 ? "takes" : "take"));
}

void lay_over(metrics::Picture& picture, float4 background) {
  Linear behind{decode_srgb(background.x), decode_srgb(background.y), decode_srgb(background.z), 1};
  if (picture.space && !picture.space->is_standard) behind = from_rec709(behind, *picture.space);
  for (Linear& c : picture.linear.values()) c = c + behind * ((1 - c.a) * background.w);
  // The codes of light are those of sRGB, whatever its primaries are.
  const DisplayImage laid = display_of(picture.linear, picture.is_scene_linear ? nullptr : picture.space);
  for (std::size_t i = 0; i < laid.values().size(); ++i)
    if (picture.display.values()[i].a != 1) picture.display.values()[i] = laid.values()[i];
}

std::size_t fill_not_finite(LinearImage& image, const std::string& name) {
  Fill fill(image);
  if (fill.undefined() == image.values().size()) throw Error(ErrorKind::Input, name + ": no pixel is finite");
  if (fill.undefined() > 0) fill.run();
  return fill.undefined();
}

}  // namespace zoneplate
