// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/exr/exr.h"

#include <dlfcn.h>
#include <openexr.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <string_view>
#include <vector>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/exr/exr_chroma.h"
#include "zoneplate/codec/exr/exr_dwa.h"
#include "zoneplate/codec/exr/exr_header.h"
#include "zoneplate/codec/exr/exr_layer.h"
#include "zoneplate/image/half.h"
#include "zoneplate/os/library.h"
#include "zoneplate/os/limited_child.h"

namespace zoneplate {
namespace {

/// The reason why an image is rejected.
struct Refusal {
  std::string cause;
};

using Window = ExrWindow;

struct Windows {
  Window data, display;
};

/// The data and display windows of a part; nothing if the header is wrong.
std::optional<Windows> windows_of(const std::optional<ExrPart>& part) {
  if (!part || !part->data.is_sound() || !part->display.is_sound()) return std::nullopt;
  return Windows{part->data, part->display};
}

std::optional<Windows> find_windows(std::span<const std::uint8_t> bytes) { return windows_of(read_exr_part(bytes)); }

/// The functions of libOpenEXRCore that this file calls. The library is loaded at run time; the program is not linked
/// to it.
struct ExrLibrary {
  decltype(&exr_start_read) start_read = nullptr;
  decltype(&exr_finish) finish = nullptr;
  decltype(&exr_get_default_error_message) error_text = nullptr;
  decltype(&exr_get_storage) storage = nullptr;
  decltype(&exr_get_channels) channels = nullptr;
  decltype(&exr_get_scanlines_per_chunk) scanlines_per_chunk = nullptr;
  decltype(&exr_get_tile_sizes) tile_sizes = nullptr;
  decltype(&exr_read_scanline_chunk_info) scanline_chunk = nullptr;
  decltype(&exr_read_tile_chunk_info) tile_chunk = nullptr;
  decltype(&exr_decoding_initialize) begin_decoding = nullptr;
  decltype(&exr_decoding_choose_default_routines) choose_routines = nullptr;
  decltype(&exr_decoding_run) decode = nullptr;
  decltype(&exr_decoding_destroy) end_decoding = nullptr;

  explicit ExrLibrary(const std::string& file) {
    const SharedLibrary library(Library::OpenExr, file + ": an EXR image");
    library.find(start_read, "exr_start_read");
    library.find(finish, "exr_finish");
    library.find(error_text, "exr_get_default_error_message");
    library.find(storage, "exr_get_storage");
    library.find(channels, "exr_get_channels");
    library.find(scanlines_per_chunk, "exr_get_scanlines_per_chunk");
    library.find(tile_sizes, "exr_get_tile_sizes");
    library.find(scanline_chunk, "exr_read_scanline_chunk_info");
    library.find(tile_chunk, "exr_read_tile_chunk_info");
    library.find(begin_decoding, "exr_decoding_initialize");
    library.find(choose_routines, "exr_decoding_choose_default_routines");
    library.find(decode, "exr_decoding_run");
    library.find(end_decoding, "exr_decoding_destroy");
  }

  void check(exr_result_t result) const {
    if (result == EXR_ERR_FEATURE_NOT_IMPLEMENTED) throw Refusal{"is packed in a way that is not read"};
    if (result != EXR_ERR_SUCCESS) throw Refusal{std::string("is corrupt or cut off: ") + error_text(result)};
  }
};

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
  explicit Channel(const Window& window)
      : width_(static_cast<std::size_t>(window.width())),
        values_(static_cast<float*>(std::calloc(static_cast<std::size_t>(window.pixels()), sizeof(float)))) {
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

/// The values of channels, which are handed on as floats.
enum class Values {
  Finite,  ///< as floats, in which NaN becomes 0, infinity 65504
  Floats,  ///< as floats
  Bits,    ///< as floats, but whole numbers as their bits
  Stored,  ///< all as their bits
};

/// What is decoded of a file.
struct Selection {
  int part = 0;
  std::vector<std::string> names;  ///< of the channels; empty: one that the file lacks
  ExrLayer::Kind kind = ExrLayer::Kind::Colors;
  Values values = Values::Floats;
  std::optional<Window> window;  ///< none: the display window
};

bool keeps_numbers(const Selection& selection) { return selection.values >= Values::Bits; }

/// Channels are handed on four by four, as pixels.
std::size_t groups_of(const Selection& selection) { return (selection.names.size() + 3) / 4; }

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

void copy_values(const std::uint8_t* from, std::int64_t count, std::uint16_t type, Values values, std::int64_t step,
                 float* out) {
  const auto bits = [](auto v) { return std::bit_cast<float>(std::uint32_t{v}); };
  if (values == Values::Stored && type == EXR_PIXEL_HALF)
    return copy_values<std::uint16_t>(from, count, bits, step, out);
  if (values >= Values::Bits && type == EXR_PIXEL_UINT) return copy_values<std::uint32_t>(from, count, bits, step, out);
  if (type == EXR_PIXEL_HALF) return copy_values<std::uint16_t>(from, count, half_value, step, out);
  if (type == EXR_PIXEL_FLOAT)
    return copy_values<float>(
        from, count, [](float v) { return v; }, step, out);
  copy_values<std::uint32_t>(
      from, count, [](std::uint32_t v) { return static_cast<float>(v); }, step, out);
}

/// An open file, decoded into the channels of its data window. It exists in the child process only.
class ExrReader {
 public:
  ExrReader(const ExrLibrary& library, std::span<const std::uint8_t> bytes, const ExrPart& part,
            const Selection& selection)
      : library_(library),
        bytes_(bytes),
        part_(part),
        window_(part.data),
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
    find_channels();
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
      throw Refusal{"is deep, which is not read"};
    if (selection_.kind == ExrLayer::Kind::Chroma) {
      const std::optional<float3> weights =
          luminance_weights(part_.chromaticities ? *part_.chromaticities : rec709_chromaticities);
      if (!weights) throw Refusal{"has chromaticities that are those of no colours"};
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
      const float v = channels_[slot](x, static_cast<std::size_t>(y));
      if (selection_.values != Values::Finite || std::isfinite(v)) return v;
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
  /// The slot of `channels_` that holds a channel; nothing if the channel is ignored.
  std::optional<std::size_t> slot_of(std::string_view channel) const {
    const auto found = std::ranges::find(selection_.names, channel);
    if (found == selection_.names.end() || channel.empty()) return std::nullopt;
    return static_cast<std::size_t>(found - selection_.names.begin());
  }

  void find_channels() {
    const exr_attr_chlist_t* list = nullptr;
    library_.check(library_.channels(context_, selection_.part, &list));
    const std::span entries(list->entries, static_cast<std::size_t>(list->num_channels));
    for (const std::string& name : selection_.names)
      if (!name.empty() && std::ranges::none_of(entries, [&](const auto& e) { return e.name.str == name; }))
        throw Refusal{"has no channel " + name};
    for (const exr_attr_chlist_entry_t& entry : entries) slots_.push_back(prepare(entry));
    // Chroma that the file lacks is zero.
    if (selection_.kind == ExrLayer::Kind::Chroma)
      for (const std::size_t slot : {0u, 2u})
        if (!channels_[slot]) channels_[slot] = Channel(window_), sampling_[slot] = {1, 1};
  }

  /// Makes the slot of a channel, if it has one.
  std::optional<std::size_t> prepare(const exr_attr_chlist_entry_t& channel) {
    const std::string_view name = channel.name.str;
    const std::optional<std::size_t> slot = slot_of(name);
    if (!slot) return slot;
    const bool is_chroma = selection_.kind == ExrLayer::Kind::Chroma && (*slot == 0 || *slot == 2);
    const int2 sampling{channel.x_sampling, channel.y_sampling};
    const int most = keeps_numbers(selection_) ? std::max(sampling.x, sampling.y) : is_chroma ? 2 : 1;
    if (sampling.x > most || sampling.y > most)
      throw Refusal{"has fewer samples in channel " + std::string(name) + " than " +
                    (is_chroma ? "in every second column and row" : "pixels") + ", which is not read"};
    if (window_.left % sampling.x != 0 || window_.width() % sampling.x != 0 || window_.top % sampling.y != 0 ||
        window_.height() % sampling.y != 0)
      throw Refusal{"is corrupt: the data window divides the samples of channel " + std::string(name)};
    channels_[*slot] = Channel(window_), sampling_[*slot] = sampling;
    return slot;
  }

  /// Decodes a chunk whose first pixel is (x, y) of the data window.
  void read_chunk(const exr_chunk_info_t& chunk, std::int64_t x, std::int64_t y) {
    if (x < 0 || y < 0 || chunk.width < 1 || chunk.height < 1 || x + chunk.width > window_.width() ||
        y + chunk.height > window_.height())
      throw Refusal{"is corrupt: a part lies outside the image"};
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
      throw Refusal{"is corrupt: a part has another size than its channels"};
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
      throw Refusal{"is corrupt: a part has other channels than its header"};
    for (int i = 0; i < pipeline.channel_count; ++i) {
      const exr_coding_channel_info_t& c = pipeline.channels[i];
      const std::int64_t rows = multiples(window_.top + y, pipeline.chunk.height, c.y_samples);
      if (c.width != columns(c, x, pipeline.chunk.width) || c.height != rows)
        throw Refusal{"has fewer samples in channel " + std::string(c.channel_name) +
                      " than pixels, and is packed in a way that is not read then"};
      size += std::int64_t{c.width} * rows * c.bytes_per_element;
    }
    if (static_cast<std::uint64_t>(size) != pipeline.chunk.unpacked_size)
      throw Refusal{"is corrupt: a part has another size than its channels"};
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
        if (const std::optional<std::size_t> slot = slots_[i])
          copy_values(from, count, c.data_type, selection_.values, c.x_samples,
                      channels_[*slot].row(static_cast<std::size_t>(row)) + x);
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
      throw Refusal{"is corrupt or cut off: a part that DWA packs"};
    return out;
  }

  void read_scanlines() {
    std::int32_t lines = 0;
    library_.check(library_.scanlines_per_chunk(context_, selection_.part, &lines));
    if (lines < 1) throw Refusal{"is corrupt"};
    for (std::int64_t y = window_.top; y <= window_.bottom; y += lines) {
      exr_chunk_info_t chunk{};
      library_.check(library_.scanline_chunk(context_, selection_.part, static_cast<int>(y), &chunk));
      read_chunk(chunk, 0, y - window_.top);
    }
  }

  void read_tiles() {
    std::int32_t width = 0, height = 0;
    library_.check(library_.tile_sizes(context_, selection_.part, 0, 0, &width, &height));
    if (width < 1 || height < 1) throw Refusal{"is corrupt"};
    for (std::int64_t j = 0; j * height < window_.height(); ++j)
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
  Window window_;
  const Selection& selection_;
  exr_context_t context_ = nullptr;
  std::vector<Channel> channels_;                  ///< as the names of the selection; those not in the file: empty
  std::vector<int2> sampling_;                     ///< of these
  std::vector<std::optional<std::size_t>> slots_;  ///< of the file's channels
  std::optional<DwaDecoder> dwa_;                  ///< from the first chunk on that is packed so
};

/// The part of a file that is decoded, and the pixels that are handed on.
struct Plan {
  ExrPart part;
  Window out;
};

/// Calls `send(row)` for each row of `plan.out`: pixels of one group of channels after the other. Those outside the
/// data window are transparent black.
template <class Send>
void send_rows(const ExrReader& reader, const Plan& plan, std::size_t groups, Send& send) {
  const Window &data = plan.part.data, &out = plan.out;
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
    send(std::span<const Linear>(row));
  }
}

}  // namespace

bool is_exr(std::span<const std::uint8_t> bytes) {
  constexpr std::array<std::uint8_t, 4> magic = {0x76, 0x2f, 0x31, 0x01};
  return bytes.size() >= 8 && std::equal(magic.begin(), magic.end(), bytes.begin());
}

std::optional<int2> find_exr_size(std::span<const std::uint8_t> bytes) {
  const std::optional<Windows> windows = find_windows(bytes);
  if (!windows) return std::nullopt;
  return int2{static_cast<int>(windows->display.width()), static_cast<int>(windows->display.height())};
}

std::uint64_t exr_working_memory(std::span<const std::uint8_t> bytes) {
  const std::optional<Windows> windows = find_windows(bytes);
  return windows ? sizeof(Linear) * windows->data.pixels() : 0;
}

namespace {

Error failure(const std::string& name, const std::string& cause) {
  return {ErrorKind::Input, name + ": EXR: " + cause};
}

Plan plan_of(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels,
             const Selection& selection) {
  const std::vector<ExrPart> parts = read_exr_parts(bytes);
  const auto index = static_cast<std::size_t>(selection.part);
  const std::optional<Windows> windows = windows_of(index < parts.size() ? std::optional(parts[index]) : std::nullopt);
  if (!windows) throw failure(name, "the header is wrong");
  const Window &own = windows->display, &first = parts[0].display;
  if (own.width() != first.width() || own.height() != first.height())
    throw failure(name, "part " + parts[index].name + " has another size than the first one, which is not read");
  Plan plan{parts[index], selection.window.value_or(own)};
  if (!plan.out.is_sound()) throw failure(name, "the windows are too far apart");
  for (const Window& window : {plan.out, windows->data})
    if (window.pixels() > max_pixels)
      throw failure(name, std::to_string(window.width()) + " x " + std::to_string(window.height()) +
                              " pixels, at most " + std::to_string(max_pixels) + " are allowed");
  return plan;
}

void decode_rows(std::span<const std::uint8_t> bytes, const std::string& name, const Plan& plan,
                 const Selection& selection, const std::function<void(std::span<const Linear>)>& take_row) {
  const std::size_t groups = groups_of(selection);
  const auto decode = [&](const ExrLibrary& library, auto send) {
    try {
      ExrReader reader(library, bytes, plan.part, selection);
      reader.read();
      send_rows(reader, plan, groups, send);
    } catch (const Refusal& refused) {
      throw failure(name, refused.cause);
    }
  };
  if (is_limited_child()) return decode(ExrLibrary(name), take_row);

  // The image, the same again for the library's decompression buffers, and a fixed overhead.
  constexpr std::uint64_t of_the_library = std::uint64_t{64} << 20;
  const Stopwatch clock;
  LimitedChild::Limits limits;
  limits.memory = 2 * groups * sizeof(Linear) * plan.part.data.pixels() + 2 * bytes.size() + of_the_library;
  limits.check_time = [&] {
    check_deadline();
    if (clock.ms() > limits.seconds * 1000) throw failure(name, "takes longer than the limit");
  };
  std::optional<ExrLibrary> library;
  LimitedChild child(
      name + ": EXR", limits,
      [&](ChildAnswer& answer) {
        decode(*library, [&](std::span<const Linear> row) { answer.write(row.data(), row.size_bytes()); });
      },
      [&] { library.emplace(name); });
  std::vector<Linear> row(groups * static_cast<std::size_t>(plan.out.width()));
  for (std::int64_t y = 0; y < plan.out.height(); ++y) {
    child.read(row.data(), row.size() * sizeof(Linear));
    take_row(row);
  }
}

/// The selection of a layer.
Selection selection_of(std::span<const std::uint8_t> bytes, const std::string& name, const ExrChoice& choice,
                       Values values) {
  const std::vector<ExrPart> parts = read_exr_parts(bytes);
  if (parts.empty()) throw failure(name, "the header is wrong");
  const ExrLayer layer = choose_exr_layer(parts, choice.layer, name);
  Selection out{.part = layer.part,
                .names = {layer.channels.begin(), layer.channels.end()},
                .kind = layer.kind,
                .values = values,
                .window = std::nullopt};
  const ExrPart& part = parts[static_cast<std::size_t>(layer.part)];
  if (choice.area == ExrArea::Whole && windows_of(part)) out.window = exr_whole_window(part);
  return out;
}

}  // namespace

void decode_exr_rows(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels,
                     const std::function<void(std::span<const Linear>)>& take_row, const std::string& layer) {
  const Selection selection = selection_of(bytes, name, {.layer = layer}, Values::Finite);
  decode_rows(bytes, name, plan_of(bytes, name, max_pixels, selection), selection, take_row);
}

std::vector<std::string> exr_channel_names(std::span<const std::uint8_t> bytes) {
  std::vector<std::string> names;
  if (const std::optional<ExrPart> part = read_exr_part(bytes))
    for (const ExrPartChannel& channel : part->channels) names.push_back(channel.name);
  return names;
}

namespace {

/// Decodes channels to planes of floats or of their bits.
template <class T>
std::vector<Plane<T>> decode_planes(std::span<const std::uint8_t> bytes, const std::string& name,
                                    std::uint64_t max_pixels, const Selection& selection) {
  const Plan plan = plan_of(bytes, name, max_pixels, selection);
  const auto width = static_cast<std::size_t>(plan.out.width());
  std::vector<Plane<T>> planes(selection.names.size());
  int y = 0;
  decode_rows(bytes, name, plan, selection, [&](std::span<const Linear> row) {
    constexpr float Linear::*slots[] = {&Linear::r, &Linear::g, &Linear::b, &Linear::a};
    for (std::size_t c = 0; c < planes.size(); ++c) {
      if (y == 0) planes[c] = Plane<T>(static_cast<int>(width), static_cast<int>(plan.out.height()));
      std::ranges::transform(row.subspan(c / 4 * width, width), planes[c].row(y).begin(),
                             [slot = slots[c % 4]](const Linear& v) { return std::bit_cast<T>(v.*slot); });
    }
    ++y;
  });
  return planes;
}

LinearImage decode_color(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels,
                         const Selection& selection) {
  const Plan plan = plan_of(bytes, name, max_pixels, selection);
  LinearImage image;  // allocated when the first row arrives, so that a corrupt file takes no memory
  int y = 0;
  decode_rows(bytes, name, plan, selection, [&](std::span<const Linear> row) {
    if (y == 0) image = LinearImage(static_cast<int>(row.size()), static_cast<int>(plan.out.height()));
    std::copy(row.begin(), row.end(), image.row(y++).begin());
  });
  return image;
}

}  // namespace

std::vector<Plane<float>> decode_exr_channels(std::span<const std::uint8_t> bytes, const std::string& name,
                                              std::span<const std::string> channels, std::uint64_t max_pixels) {
  return decode_planes<float>(bytes, name, max_pixels, {.names = {channels.begin(), channels.end()}});
}

std::vector<Plane<std::uint32_t>> decode_exr_bits(std::span<const std::uint8_t> bytes, const std::string& name,
                                                  int part, std::span<const std::string> channels,
                                                  std::uint64_t max_pixels) {
  return decode_planes<std::uint32_t>(
      bytes, name, max_pixels,
      {.part = part, .names = {channels.begin(), channels.end()}, .values = Values::Bits, .window = std::nullopt});
}

std::vector<Plane<std::uint32_t>> decode_exr_stored(std::span<const std::uint8_t> bytes, const std::string& name,
                                                    int part, std::span<const std::string> channels,
                                                    const ExrWindow& window) {
  return decode_planes<std::uint32_t>(
      bytes, name, std::numeric_limits<std::uint64_t>::max(),
      {.part = part, .names = {channels.begin(), channels.end()}, .values = Values::Stored, .window = window});
}

LinearImage decode_exr(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
  return decode_color(bytes, name, max_pixels, selection_of(bytes, name, {}, Values::Finite));
}

LinearImage decode_exr_as_stored(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels,
                                 const ExrChoice& choice) {
  return decode_color(bytes, name, max_pixels, selection_of(bytes, name, choice, Values::Floats));
}

}  // namespace zoneplate
