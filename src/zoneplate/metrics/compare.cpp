// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/metrics/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <utility>

#include "zoneplate/base/error.h"
#include "zoneplate/metrics/backdrop.h"
#include "zoneplate/metrics/ignored.h"
#include "zoneplate/metrics/metrics.h"

namespace zoneplate::metrics {
namespace {

/// The state of one metric while a list of images is compared.
struct Measurement {
  const Choice* choice = nullptr;
  bool is_left_out = false;
  Result result;
};

bool is_worse(const Metric& metric, double a, double b) { return metric.better == Better::Lower ? a > b : a < b; }

std::string size_of(const Picture& picture) { return fmt::format("{} × {}", picture.width(), picture.height()); }

/// The reason why a metric cannot measure images of these sizes; empty if it can.
std::string objection(const Metric& metric, const Picture& reference, const Picture& test) {
  if (std::min(test.width(), test.height()) < metric.smallest) {
    return fmt::format("has {} pixels, expected {} × {} at least", size_of(test), metric.smallest, metric.smallest);
  }
  if (metric.needs_whole_image && !reference.is_ignored.empty()) return "has ignored regions, expected a whole image";
  const int n = reference.width() / test.width();
  const bool is_multiple = n >= 1 && reference.width() == n * test.width() && reference.height() == n * test.height();
  if (!is_multiple || (metric.sizes == Sizes::Same && n != 1)) {
    return fmt::format("has {} pixels, expected {} as the reference", size_of(test), size_of(reference));
  }
  return {};
}

/// Throws for images of different sizes unless one of the metrics accepts them.
void check_pair(std::span<const Choice> choices, const Picture& reference, const Picture& test,
                const std::string& name) {
  const auto takes_any = [](const Choice& choice) { return choice.metric->sizes == Sizes::ReferenceMultiple; };
  const bool is_equal = reference.width() == test.width() && reference.height() == test.height();
  if (is_equal || std::ranges::any_of(choices, takes_any)) return;
  throw Error(ErrorKind::Input,
              fmt::format("{} has {} pixels, expected {} as the reference", name, size_of(test), size_of(reference)));
}

std::string name_of(const Comparands& pictures, std::size_t index) {
  return pictures.name ? pictures.name(index) : fmt::format("image {}", index + 1);
}

/// The worse of the scores of an image over two backdrops, which has the worse of each figure. The map is that of the
/// worse value.
std::optional<Score> worse_of(const Metric& metric, std::optional<Score> a, std::optional<Score> b) {
  if (!a || !b) return a ? std::move(a) : std::move(b);
  if (is_worse(metric, b->value, a->value)) std::swap(a, b);
  for (Figure& figure : a->more)
    for (const Figure& other : b->more)
      if (other.name == figure.name && is_worse(metric, other.value, figure.value)) figure.value = other.value;
  return a;
}

/// The last images of the reference or of the test, for the metrics of several frames. Images with alpha are kept over
/// both backdrops, and as given only if a metric defines alpha itself.
class Window {
 public:
  Window(std::size_t length, bool keeps_plain) : length_(length), keeps_plain_(keeps_plain) {}

  const Picture& newest() const { return images_.back(); }
  std::size_t size() const { return images_.size(); }
  /// As given.
  Frames plain(std::size_t count) const { return Frames(images_).last(count); }
  Frames on(Backdrop backdrop, std::size_t count) const {
    if (!is_laid_) return plain(count);
    if (backdrop == Backdrop::White) return Frames(white_).last(count);
    return Frames(keeps_plain_ ? black_ : images_).last(count);
  }

  void add(Picture picture) {
    if (images_.size() == length_) drop_first();
    images_.push_back(std::move(picture));
    if (is_laid_) lay(images_.back());
  }

  /// From now on keeps the images over both backdrops; opaque ones need none.
  void lay_all() {
    if (std::exchange(is_laid_, true)) return;
    for (Picture& picture : images_) lay(picture);
  }

 private:
  void drop_first() {
    for (std::vector<Picture>* all : {&images_, &black_, &white_})
      if (!all->empty()) all->erase(all->begin());
  }
  void lay(Picture& picture) {
    white_.push_back(laid_on(picture, Backdrop::White));
    if (keeps_plain_)
      black_.push_back(laid_on(picture, Backdrop::Black));
    else
      picture = laid_on(std::move(picture), Backdrop::Black);
  }

  std::size_t length_;
  bool keeps_plain_, is_laid_ = false;
  std::vector<Picture> images_, black_, white_;  ///< as given, or over black; over black; over white
};

bool defines_alpha(const Choice& choice) {
  return choice.metric->defines_alpha && choice.metric->defines_alpha(choice.settings);
}

void leave_out(Measurement& m, Unfit unfit, const std::string& name, const std::string& why) {
  if (unfit == Unfit::Refuse) {
    throw Error(ErrorKind::Input, fmt::format("metric {}: {} {}", m.choice->metric->name, name, why));
  }
  m.is_left_out = true;
}

constexpr const char* nothing_to_measure = "has nothing that it could measure";

std::optional<Score> score_of(const Choice& choice, const Window& reference, const Window& test, std::size_t frames,
                              bool has_alpha) {
  const Metric& metric = *choice.metric;
  if (!has_alpha || defines_alpha(choice))
    return metric.measure(reference.plain(frames), test.plain(frames), choice.settings);
  const auto on = [&](Backdrop backdrop) {
    return metric.measure(reference.on(backdrop, frames), test.on(backdrop, frames), choice.settings);
  };
  std::optional<Score> black = on(Backdrop::Black);
  return worse_of(metric, std::move(black), on(Backdrop::White));
}

/// Measures the last frames of the windows, the newest of which is image `index`, called `name`.
void measure(Measurement& m, const Window& reference, const Window& test, bool has_alpha, std::size_t index,
             const std::string& name, Unfit unfit) {
  const Metric& metric = *m.choice->metric;
  const auto required = static_cast<std::size_t>(metric.frames);
  const std::size_t frames = metric.starts_short ? std::min(required, reference.size()) : required;
  if (m.is_left_out || reference.size() < frames) return;
  const std::string why = objection(metric, reference.newest(), test.newest());
  if (!why.empty()) return leave_out(m, unfit, name, why);

  auto score = score_of(*m.choice, reference, test, frames, has_alpha);
  if (!score && metric.frames > 1) return;  // a later window may have it
  if (!score) return leave_out(m, unfit, name, nothing_to_measure);
  Result& result = m.result;
  if (result.values.empty() || is_worse(metric, score->value, result.values[result.worst])) {
    result.worst = result.values.size(), result.worst_image = index;
    result.score = std::move(*score);
    result.values.push_back(result.score.value);
  } else {
    result.values.push_back(score->value);
  }
}

void check_sizes(const Picture& first, const Picture& next, std::size_t index, std::string_view which) {
  if (first.width() == next.width() && first.height() == next.height()) return;
  throw Error(ErrorKind::Input, fmt::format("{} frame {}: has {} pixels, expected {} as the frame before it", which,
                                            index + 1, size_of(next), size_of(first)));
}

DisplayImage display_of(const Rgba8Image& image) {
  DisplayImage out(image.width(), image.height());
  for (std::size_t i = 0; i < out.values().size(); ++i) {
    const Rgba8& c = image.values()[i];
    const auto code = [](std::uint8_t value) { return static_cast<float>(value) / 255; };
    out.values()[i] = {code(c.r), code(c.g), code(c.b), code(c.a)};
  }
  return out;
}

}  // namespace

Comparison compare(const Comparands& pictures, std::span<const Choice> choices, Unfit unfit) {
  assert(pictures.count > 0);
  Comparison out{.count = pictures.count};
  std::vector<Measurement> measurements;
  std::size_t window = 1;
  for (const Choice& choice : choices) {
    Measurement m{.choice = &choice};
    m.result.metric = choice.metric;
    const auto frames = static_cast<std::size_t>(choice.metric->frames);
    const std::size_t least = choice.metric->starts_short ? 2 : frames;
    if (frames > 1 && (!pictures.are_frames || pictures.count < least)) {
      leave_out(m, unfit, name_of(pictures, 0), fmt::format("is not one of {} or more frames of a sequence", least));
    } else {
      window = std::max(window, frames);
    }
    measurements.push_back(std::move(m));
  }

  const bool keeps_plain = std::ranges::any_of(choices, defines_alpha);
  Window reference(window, keeps_plain), test(window, keeps_plain);
  bool has_any_alpha = false;
  for (std::size_t i = 0; i < pictures.count; ++i) {
    Picture next_reference = pictures.reference(i), next_test = pictures.test(i);
    hide_ignored(next_reference, next_test);
    out.are_same = out.are_same && has_same_values(next_reference, next_test);
    next_reference = finite(std::move(next_reference)), next_test = finite(std::move(next_test));
    if (pictures.are_frames && i > 0) {
      check_sizes(reference.newest(), next_reference, i, "reference");
      check_sizes(test.newest(), next_test, i, "test");
    }
    has_any_alpha = has_any_alpha || has_alpha(next_reference) || has_alpha(next_test);
    reference.add(std::move(next_reference)), test.add(std::move(next_test));
    if (has_any_alpha) reference.lay_all(), test.lay_all();
    check_pair(choices, reference.newest(), test.newest(), name_of(pictures, i));
    out.width = test.newest().width(), out.height = test.newest().height();
    for (Measurement& m : measurements) measure(m, reference, test, has_any_alpha, i, name_of(pictures, i), unfit);
  }

  for (Measurement& m : measurements) {
    if (!m.is_left_out && m.result.values.empty()) leave_out(m, unfit, name_of(pictures, 0), nothing_to_measure);
    if (m.is_left_out) continue;
    m.result.value = m.result.values.size() == 1 ? m.result.values[0] : m.choice->metric->pool(m.result.values);
    out.results.push_back(std::move(m.result));
  }
  return out;
}

std::vector<Choice> default_choices(std::span<const Metric> catalogue) {
  std::vector<Choice> choices;
  for (const Metric& metric : catalogue) {
    if (metric.is_default) choices.push_back({&metric, Settings(metric.params)});
  }
  return choices;
}

bool is_as_good(const Metric& metric, double value, double threshold) {
  return metric.better == Better::Lower ? value <= threshold : value >= threshold;
}

double measure(const Rgba8Image& reference, const Rgba8Image& test, std::string_view metric) {
  const Choice choice = choose_metric(metrics(), metric);
  const Comparands both{.count = 1,
                        .reference = [&](std::size_t) { return make_picture(display_of(reference)); },
                        .test = [&](std::size_t) { return make_picture(display_of(test)); }};
  return compare(both, {&choice, 1}, Unfit::Refuse).results.front().value;
}

}  // namespace zoneplate::metrics
