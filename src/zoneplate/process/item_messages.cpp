// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/process/item_messages.h"

#include <algorithm>
#include <utility>

#include "zoneplate/process/percents.h"

namespace zoneplate {

enum class ItemSender::Kind : std::uint8_t {
  Progress,
  HasRead,
  BeginsToRead,
  File,
  NamedFile,
  Plots,
  Text,
  FilmFrame,
  Environment,
  Result,
  Failure,
  NeedsLibrary
};

struct ItemSender::Header {
  Kind kind;
  std::uint8_t padding[3] = {};
  std::int32_t first, second;
  std::int32_t more_padding = 0;
  std::uint64_t size;
};

namespace {

constexpr double progress_steps = 1000;

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// The bytes of one message; reading beyond its end throws.
class Body {
 public:
  Body(const std::string& place, std::uint64_t size, const ItemEvents::Read& source)
      : place_(place), left_(size), source_(source) {}

  void read(std::span<std::uint8_t> out) {
    if (out.size() > left_) fail("shorter than its parts");
    source_(out);
    left_ -= out.size();
  }
  /// The rest of the message; memory is allocated as data arrive.
  std::vector<std::uint8_t> rest() {
    constexpr std::uint64_t most = std::uint64_t{1} << 30, part = 1 << 20;
    if (left_ > most) fail("too long");
    std::vector<std::uint8_t> bytes;
    while (left_ > 0) {
      const auto before = static_cast<std::ptrdiff_t>(bytes.size());
      bytes.resize(bytes.size() + static_cast<std::size_t>(std::min(left_, part)));
      read({bytes.begin() + before, bytes.end()});
    }
    return bytes;
  }
  std::string text() {
    const std::vector<std::uint8_t> bytes = rest();
    return {bytes.begin(), bytes.end()};
  }
  /// The next bytes as a name.
  std::string name(std::int32_t size) {
    constexpr std::int32_t most = 1 << 16;
    if (size < 0 || size > most) fail("of a file without a name");
    std::string name(static_cast<std::size_t>(size), ' ');
    read({reinterpret_cast<std::uint8_t*>(name.data()), name.size()});
    return name;
  }
  std::uint64_t size_left() const { return left_; }
  void check_end() const {
    if (left_ > 0) fail("longer than its parts");
  }
  [[noreturn]] void fail(const std::string& cause) const {
    throw Error(ErrorKind::Failed, place_ + ": its process sent a message that is " + cause);
  }

 private:
  const std::string& place_;
  std::uint64_t left_;
  const ItemEvents::Read& source_;
};

}  // namespace

/// The name is the first part of the message, whose length is in the header.
void ItemSender::send_named(Kind kind, std::string_view name, std::span<const std::uint8_t> bytes) {
  const Header header{
      .kind = kind, .first = static_cast<std::int32_t>(name.size()), .second = 0, .size = name.size() + bytes.size()};
  const std::lock_guard lock(mutex_);
  write_({reinterpret_cast<const std::uint8_t*>(&header), sizeof header});
  write_(bytes_of(name));
  write_(bytes);
}

void ItemSender::send(Kind kind, int first, int second, std::span<const std::uint8_t> bytes) {
  const Header header{.kind = kind, .first = first, .second = second, .size = bytes.size()};
  const std::lock_guard lock(mutex_);
  const auto* first_byte = reinterpret_cast<const std::uint8_t*>(&header);
  constexpr std::size_t small = 4096;  // one write wakes the receiver once
  if (bytes.size() > small) {
    write_({first_byte, sizeof header});
    return write_(bytes);
  }
  std::vector<std::uint8_t> whole(first_byte, first_byte + sizeof header);
  whole.insert(whole.end(), bytes.begin(), bytes.end());
  write_(whole);
}

void ItemSender::progress(std::string_view stage, double done) {
  if (!sends_progress_) return;
  send(Kind::Progress, static_cast<int>(std::clamp(done, 0.0, 1.0) * progress_steps), 0, bytes_of(stage));
}
std::function<void(double)> ItemSender::progress_of(std::string stage, double from, double to) {
  return percents(from, to, [this, stage = std::move(stage)](double done) { progress(stage, done); });
}
void ItemSender::has_read() {
  is_past_reading_ = true;
  send(Kind::HasRead, 0, 0, {});
}
void ItemSender::begins_to_read(const std::string& input) {
  is_past_reading_ = false, input_ = input;
  send(Kind::BeginsToRead, 0, 0, bytes_of(input));
}
void ItemSender::file(int frame, int layer, std::span<const std::uint8_t> bytes) {
  send(Kind::File, frame, layer, bytes);
}
void ItemSender::named_file(const std::string& name, std::span<const std::uint8_t> bytes) {
  send_named(Kind::NamedFile, name, bytes);
}
void ItemSender::plots(const std::string& name, std::span<const std::uint8_t> bytes) {
  send_named(Kind::Plots, name, bytes);
}
void ItemSender::text(TextKind kind, std::string_view text) {
  send(Kind::Text, static_cast<int>(kind), 0, bytes_of(text));
}
void ItemSender::film_frame(const Rgba8Image& image) {
  const auto* first = reinterpret_cast<const std::uint8_t*>(image.values().data());
  send(Kind::FilmFrame, 0, 0, {first, image.values().size_bytes()});
}
void ItemSender::environment(std::uint64_t key, std::span<const std::uint8_t> bytes) {
  const auto half = [&](int shift) { return static_cast<std::int32_t>(static_cast<std::uint32_t>(key >> shift)); };
  send(Kind::Environment, half(0), half(32), bytes);
}
void ItemSender::result(std::span<const std::uint8_t> bytes) { send(Kind::Result, 0, 0, bytes); }
void ItemSender::failure(ErrorKind kind, const std::string& message, ItemCause cause) {
  send(Kind::Failure, static_cast<int>(kind), static_cast<int>(cause), bytes_of(message));
}
void ItemSender::needs_library(Library library, const std::string& message) {
  send(Kind::NeedsLibrary, static_cast<int>(library), 0, bytes_of(message));
}

std::optional<std::vector<std::uint8_t>> receive_message(const std::string& place, const ItemEvents& events,
                                                         const ItemEvents::Read& source) {
  using Kind = ItemSender::Kind;
  ItemSender::Header header;
  source({reinterpret_cast<std::uint8_t*>(&header), sizeof header});
  Body body(place, header.size, source);
  const ItemEvents::Read read = [&](std::span<std::uint8_t> out) { body.read(out); };
  if (header.kind == Kind::Result) return body.rest();
  if (header.kind == Kind::Failure) {
    const bool is_known = header.first >= 0 && header.first <= static_cast<int>(ErrorKind::Output);
    const bool has_cause = header.second >= 0 && header.second <= static_cast<int>(ItemCause::Killed);
    throw ItemError(is_known ? static_cast<ErrorKind>(header.first) : ErrorKind::Failed, body.text(),
                    has_cause ? static_cast<ItemCause>(header.second) : ItemCause::Other);
  }
  if (header.kind == Kind::Progress) {
    const std::string stage = body.text();
    if (events.progress) events.progress(stage, std::clamp(header.first / progress_steps, 0.0, 1.0));
  } else if (header.kind == Kind::HasRead && events.has_read) {
    events.has_read();
  } else if (header.kind == Kind::BeginsToRead && events.begins_to_read) {
    events.begins_to_read(body.text());
  } else if (header.kind == Kind::File && events.file && header.second >= -1) {
    events.file(header.first, header.second, header.size, read);
  } else if (header.kind == Kind::NamedFile && events.named_file) {
    const std::string name = body.name(header.first);
    events.named_file(name, body.size_left(), read);
  } else if (header.kind == Kind::Plots && events.plots) {
    const std::string name = body.name(header.first);
    events.plots(name, body.size_left(), read);
  } else if (header.kind == Kind::Text && events.text && header.first >= 0 &&
             header.first <= static_cast<int>(TextKind::Warning)) {
    events.text(static_cast<TextKind>(header.first), body.text());
  } else if (header.kind == Kind::FilmFrame && events.film_frame) {
    events.film_frame(header.size, read);
  } else if (header.kind == Kind::Environment && events.environment) {
    const auto half = [](std::int32_t bits) { return std::uint64_t{static_cast<std::uint32_t>(bits)}; };
    events.environment(half(header.first) | half(header.second) << 32, header.size, read);
  } else if (header.kind == Kind::NeedsLibrary && events.needs_library && header.first >= 0 &&
             header.first <= static_cast<int>(Library::Lcms)) {
    events.needs_library(static_cast<Library>(header.first), body.text());
  } else {
    body.fail("not expected here");
  }
  body.check_end();
  return std::nullopt;
}

}  // namespace zoneplate
