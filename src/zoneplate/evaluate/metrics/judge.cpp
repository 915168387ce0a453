// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/evaluate/metrics/judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/image/transfer.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/metrics/flip/magma.h"

namespace zoneplate {
namespace {

using metrics::Choice;
using metrics::Comparison;
using metrics::Metric;
using metrics::Picture;
using metrics::Result;

bool is_single(const Choice& choice) { return choice.metric->frames == 1; }

/// The value that a bound refers to; nothing if the metric does not have it.
std::optional<double> value_of(const Bound& bound, double value, const metrics::Score& score) {
  if (bound.figure.empty()) return value;
  for (const metrics::Figure& figure : score.more)
    if (figure.name == bound.figure) return figure.value;
  return std::nullopt;
}

void append(std::string& text, const std::string& more) { text += (text.empty() || more.empty() ? "" : "; ") + more; }

/// How a value misses a bound, as the text of a message; empty if it does not.
std::string shortfall(const Bound& bound, const std::optional<double>& found) {
  const Metric& metric = *bound.metric;
  if (found && metrics::is_as_good(metric, *found, bound.value)) return {};
  const std::string name = std::string(metric.name) + (bound.figure.empty() ? "" : "." + bound.figure);
  if (!found) return name + " has no value";
  return fmt::format("{} is {}, the threshold is {} or {}", name, number_text(*found), number_text(bound.value),
                     metric.better == metrics::Better::Lower ? "less" : "more");
}

/// What the images of a pair have in common: "name" or "number", with the shift if two whole sequences have one.
std::string pairing_of(const metrics::PictureSet& reference, const metrics::PictureSet& test) {
  const std::vector<std::uint64_t>&a = reference.numbers, &b = test.numbers;
  if (a.empty() || b.empty()) return reference.is_directory ? "name" : "number";
  const bool is_whole =
      a.size() == b.size() && a.back() - a.front() == a.size() - 1 && b.back() - b.front() == b.size() - 1;
  if (!is_whole || a.front() == b.front()) return "number";
  return fmt::format("number: the references are {} to {}, the test images {} to {}", a.front(), a.back(), b.front(),
                     b.back());
}

/// The pairs, and those of images that are neither there nor have a reference because they could not be rendered. A
/// pair has the name of its failed image, which its reference may have with another extension.
std::vector<metrics::PicturePair> with_failed(std::vector<metrics::PicturePair> pairs, const FailedRenders& failed) {
  const auto without_extension = [](const std::string& name) {
    return std::filesystem::path(name).replace_extension().string();
  };
  for (const auto& render : failed) {
    const std::string& name = render.first;
    const auto pair = std::ranges::find_if(pairs, [&](const metrics::PicturePair& p) {
      return p.name == name || (!p.test && without_extension(p.name) == without_extension(name));
    });
    if (pair == pairs.end())
      pairs.push_back({.name = name});
    else
      pair->name = name;
  }
  return pairs;
}

/// Judges one pair after another; everything else of the Judgement follows from the items.
class Judge {
 public:
  Judge(const metrics::PictureSet& reference, const metrics::PictureSet& test, const std::vector<Choice>& choices,
        const Verdicts& verdicts, bool keeps_evidence, bool has_one_pair)
      : reference_(reference),
        test_(test),
        verdicts_(verdicts),
        by_(pairing_of(reference, test)),
        keeps_evidence_(keeps_evidence),
        keeps_passed_(has_one_pair || (reference.are_frames && test.are_frames)) {
    for (const Choice& choice : choices) (is_single(choice) ? singles_ : sequences_).push_back(choice);
    for (const Choice& choice : choices) out_.pooled.push_back({.metric = choice.metric});
  }

  void add(const metrics::PicturePair& pair) {
    const Stopwatch watch;
    JudgedItem item{.name = pair.name};
    try {
      if (!pair.test) {
        unpaired(item, PairOutcome::Missing, "there is no test image of this " + by_);
      } else if (!pair.reference) {
        unpaired(item, PairOutcome::New, "there is no reference of this " + by_);
      } else {
        measure(*pair.reference, *pair.test, item);
      }
    } catch (const Error& error) {
      item.outcome = error.kind() == ErrorKind::Input ? PairOutcome::Unreadable : PairOutcome::Failed;
      item.message = error.what();
    } catch (const std::bad_alloc&) {
      item.outcome = PairOutcome::Unreadable;
      item.message = pair.name + ": needs more memory than the limit (--max-memory)";
    }
    if (!item.passed() && item.width == 0) keep_single(pair, item);
    item.seconds = watch.ms() / 1000;
    out_.items.push_back(std::move(item));
  }

  void add_failed(const metrics::PicturePair& pair, const std::string& cause) {
    JudgedItem item{.name = pair.name, .outcome = PairOutcome::NotRendered, .message = cause};
    keep_single(pair, item);
    out_.items.push_back(std::move(item));
  }

  Judgement finish(const std::vector<metrics::PicturePair>& pairs) {
    measure_sequences(pairs);
    const JudgedItem& first = out_.items.front();
    out_.is_sequence = out_.items.size() > 1 && reference_.are_frames && test_.are_frames && first.width > 0 &&
                       std::ranges::all_of(out_.items, [&](const JudgedItem& item) {
                         return item.width == first.width && item.height == first.height;
                       });
    std::erase_if(out_.pooled, [](const PooledResult& pooled) { return pooled.values.empty(); });
    for (PooledResult& pooled : out_.pooled)
      if (!pooled.items.empty())
        pooled.value = pooled.values.size() == 1 ? pooled.values[0] : pooled.metric->pool(pooled.values);
    // Values of several frames belong to no single image: their bounds always hold for the sequence.
    for (const Bound& bound : verdicts_.bounds)
      if (verdicts_.judges_mean || bound.metric->frames > 1) append(out_.pooled_message, pooled_shortfall(bound));
    return std::move(out_);
  }

 private:
  std::string pooled_shortfall(const Bound& bound) const {
    const auto found = std::ranges::find(out_.pooled, bound.metric, &PooledResult::metric);
    if (found == out_.pooled.end()) return shortfall(bound, std::nullopt);
    return shortfall(bound, value_of(bound, found->value, found->score));
  }

  void unpaired(JudgedItem& item, PairOutcome outcome, const std::string& message) const {
    item.outcome = verdicts_.allows_unpaired ? PairOutcome::Passed : outcome;
    item.message = message;
  }

  void measure(std::size_t reference_index, std::size_t test_index, JudgedItem& item) {
    const metrics::ImageFile reference_file = reference_.open(reference_index), test_file = test_.open(test_index);
    Picture reference = reference_.decode(reference_file), test = test_.decode(test_file);
    metrics::mark_ignored(reference, verdicts_.ignored);
    item.width = test.width(), item.height = test.height();
    item.stored = metrics::compare_stored(reference_file, reference, test_file, test);
    if (!metrics::share_space(reference, test))
      reference = metrics::in_srgb(std::move(reference)), test = metrics::in_srgb(std::move(test));
    std::string sizes;
    if (reference.width() != test.width() || reference.height() != test.height())
      sizes = fmt::format("{} × {} pixels, expected {} × {} as the reference", test.width(), test.height(),
                          reference.width(), reference.height());
    const auto takes_any = [](const Choice& c) { return c.metric->sizes == metrics::Sizes::ReferenceMultiple; };
    if (!sizes.empty() && std::ranges::none_of(singles_, takes_any)) {
      item.outcome = PairOutcome::Failed;
      item.message = sizes;
      if (keeps_evidence_) keep_evidence(reference, test, {}, item.evidence);
      return;
    }
    Comparison comparison;
    const metrics::Comparands one{.count = 1,
                                  .reference = [&](std::size_t) { return reference; },
                                  .test = [&](std::size_t) { return test; },
                                  .name = [&](std::size_t) { return item.name; }};
    try {
      comparison =
          metrics::compare(one, singles_, verdicts_.refuses_unfit ? metrics::Unfit::Refuse : metrics::Unfit::Leave);
    } catch (const Error& error) {  // the images were read: they are not what the metric measures
      item.outcome = PairOutcome::Failed;
      item.message = error.what();
      return;
    }
    decide(comparison.results, sizes, item);
    keep_maps(reference, test, comparison.results, item);
    for (Result& result : comparison.results) result.score.map = {};
    item.results = std::move(comparison.results);
    pool(item.results);
  }

  /// `sizes`: how the sizes differ, if they do.
  void decide(const std::vector<Result>& results, const std::string& sizes, JudgedItem& item) const {
    if (verdicts_.bounds.empty()) {
      if (!item.is_identical()) append(item.message, sizes.empty() ? "the images differ" : sizes);
    } else {
      for (const auto& [name, values] :
           {std::pair("the reference", &item.stored.reference), std::pair("the test image", &item.stored.test)})
        if (values->is_wrong)
          append(item.message, fmt::format("{} is not finite: {}", name, text_of(values->channels)));
      for (const Bound& bound : verdicts_.bounds)
        if (!verdicts_.judges_mean && bound.metric->frames == 1) append(item.message, shortfall_of(bound, results));
    }
    if (!item.message.empty()) item.outcome = PairOutcome::Failed;
  }

  static std::string shortfall_of(const Bound& bound, const std::vector<Result>& results) {
    const auto found = std::ranges::find(results, bound.metric, &Result::metric);
    if (found == results.end()) return shortfall(bound, std::nullopt);
    return shortfall(bound, value_of(bound, found->value, found->score));
  }

  /// Keeps the map if this image is the worst so far, and the evidence of a failure.
  void keep_maps(const Picture& reference, const Picture& test, const std::vector<Result>& results, JudgedItem& item) {
    const auto has_map = [](const Result& result) { return !result.score.map.empty(); };
    const auto with_map = std::ranges::find_if(results, has_map);
    if (with_map != results.end()) {
      const double value = with_map->value;
      const bool is_worse =
          !out_.worst_map ||
          (with_map->metric->better == metrics::Better::Lower ? value > worst_value_ : value < worst_value_);
      if (is_worse)
        worst_value_ = value, out_.worst_map = with_map->score.map, out_.worst_reference = reference.display;
    }
    if (keeps_evidence_ && (keeps_passed_ || !item.passed())) keep_evidence(reference, test, results, item.evidence);
  }

  /// Keeps what can be decoded of a pair that was not measured: of an image that is new, missing or unreadable, the
  /// other one.
  void keep_single(const metrics::PicturePair& pair, JudgedItem& item) {
    if (!keeps_evidence_) return;
    const auto decoded = [](const metrics::PictureSet& set, const std::optional<std::size_t>& index) {
      try {
        return index ? std::optional(set.load(*index)) : std::nullopt;
      } catch (const Error&) {  // the item's message has the cause
        return std::optional<Picture>();
      } catch (const std::bad_alloc&) {
        return std::optional<Picture>();
      }
    };
    const bool is_made = item.outcome != PairOutcome::NotRendered;  // a file of its name is of an earlier run
    keep_evidence(decoded(reference_, pair.reference), is_made ? decoded(test_, pair.test) : std::nullopt, {},
                  item.evidence);
  }

  /// The error map is that of FLIP, or else of the first metric that has one.
  void keep_evidence(const std::optional<Picture>& reference, const std::optional<Picture>& test,
                     const std::vector<Result>& results, Evidence& out) {
    if (evidence_bytes_ >= max_evidence_bytes) {
      out.is_left_out = true;
      return;
    }
    const auto encoded = [](const std::optional<Picture>& stored) {
      if (!stored) return PagePicture{};
      const Picture p = metrics::in_srgb(*stored);
      return p.is_scene_linear ? page_picture(p.linear) : page_picture(p.display);
    };
    out.reference = encoded(reference), out.test = encoded(test);
    const Result* with_map = nullptr;
    for (const Result& result : results)
      if (!result.score.map.empty() && (!with_map || result.metric->name == "flip")) with_map = &result;
    if (with_map) {
      out.errors = page_errors(with_map->score.map);
      out.error_name = with_map->metric->name == "flip" ? "FLIP" : with_map->metric->name;
      out.error_text = fmt::format("{} {}", out.error_name, number_text(with_map->value));
    }
    evidence_bytes_ += out.reference.png.size() + out.test.png.size() + out.errors.png.size();
  }

  void pool(const std::vector<Result>& results) {
    for (const Result& result : results) {
      PooledResult& pooled = *std::ranges::find(out_.pooled, result.metric, &PooledResult::metric);
      const bool is_worse = pooled.values.empty() || (result.metric->better == metrics::Better::Lower
                                                          ? result.value > pooled.values[pooled.worst]
                                                          : result.value < pooled.values[pooled.worst]);
      if (is_worse) pooled.worst = pooled.values.size(), pooled.score = result.score;
      pooled.values.push_back(result.value);
      pooled.items.push_back(out_.items.size());
    }
  }

  /// Metrics of several frames: over all pairs, if every frame could be compared.
  void measure_sequences(const std::vector<metrics::PicturePair>& pairs) {
    // The images of a folder, as photo1 and photo2, are a sequence only if a metric of several frames is requested.
    const bool are_listed = reference_.is_directory && !verdicts_.refuses_unfit;
    const bool is_sequence = reference_.are_frames && test_.are_frames && !are_listed;
    const bool is_complete =
        std::ranges::all_of(out_.items, [](const JudgedItem& item) { return item.width > 0; }) &&
        std::ranges::all_of(pairs, [](const metrics::PicturePair& pair) { return pair.reference && pair.test; });
    if (sequences_.empty() || (!verdicts_.refuses_unfit && !(is_sequence && is_complete))) return;
    if (!is_complete) {
      out_.pooled_message = "metrics of several frames require every frame";
      return;
    }
    const metrics::Comparands frames{
        .count = pairs.size(),
        .reference =
            [&](std::size_t i) {
              Picture picture = metrics::in_srgb(reference_.load(*pairs[i].reference));
              metrics::mark_ignored(picture, verdicts_.ignored);
              return picture;
            },
        .test = [&](std::size_t i) { return metrics::in_srgb(test_.load(*pairs[i].test)); },
        .are_frames = is_sequence,
        .name = [&](std::size_t i) { return pairs[i].name; }};
    Comparison comparison =
        metrics::compare(frames, sequences_, verdicts_.refuses_unfit ? metrics::Unfit::Refuse : metrics::Unfit::Leave);
    for (Result& result : comparison.results) {
      PooledResult& pooled = *std::ranges::find(out_.pooled, result.metric, &PooledResult::metric);
      pooled.value = result.value, pooled.values = std::move(result.values);
      pooled.worst = result.worst, pooled.worst_image = result.worst_image;
      if (!result.score.map.empty() && !out_.worst_map) {
        out_.worst_map = std::move(result.score.map);
        out_.worst_reference = reference_.load(*pairs[result.worst_image].reference).display;
      }
      pooled.score = std::move(result.score);
    }
  }

  static constexpr std::size_t max_evidence_bytes = std::size_t{256} << 20;  // browsers open no page of 512 MiB

  const metrics::PictureSet &reference_, &test_;
  std::vector<Choice> singles_, sequences_;
  const Verdicts& verdicts_;
  const std::string by_;  ///< what pairs have in common
  const bool keeps_evidence_, keeps_passed_;
  std::size_t evidence_bytes_ = 0;
  Judgement out_;
  double worst_value_ = 0;
};

}  // namespace

std::size_t Judgement::failures() const {
  return static_cast<std::size_t>(std::ranges::count_if(items, [](const JudgedItem& item) { return !item.passed(); }));
}

bool Judgement::is_identical() const { return std::ranges::all_of(items, &JudgedItem::is_identical); }

Judgement judge(const metrics::PictureSet& reference, const metrics::PictureSet& test,
                const std::vector<Choice>& choices, const Verdicts& verdicts, bool keeps_evidence,
                const std::function<void(double)>& progress) {
  const FailedRenders& failed_renders = verdicts.failed_renders;
  const std::vector<metrics::PicturePair> pairs = with_failed(metrics::pair_pictures(reference, test), failed_renders);
  Judge all(reference, test, choices, verdicts, keeps_evidence, pairs.size() == 1);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    progress(static_cast<double>(i) / static_cast<double>(pairs.size()));
    const auto failed = failed_renders.find(pairs[i].name);
    failed == failed_renders.end() ? all.add(pairs[i]) : all.add_failed(pairs[i], failed->second);
    check_deadline();  // its error ends the run, not the pair
  }
  Judgement out = all.finish(pairs);
  out.ignored = verdicts.ignored_texts;
  out.not_compared = reference.others;
  for (const std::string& other : test.others)
    if (std::ranges::find(out.not_compared, other) == out.not_compared.end()) out.not_compared.push_back(other);
  return out;
}

std::string text_of(const std::vector<metrics::ChannelCount>& counts) {
  std::string text;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    text += (text.empty() ? "" : ", ") + counts[i].channel;
    const bool is_last = i + 1 == counts.size();
    if (!is_last && counts[i + 1].pixels == counts[i].pixels) continue;
    text += fmt::format(" in {} {}", counts[i].pixels, counts[i].pixels == 1 ? "pixel" : "pixels");
  }
  return text;
}

std::string number_text(double value) { return fmt::format("{:.6g}", value + 0.0); }  // 0 for -0

Rgba8Image paint_over(const Plane<float>& map, const DisplayImage& reference, float gain) {
  Rgba8Image out(map.width(), map.height());
  const bool is_same_size = reference.width() == map.width() && reference.height() == map.height();
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const float error = std::clamp(map(x, y) * gain, 0.0f, 1.0f);
      const double grey = is_same_size ? metrics::luma(metrics::codes_on_black(reference(x, y))) : 0;
      const Rgba8 colour = metrics::magma(error);
      // The reference fades as the error grows; black of the colour map is then black, not the reference.
      const double weight = std::min(1.0, 4.0 * static_cast<double>(error));
      const auto mix = [&](std::uint8_t code) {
        return static_cast<std::uint8_t>(std::lround(weight * code + (1 - weight) * (64 + 127 * grey)));
      };
      out(x, y) = {mix(colour.r), mix(colour.g), mix(colour.b), 255};
    }
  return out;
}

}  // namespace zoneplate
