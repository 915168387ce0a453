// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/exr/exr.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/exr/exr_header.h"
#include "zoneplate/codec/exr/exr_layer.h"
#include "zoneplate/codec/exr/exr_reader.h"
#include "zoneplate/os/limited_child.h"

namespace zoneplate {
namespace {

struct Windows {
  ExrWindow data, display;
};

/// The data and display windows of a part; nothing if the header is wrong.
std::optional<Windows> windows_of(const std::optional<ExrPart>& part) {
  if (!part || !part->data.is_sound() || !part->display.is_sound()) return std::nullopt;
  return Windows{part->data, part->display};
}

std::optional<Windows> find_windows(std::span<const std::uint8_t> bytes) { return windows_of(read_exr_part(bytes)); }

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
  const std::optional<ExrPart> part = read_exr_part(bytes);
  if (!windows_of(part)) return 0;
  return exr_reader_memory({*part, part->display}, {.names = std::vector<std::string>(4)});
}

namespace {

Error failure(const std::string& name, const std::string& cause) {
  return {ErrorKind::Input, name + ": EXR: " + cause};
}

ExrPlan plan_of(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels,
                const ExrSelection& selection) {
  const std::vector<ExrPart> parts = read_exr_parts(bytes);
  const auto index = static_cast<std::size_t>(selection.part);
  const std::optional<Windows> windows = windows_of(index < parts.size() ? std::optional(parts[index]) : std::nullopt);
  if (!windows) throw failure(name, "the header is wrong");
  const ExrWindow &own = windows->display, &first = parts[0].display;
  if (own.width() != first.width() || own.height() != first.height())
    throw failure(name, "part " + parts[index].name + " has another size than the first one, which is not read");
  ExrPlan plan{parts[index], selection.window.value_or(own)};
  if (!plan.out.is_sound()) throw failure(name, "the windows are too far apart");
  for (const ExrWindow& window : {plan.out, windows->data})
    if (window.pixels() > max_pixels)
      throw failure(name, std::to_string(window.width()) + " x " + std::to_string(window.height()) +
                              " pixels, at most " + std::to_string(max_pixels) + " are allowed");
  // The format counts the bytes of a chunk in 32 bits.
  constexpr std::uint64_t max_chunk = std::uint64_t{1} << 31;
  if (const std::uint64_t chunk = exr_chunk_bytes(plan.part); chunk >= max_chunk)
    throw failure(name, "packs " + std::to_string(chunk >> 20) + " MB together, at most 2047 are read");
  return plan;
}

void decode_rows(std::span<const std::uint8_t> bytes, const std::string& name, const ExrPlan& plan,
                 const ExrSelection& selection, const std::function<void(std::span<const Linear>)>& take_row) {
  const auto decode = [&](const ExrLibrary& library, const std::function<void(std::span<const Linear>)>& send) {
    try {
      read_exr_rows(library, bytes, plan, selection, send);
    } catch (const ExrRefusal& refused) {
      throw failure(name, refused.cause);
    }
  };
  if (is_limited_child()) return decode(ExrLibrary(name), take_row);

  constexpr std::uint64_t fixed = std::uint64_t{64} << 20;  // of the library and the process
  const std::size_t row_bytes = selection.groups() * static_cast<std::size_t>(plan.out.width()) * sizeof(Linear);
  const Stopwatch clock;
  LimitedChild::Limits limits;
  limits.memory = exr_reader_memory(plan, selection) + row_bytes + 2 * bytes.size() + fixed;
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
  std::vector<Linear> row(row_bytes / sizeof(Linear));
  for (std::int64_t y = 0; y < plan.out.height(); ++y) {
    child.read(row.data(), row.size() * sizeof(Linear));
    take_row(row);
  }
}

/// The selection of a layer.
ExrSelection selection_of(std::span<const std::uint8_t> bytes, const std::string& name, const ExrChoice& choice,
                          ExrValues values) {
  const std::vector<ExrPart> parts = read_exr_parts(bytes);
  if (parts.empty()) throw failure(name, "the header is wrong");
  const ExrLayer layer = choose_exr_layer(parts, choice.layer, name);
  ExrSelection out{.part = layer.part,
                   .names = {layer.channels.begin(), layer.channels.end()},
                   .kind = layer.kind,
                   .values = values};
  const ExrPart& part = parts[static_cast<std::size_t>(layer.part)];
  if (choice.area == ExrArea::Whole && windows_of(part)) out.window = exr_whole_window(part);
  return out;
}

}  // namespace

void decode_exr_rows(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels,
                     const std::function<void(std::span<const Linear>)>& take_row, const std::string& layer) {
  const ExrSelection selection = selection_of(bytes, name, {.layer = layer}, ExrValues::Finite);
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
                                    std::uint64_t max_pixels, const ExrSelection& selection) {
  const ExrPlan plan = plan_of(bytes, name, max_pixels, selection);
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
                         const ExrSelection& selection) {
  const ExrPlan plan = plan_of(bytes, name, max_pixels, selection);
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
                                                  const std::optional<ExrWindow>& window) {
  constexpr std::uint64_t max_pixels = std::uint64_t{1} << 28;
  return decode_planes<std::uint32_t>(
      bytes, name, max_pixels,
      {.part = part, .names = {channels.begin(), channels.end()}, .values = ExrValues::Bits, .window = window});
}

std::vector<Plane<std::uint32_t>> decode_exr_stored(std::span<const std::uint8_t> bytes, const std::string& name,
                                                    int part, std::span<const std::string> channels,
                                                    const ExrWindow& window) {
  return decode_planes<std::uint32_t>(
      bytes, name, std::numeric_limits<std::uint64_t>::max(),
      {.part = part, .names = {channels.begin(), channels.end()}, .values = ExrValues::Stored, .window = window});
}

std::int64_t exr_band_rows(const ExrPart& part, std::size_t channels) {
  constexpr std::uint64_t max_bytes = std::uint64_t{64} << 20;
  constexpr std::int64_t zip_rows = 16;
  const std::int64_t step = (exr_chunk_rows(part) + zip_rows - 1) / zip_rows * zip_rows;
  const std::uint64_t row_bytes = sizeof(std::uint32_t) * static_cast<std::uint64_t>(part.data.width()) * channels;
  const auto rows = static_cast<std::int64_t>(max_bytes / row_bytes);
  return std::max(step, rows - rows % step);
}

LinearImage decode_exr(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels) {
  return decode_color(bytes, name, max_pixels, selection_of(bytes, name, {}, ExrValues::Finite));
}

LinearImage decode_exr_as_stored(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t max_pixels,
                                 const ExrChoice& choice) {
  return decode_color(bytes, name, max_pixels, selection_of(bytes, name, choice, ExrValues::Floats));
}

}  // namespace zoneplate
