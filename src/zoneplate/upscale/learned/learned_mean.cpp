// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/upscale/learned/learned_mean.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <utility>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/network/trained.h"
#include "zoneplate/upscale/learned/learned_rows.h"
#include "zoneplate/upscale/taau/taau_axis.h"

namespace zoneplate::upscale {
namespace {

/// Which output pixels belong to a pixel of the frame along one axis, and the reverse: its sample is the nearest to
/// them.
struct Halves {
  std::vector<std::int32_t> first,
      second;                      ///< for each pixel of the frame, the output pixels before and after its sample
  std::vector<std::int32_t> half;  ///< for each output pixel, 0 or 1: before or after the sample

  Halves(const TaauAxis& axis, int from) {
    const auto outputs = static_cast<std::int32_t>(axis.offset.size());
    for (const float offset : axis.offset) half.push_back(offset < 0 ? 0 : 1);
    // At the edges a pixel may have one alone: its nearest neighbours stand for the other.
    for (std::vector<std::int32_t>* const list : {&first, &second}) {
      const std::int32_t wanted = list == &first ? 0 : 1;
      list->assign(static_cast<std::size_t>(from), -1);
      for (std::int32_t o = 0; o < outputs; ++o) {
        const auto at = static_cast<std::size_t>(o);
        std::int32_t& found = (*list)[static_cast<std::size_t>(axis.around[1][at])];
        if (half[at] == wanted && found < 0) found = o;
      }
    }
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (first[i] < 0) first[i] = std::max(second[i], 0);
      if (second[i] < 0) second[i] = first[i];
    }
  }
};

/// A history of each output pixel.
struct Histories {
  LinearImage color;
  Plane<float> count, inside, filtered;
  Histories(int width, int height)
      : color(width, height), count(width, height), inside(width, height), filtered(width, height) {}
  HistoryRow row(int y) {
    return {&color.row(y).data()->r, count.row(y).data(), inside.row(y).data(), filtered.row(y).data()};
  }
};

}  // namespace

/// What is known of a frame, kept for the next one of its size: memory for each frame anew takes longer than the
/// network.
struct LearnedMean::Work {
  LinearImage current;
  Histories near, own;
  network::NetworkFrame network;
  Plane<float> unrest, past_unrest;

  Work(int width, int height, int frame_width, int frame_height)
      : current(width, height),
        near(width, height),
        own(width, height),
        network(frame_width, frame_height, LearnedNetwork::features),
        unrest(frame_width, frame_height),
        past_unrest(frame_width, frame_height) {}
  void describe(const Known& known, const Halves& across, const Halves& down);
  GatheredRow row(int y) { return {&current.row(y).data()->r, near.row(y), own.row(y)}; }
};

/// The features of a frame's pixels, for the network.
void LearnedMean::Work::describe(const Known& known, const Halves& across, const Halves& down) {
  const TaauInput& input = known.input;
  const LinearImage& color = known.color;
  const Boxes& boxes = known.boxes;
  const Followed& followed = known.followed;
  const int frame_width = color.width(), frame_height = color.height();
  std::vector<float> column(static_cast<std::size_t>(frame_width));
  std::iota(column.begin(), column.end(), 0.0f);
  const auto first_of = [](float jitter) {
    const float place = 0.25f + jitter;
    return place - std::floor(2 * place) / 2 - 0.5f;
  };
  std::swap(unrest, past_unrest);
  parallel_ranges(static_cast<std::size_t>(frame_height), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const int y = static_cast<int>(i);
      const auto of = [&](const Plane<float>& plane) { return plane.row(y).data(); };
      LearnedKernels::of().describe({.color = &color.row(y).data()->r,
                                     .low = &boxes.low.row(y).data()->r,
                                     .high = &boxes.high.row(y).data()->r,
                                     .alike = of(boxes.alike),
                                     .borrowed = of(followed.borrowed),
                                     .steady = of(followed.steady),
                                     .uncovered = of(followed.uncovered),
                                     .kept = of(followed.kept),
                                     .change = of(followed.change),
                                     .trend = of(boxes.trend),
                                     .follow_x = of(followed.x),
                                     .follow_y = of(followed.y),
                                     .nearest = of(followed.nearest),
                                     .nearness = input.nearness.values().data(),
                                     .past_unrest = past_unrest.values().data(),
                                     .column = column.data(),
                                     .y = y,
                                     .width = frame_width,
                                     .height = frame_height,
                                     .first = {first_of(input.jitter.x), first_of(input.jitter.y)},
                                     .scale = {2, 2},
                                     .above = row(down.first[i]),
                                     .below = row(down.second[i]),
                                     .left = across.first.data(),
                                     .right = across.second.data(),
                                     .features = network.features.at(0, y),
                                     .unrest = unrest.row(y).data()},
                                    static_cast<std::size_t>(frame_width));
    }
  });
}

const network::Network& LearnedNetwork::trained() {
  static const network::Network network(network::trained_weights(network::Trained::Learned), form, "the program's own");
  return network;
}

LearnedMean::LearnedMean(int width, int height, const network::Network& network)
    : SampleMean(width, height), network_(network) {}
LearnedMean::~LearnedMean() = default;

void LearnedMean::resolve(const Known& known, Output& out) {
  const TaauInput& input = known.input;
  const int frame_width = known.color.width(), frame_height = known.color.height();
  if (input.is_first || !work_) work_ = std::make_unique<Work>(width(), height(), frame_width, frame_height);
  Work& work = *work_;
  const auto pixels = static_cast<std::size_t>(width());
  const TaauAxis columns(width(), frame_width, input.jitter.x), rows(height(), frame_height, input.jitter.y);
  for_output_rows(known, [&](const SampleMeanFrame& frame, SampleMeanRow& row) {
    const int middle = rows.around[1][static_cast<std::size_t>(row.y)];
    LearnedKernels::of().gather(frame, row, input.motion_x.row(middle).data(), input.motion_y.row(middle).data(),
                                work.row(row.y), pixels);
  });

  const Halves across(columns, frame_width), down(rows, frame_height);
  work.describe(known, across, down);
  network_.read(work.network);

  // A part of a row at a time, so that its corrections stay in the cache.
  constexpr std::size_t part = 128;
  for_output_rows(known, [&](const SampleMeanFrame& frame, SampleMeanRow& row) {
    const auto y = static_cast<std::size_t>(row.y);
    row.resolved = &out.image.row(row.y).data()->r, row.count = out.count.row(row.y).data();
    const int half = down.half[y];
    float corrections[(part / 2 + 4) * LearnedNetwork::per_pixel];
    std::int32_t middle[part];
    for (std::size_t begin = 0; begin < pixels; begin += part) {
      const std::size_t end = std::min(begin + part, pixels);
      const std::int32_t* const of = columns.around[1].data();
      network_.write(work.network, of[begin], rows.around[1][y], of[end - 1] - of[begin] + 1,
                     LearnedNetwork::first[half], LearnedNetwork::per_pixel, corrections);
      for (std::size_t x = begin; x < end; ++x)
        middle[x - begin] = (of[x] - of[begin]) * LearnedNetwork::per_pixel + LearnedNetwork::begins[half] +
                            LearnedNetwork::corrections * across.half[x];
      LearnedKernels::of().blend(frame, row, work.row(row.y),
                                 {.begin = begin, .corrections = corrections, .middle = middle}, end - begin);
    }
  });
}

const FilterTable& learned_filters() {
  static const FilterTable table(network::trained_weights(network::Trained::LearnedFilters), CountGroups::form,
                                 "the program's own");
  return table;
}

}  // namespace zoneplate::upscale
