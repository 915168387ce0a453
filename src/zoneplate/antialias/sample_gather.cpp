#include "zoneplate/antialias/sample_gather.h"

#include <algorithm>
#include <cmath>

#include "zoneplate/antialias/codes.h"
#include "zoneplate/base/error.h"
#include "zoneplate/image/transfer.h"

namespace zoneplate::antialias {
namespace {

/// The greatest mean that is mapped back: 2^21 times white.
constexpr float greatest_mapped = 1 - 0x1p-21f;

float greatest(Linear c) { return std::max({c.r, c.g, c.b, 0.0f}); }

Linear scaled_light(Linear c, float s) { return {c.r * s, c.g * s, c.b * s, c.a}; }

/// Rec.709.
float luma(Linear c) { return std::max((0.2126f * c.r + 0.7152f * c.g) + 0.0722f * c.b, 0.0f); }

/// The kernel's values at a sample's distances from the centres of the pixels around, the farthest to the left first.
std::vector<float> taps_of(const Gathering& gathering, std::uint8_t offset) {
  const int reach = gathering.reach();
  if (!gathering.kernel) return {1};
  std::vector<float> taps;
  for (int d = -reach; d <= reach; ++d)
    taps.push_back(static_cast<float>(gathering.kernel->value(d + offset / 256.0 - 0.5)));
  return taps;
}

/// A sample as a screen shows it, in linear light again.
LinearImage displayed(const LinearImage& samples, const DisplayOptions& options) {
  const DisplayImage codes = make_display(samples, options);
  LinearImage out(codes.width(), codes.height());
  for_rows(codes.height(), [&](int y) {
    std::ranges::transform(codes.row(y), out.row(y).begin(), [&](Display c) {
      const auto light = [&](float v) { return (options.raw ? v : decode_srgb(v)) * c.a; };
      return Linear{light(c.r), light(c.g), light(c.b), c.a};
    });
  });
  return out;
}

}  // namespace

int Gathering::reach() const { return kernel ? static_cast<int>(std::ceil(kernel->radius + 0.5)) - 1 : 0; }

Gathering gathering_of(std::string_view method, const Settings& settings) {
  Gathering out{.weight = static_cast<SampleWeight>(settings.integer("resolve")), .kernel = {}};
  const double radius = settings.number("radius");
  if (settings.integer("filter") == 0) {
    if (settings.is_given("radius"))
      throw Error(Trouble::Usage, std::string(method) + ": radius is a filter's: give filter=mitchell, for example");
    return out;
  }
  out.kernel = make_kernel(settings.chosen("filter"));
  if (radius > 0) out.kernel = stretched(std::move(*out.kernel), radius / out.kernel->radius);
  return out;
}

void SampleGather::add(const Frame& frame, std::span<const SamplePosition> positions) {
  for (std::size_t s = 0; s < positions.size(); ++s) {
    const LinearImage& samples = frame.sample_color[s];
    if (gathering_.weight == SampleWeight::Display)
      add_plane(displayed(samples, frame.display), positions[s], 1);
    else
      add_plane(samples, positions[s], frame.display.exposure);
  }
}

void SampleGather::add_plane(const LinearImage& samples, SamplePosition position, float exposure) {
  if (sum_.empty()) {
    sum_ = LinearImage(samples.width(), samples.height(), Linear{0, 0, 0, 0});
    weight_ = Plane<float>(samples.width(), samples.height());
  }
  const std::vector<float> across = taps_of(gathering_, position.x), down = taps_of(gathering_, position.y);
  const int reach = gathering_.reach();
  for_rows(sum_.height(), [&](int y) {
    for (int dy = std::max(-reach, -y); dy <= std::min(reach, sum_.height() - 1 - y); ++dy) {
      const std::span<const Linear> row = samples.row(y + dy);
      for (int x = 0; x < sum_.width(); ++x)
        for (int dx = std::max(-reach, -x); dx <= std::min(reach, sum_.width() - 1 - x); ++dx) {
          Linear c = row[static_cast<std::size_t>(x + dx)];
          float w = down[static_cast<std::size_t>(dy + reach)] * across[static_cast<std::size_t>(dx + reach)];
          if (gathering_.weight == SampleWeight::Karis) w = w / (1 + luma(c) * exposure);
          if (gathering_.weight == SampleWeight::Max3) c = scaled_light(c, 1 / (1 + greatest(c)));
          sum_(x, y) = sum_(x, y) + c * w;
          weight_(x, y) += w;
        }
    }
  });
}

LinearImage SampleGather::light() const {
  LinearImage out(sum_.width(), sum_.height());
  for_rows(out.height(), [&](int y) {
    for (int x = 0; x < out.width(); ++x) {
      const Linear s = sum_(x, y);
      const float w = weight_(x, y);
      Linear mean{s.r / w, s.g / w, s.b / w, s.a / w};
      if (gathering_.weight == SampleWeight::Max3)
        mean = scaled_light(mean, 1 / (1 - std::min(greatest(mean), greatest_mapped)));
      out(x, y) = mean;
    }
  });
  return out;
}

DisplayImage SampleGather::shown(DisplayImage image, const DisplayOptions& display) const {
  if (gathering_.weight != SampleWeight::Display) return image;
  const LinearImage mean = light();
  for_rows(image.height(), [&](int y) {
    for (int x = 0; x < image.width(); ++x) {
      const Linear c = mean(x, y);
      const float alpha = std::clamp(c.a, 0.0f, 1.0f);
      const auto code = [&](float v) {
        const float straight = alpha > 0 ? std::clamp(v / alpha, 0.0f, 1.0f) : 0.0f;
        return display.raw ? straight : encode_srgb(straight);
      };
      image(x, y) = {code(c.r), code(c.g), code(c.b), alpha};
    }
  });
  return image;
}

}  // namespace zoneplate::antialias
