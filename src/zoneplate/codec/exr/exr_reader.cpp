// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/exr/exr_reader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <new>
#include <string_view>

#include "zoneplate/base/deadline.h"
#include "zoneplate/codec/exr/exr_chroma.h"
#include "zoneplate/codec/exr/exr_dwa.h"
#include "zoneplate/image/half.h"

namespace zoneplate {
namespace {

std::int64_t read_bytes(exr_const_context_t, void* user, void* out, std::uint64_t size, std::uint64_t offset,
                        exr_stream_error_func_ptr_t) {
  const auto& bytes = *static_cast<const std::span<const std::uint8_t>*>(user);
  if (offset >= bytes.size()) return 0;
  const std::uint64_t n = std::min<std::uint64_t>(size, bytes.size() - offset);
  std::memcpy(out, bytes.data() + offset, static_cast<std::size_t>(n));
  return static_cast<std::int64_t>(n);
}
std::int64_t size_of_bytes(exr_const_context_t, void* user) {
  return static_cast<std::int64_t>(static_cast<const std::span<const std::uint8_t>*>(user)->size());
}
void say_nothing(exr_const_context_t, exr_result_t, const char*) {}

/// Rows of numbers, initially zero. A page is allocated when it is first written, so that an image without data takes
/// no memory.
class Channel {
 public:
  Channel() = default;
  Channel(std::int64_t width, std::int64_t height)
      : width_(static_cast<std::size_t>(width)),
        values_(static_cast<float*>(
            std::calloc(static_cast<std::size_t>(std::max<std::int64_t>(width * height, 1)), sizeof(float)))) {
    if (!values_) throw std::bad_alloc();
  }
  explicit operator bool() const { return values_ != nullptr; }
  float operator()(std::size_t x, std::size_t y) const { return values_.get()[y * width_ + x]; }
  float* row(std::size_t y) { return values_.get() + y * width_; }

 private:
  struct Free {
    void operator()(float* values) const { std::free(values); }
  };
  std::size_t width_ = 0;
  std::unique_ptr<float, Free> values_;
};

bool keeps_numbers(const ExrSelection& selection) { return selection.values >= ExrValues::Bits; }

/// The number of multiples of `step` from `first` on, among `count` integers.
std::int64_t multiples(std::int64_t first, std::int64_t count, std::int64_t step) {
  const auto below = [&](std::int64_t end) { return (end >= 0 ? end + step - 1 : end) / step; };  // of 0 to end
  return below(first + count) - below(first);
}

/// Copies values of a type, which have any alignment, to every `step`th of `out`.
template <class T, class Value>
void copy_values(const std::uint8_t* from, std::int64_t count, const Value& value, std::int64_t step, float* out) {
  for (std::int64_t i = 0; i < count; ++i) {
    T stored;
    std::memcpy(&stored, from + i * std::int64_t{sizeof stored}, sizeof stored);
    out[i * step] = value(stored);
  }
}

void copy_values(const std::uint8_t* from, std::int64_t count, std::uint16_t type, ExrValues values, std::int64_t step,
                 float* out) {
  const auto bits = [](auto v) { return std::bit_cast<float>(std::uint32_t{v}); };
  if (values == ExrValues::Stored && type == EXR_PIXEL_HALF)
    return copy_values<std::uint16_t>(from, count, bits, step, out);
  if (values >= ExrValues::Bits && type == EXR_PIXEL_UINT)
    return copy_values<std::uint32_t>(from, count, bits, step, out);
  if (type == EXR_PIXEL_HALF) return copy_values<std::uint16_t>(from, count, half_value, step, out);
  if (type == EXR_PIXEL_FLOAT)
    return copy_values<float>(
        from, count, [](float v) { return v; }, step, out);
  copy_values<std::uint32_t>(
      from, count, [](std::uint32_t v) { return static_cast<float>(v); }, step, out);
}

/// Rows of a data window, counted from its first one.
struct Rows {
  std::int64_t first = 0, end = 0;

  std::int64_t count() const { return end - first; }
  bool contains(std::int64_t y) const { return y >= first && y < end; }
};

/// The rows that are decoded for a window: of chroma all, since those between its samples depend on many.
Rows rows_for(const ExrPlan& plan, const ExrSelection& selection) {
  const ExrWindow &data = plan.part.data, &out = plan.out;
  if (selection.kind == ExrLayer::Kind::Chroma) return {0, data.height()};
  const std::int64_t first = std::max(data.top, out.top), last = std::min(data.bottom, out.bottom);
  if (last < first) return {0, 0};
  return {first - data.top, last + 1 - data.top};
}

/// An open file, decoded into the channels of rows of its data window.
class ExrReader {
 public:
  ExrReader(const ExrLibrary& library, std::span<const std::uint8_t> bytes, const ExrPlan& plan,
            const ExrSelection& selection)
      : library_(library),
        bytes_(bytes),
        part_(plan.part),
        window_(plan.part.data),
        rows_(rows_for(plan, selection)),
        selection_(selection),
        channels_(selection.names.size()),
        sampling_(selection.names.size(), int2{1, 1}) {
    exr_context_initializer_t set_up{};
    set_up.size = sizeof set_up;
    set_up.error_handler_fn = say_nothing;
    set_up.user_data = &bytes_;
    set_up.read_fn = read_bytes;
    set_up.size_fn = size_of_bytes;
    set_up.zip_level = -1;
    set_up.dwa_quality = -1;
    // Memory that the library does not write is zero: truncated parts of a file never show other memory.
    set_up.alloc_fn = [](std::size_t size) { return std::calloc(1, size); };
    set_up.free_fn = [](void* memory) { std::free(memory); };
    library_.check(library_.start_read(&context_, "memory", &set_up));
    select_channels();
  }
  ~ExrReader() { library_.finish(&context_); }
  ExrReader(const ExrReader&) = delete;
  ExrReader& operator=(const ExrReader&) = delete;

  void read() {
    exr_storage_t storage{};
    library_.check(library_.storage(context_, selection_.part, &storage));
    if (storage == EXR_STORAGE_SCANLINE)
      read_scanlines();
    else if (storage == EXR_STORAGE_TILED)
      read_tiles();
    else
      throw ExrRefusal{"is deep, which is not read"};
    if (selection_.kind == ExrLayer::Kind::Chroma) {
      const std::optional<float3> weights =
          luminance_weights(part_.chromaticities ? *part_.chromaticities : rec709_chromaticities);
      if (!weights) throw ExrRefusal{"has chromaticities that are those of no colours"};
      make_colors({.width = static_cast<int>(window_.width()),
                   .height = static_cast<int>(window_.height()),
                   .luminance = channels_[1].row(0),
                   .red = {channels_[0].row(0), sampling_[0]},
                   .blue = {channels_[2].row(0), sampling_[2]}},
                  *weights);
    }
  }

  /// Copies a row of the data window, starting at column `first`, of the four channels of a group.
  void copy_row(int y, int first, std::size_t group, std::span<Linear> out) const {
    const auto value = [&](std::size_t c, std::size_t x) {
      const std::size_t slot = 4 * group + c;
      if (slot >= channels_.size() || !channels_[slot]) return c == 3 ? 1.0f : 0.0f;
      const float v = channels_[slot](x, static_cast<std::size_t>(y - rows_.first));
      if (selection_.values != ExrValues::Finite || std::isfinite(v)) return v;
      return std::isnan(v) ? 0.0f : std::copysign(65504.0f, v);
    };
    const bool is_grey = selection_.kind == ExrLayer::Kind::Grey;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const std::size_t x = static_cast<std::size_t>(first) + i;
      out[i].r = value(0, x);
      out[i].g = is_grey ? out[i].r : value(1, x);
      out[i].b = is_grey ? out[i].r : value(2, x);
      out[i].a = value(3, x);
    }
  }

 private:
  void select_channels() {
    const exr_attr_chlist_t* list = nullptr;
    library_.check(library_.channels(context_, selection_.part, &list));
    std::map<std::string_view, std::size_t> wanted;
    for (std::size_t i = 0; i < selection_.names.size(); ++i)
      if (!selection_.names[i].empty()) wanted.emplace(selection_.names[i], i);
    for (const auto& entry : std::span(list->entries, static_cast<std::size_t>(list->num_channels))) {
      const auto slot = wanted.find(entry.name.str);
      slots_.push_back(slot == wanted.end() ? std::nullopt : std::optional(slot->second));
      if (slots_.back()) prepare(entry, *slots_.back());
    }
    for (const auto& [name, slot] : wanted)
      if (!channels_[slot]) throw ExrRefusal{"has no channel " + std::string(name)};
    // Chroma that the file lacks is zero.
    if (selection_.kind == ExrLayer::Kind::Chroma)
      for (const std::size_t slot : {0u, 2u})
        if (!channels_[slot]) channels_[slot] = Channel(window_.width(), rows_.count()), sampling_[slot] = {1, 1};
  }

  void prepare(const exr_attr_chlist_entry_t& channel, std::size_t slot) {
    const std::string_view name = channel.name.str;
    const bool is_chroma = selection_.kind == ExrLayer::Kind::Chroma && (slot == 0 || slot == 2);
    const int2 sampling{channel.x_sampling, channel.y_sampling};
    const int most = keeps_numbers(selection_) ? std::max(sampling.x, sampling.y) : is_chroma ? 2 : 1;
    if (sampling.x > most || sampling.y > most)
      throw ExrRefusal{"has fewer samples in channel " + std::string(name) + " than " +
                       (is_chroma ? "in every second column and row" : "pixels") + ", which is not read"};
    if (window_.left % sampling.x != 0 || window_.width() % sampling.x != 0 || window_.top % sampling.y != 0 ||
        window_.height() % sampling.y != 0)
      throw ExrRefusal{"is corrupt: the data window divides the samples of channel " + std::string(name)};
    channels_[slot] = Channel(window_.width(), rows_.count()), sampling_[slot] = sampling;
  }

  /// Decodes a chunk whose first pixel is (x, y) of the data window.
  void read_chunk(const exr_chunk_info_t& chunk, std::int64_t x, std::int64_t y) {
    if (x < 0 || y < 0 || chunk.width < 1 || chunk.height < 1 || x + chunk.width > window_.width() ||
        y + chunk.height > window_.height())
      throw ExrRefusal{"is corrupt: a part lies outside the image"};
    check_deadline();
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    library_.check(library_.begin_decoding(context_, selection_.part, &chunk, &pipeline));
    const std::unique_ptr<exr_decode_pipeline_t, std::function<void(exr_decode_pipeline_t*)>> end(
        &pipeline, [this](exr_decode_pipeline_t* p) { library_.end_decoding(context_, p); });
    check_counts(pipeline, x, y);
    // The library decompresses. Its copies to channels are not used: they take the first channel's width for that of
    // all, swap channels or crash where one has no destination, depending on the version.
    library_.check(library_.choose_routines(context_, selection_.part, &pipeline));
    // A chunk that compression would not make smaller is stored as it is, which B44 in some versions does not know.
    const bool is_stored = chunk.packed_size == chunk.unpacked_size;
    if (!is_stored && chunk.compression == EXR_COMPRESSION_NONE)
      throw ExrRefusal{"is corrupt: a part has another size than its channels"};
    const bool is_dwa = chunk.compression == EXR_COMPRESSION_DWAA || chunk.compression == EXR_COMPRESSION_DWAB;
    if (is_stored || is_dwa) pipeline.decompress_fn = nullptr;
    pipeline.unpack_and_convert_fn = [](exr_decode_pipeline_t*) -> exr_result_t { return EXR_ERR_SUCCESS; };
    library_.check(library_.decode(context_, selection_.part, &pipeline));
    if (is_stored || !is_dwa) return copy_chunk(pipeline, pipeline.unpacked_buffer, x, y);
    const std::vector<std::uint8_t> unpacked = unpack_dwa(pipeline, y);
    copy_chunk(pipeline, unpacked.data(), x, y);
  }

  std::int64_t columns(const exr_coding_channel_info_t& channel, std::int64_t x, std::int64_t width) const {
    return multiples(window_.left + x, width, channel.x_samples);
  }

  /// Some versions of the library count the samples of a chunk in another way than the format, and decompress other
  /// channels to wrong places.
  void check_counts(const exr_decode_pipeline_t& pipeline, std::int64_t x, std::int64_t y) const {
    std::int64_t size = 0;
    if (static_cast<std::size_t>(pipeline.channel_count) != slots_.size())
      throw ExrRefusal{"is corrupt: a part has other channels than its header"};
    for (int i = 0; i < pipeline.channel_count; ++i) {
      const exr_coding_channel_info_t& c = pipeline.channels[i];
      const std::int64_t rows = multiples(window_.top + y, pipeline.chunk.height, c.y_samples);
      if (c.width != columns(c, x, pipeline.chunk.width) || c.height != rows)
        throw ExrRefusal{"has fewer samples in channel " + std::string(c.channel_name) +
                         " than pixels, and is packed in a way that is not read then"};
      size += std::int64_t{c.width} * rows * c.bytes_per_element;
    }
    if (static_cast<std::uint64_t>(size) != pipeline.chunk.unpacked_size)
      throw ExrRefusal{"is corrupt: a part has another size than its channels"};
  }

  /// Copies the channels of a decompressed chunk: row by row, those that have samples in it one after the other.
  void copy_chunk(const exr_decode_pipeline_t& pipeline, const void* unpacked, std::int64_t x, std::int64_t y) {
    const std::span channels(pipeline.channels, static_cast<std::size_t>(pipeline.channel_count));
    const auto* from = static_cast<const std::uint8_t*>(unpacked);
    for (std::int64_t row = y; row < y + pipeline.chunk.height; ++row)
      for (std::size_t i = 0; i < channels.size(); ++i) {
        const exr_coding_channel_info_t& c = channels[i];
        if ((window_.top + row) % c.y_samples != 0) continue;
        const std::int64_t count = columns(c, x, pipeline.chunk.width);
        if (const std::optional<std::size_t> slot = slots_[i]; slot && rows_.contains(row))
          copy_values(from, count, c.data_type, selection_.values, c.x_samples,
                      channels_[*slot].row(static_cast<std::size_t>(row - rows_.first)) + x);
        from += count * c.bytes_per_element;
      }
  }

  /// The bytes of a chunk that is packed by DWA.
  std::vector<std::uint8_t> unpack_dwa(const exr_decode_pipeline_t& pipeline, std::int64_t y) {
    if (!dwa_) dwa_.emplace();
    std::vector<DwaChannel> channels;
    for (const exr_coding_channel_info_t& c : std::span(pipeline.channels, slots_.size()))
      channels.push_back({.name = c.channel_name,
                          .type = static_cast<ExrType>(c.data_type),
                          .width = c.width,
                          .height = c.height,
                          .row_step = c.y_samples,
                          .is_linear = c.p_linear != 0});
    const exr_chunk_info_t& chunk = pipeline.chunk;
    std::vector<std::uint8_t> out(static_cast<std::size_t>(chunk.unpacked_size));
    const std::span packed(static_cast<const std::uint8_t*>(pipeline.packed_buffer),
                           static_cast<std::size_t>(chunk.packed_size));
    if (!dwa_->unpack(packed, channels, static_cast<int>(window_.top + y), out))
      throw ExrRefusal{"is corrupt or cut off: a part that DWA packs"};
    return out;
  }

  void read_scanlines() {
    std::int32_t lines = 0;
    library_.check(library_.scanlines_per_chunk(context_, selection_.part, &lines));
    if (lines < 1) throw ExrRefusal{"is corrupt"};
    for (std::int64_t y = rows_.first / lines * lines; y < rows_.end; y += lines) {
      exr_chunk_info_t chunk{};
      library_.check(library_.scanline_chunk(context_, selection_.part, static_cast<int>(window_.top + y), &chunk));
      read_chunk(chunk, 0, y);
    }
  }

  void read_tiles() {
    std::int32_t width = 0, height = 0;
    library_.check(library_.tile_sizes(context_, selection_.part, 0, 0, &width, &height));
    if (width < 1 || height < 1) throw ExrRefusal{"is corrupt"};
    for (std::int64_t j = rows_.first / height; j * height < rows_.end; ++j)
      for (std::int64_t i = 0; i * width < window_.width(); ++i) {
        exr_chunk_info_t chunk{};
        library_.check(
            library_.tile_chunk(context_, selection_.part, static_cast<int>(i), static_cast<int>(j), 0, 0, &chunk));
        read_chunk(chunk, i * width, j * height);
      }
  }

  const ExrLibrary& library_;
  std::span<const std::uint8_t> bytes_;
  const ExrPart& part_;
  ExrWindow window_;
  Rows rows_;
  const ExrSelection& selection_;
  exr_context_t context_ = nullptr;
  std::vector<Channel> channels_;                  ///< as the names of the selection; those not in the file: empty
  std::vector<int2> sampling_;                     ///< of these
  std::vector<std::optional<std::size_t>> slots_;  ///< of the file's channels
  std::optional<DwaDecoder> dwa_;                  ///< from the first chunk on that is packed so
};

}  // namespace

void read_exr_rows(const ExrLibrary& library, std::span<const std::uint8_t> bytes, const ExrPlan& plan,
                   const ExrSelection& selection, const std::function<void(std::span<const Linear>)>& take_row) {
  ExrReader reader(library, bytes, plan, selection);
  reader.read();
  const std::size_t groups = selection.groups();
  const ExrWindow &data = plan.part.data, &out = plan.out;
  const auto width = static_cast<std::size_t>(out.width());
  std::vector<Linear> row(groups * width);
  const std::int64_t left = std::max(data.left, out.left), right = std::min(data.right, out.right);
  for (std::int64_t y = out.top; y <= out.bottom; ++y) {
    check_deadline();
    std::fill(row.begin(), row.end(), Linear{0, 0, 0, 0});
    if (y >= data.top && y <= data.bottom && left <= right)
      for (std::size_t g = 0; g < groups; ++g)
        reader.copy_row(static_cast<int>(y - data.top), static_cast<int>(left - data.left), g,
                        std::span(row).subspan(g * width + static_cast<std::size_t>(left - out.left),
                                               static_cast<std::size_t>(right - left + 1)));
    take_row(row);
  }
}

std::uint64_t exr_reader_memory(const ExrPlan& plan, const ExrSelection& selection) {
  // Packed and unpacked bytes of a chunk, and what its decompression has beside them.
  constexpr std::uint64_t copies_of_chunk = 6;
  const auto width = static_cast<std::uint64_t>(plan.part.data.width());
  const auto rows = static_cast<std::uint64_t>(rows_for(plan, selection).count());
  return selection.names.size() * sizeof(float) * width * rows + copies_of_chunk * exr_chunk_bytes(plan.part);
}

}  // namespace zoneplate
