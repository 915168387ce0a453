// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/codec/system/in_child.h"

#include <cstdio>
#include <mutex>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/codec/color/icc.h"
#include "zoneplate/os/limited_child.h"

namespace zoneplate {
namespace {

/// Discards what is printed to stderr, while any thread decodes: libjxl reports damage there.
class SilentStderr {
 public:
  SilentStderr() {
    const std::lock_guard guard(lock);
    if (users++ > 0) return;
    usual = stderr, silent = ::fopencookie(nullptr, "w", {.write = discard});
    if (silent != nullptr) stderr = silent;
  }
  ~SilentStderr() {
    const std::lock_guard guard(lock);
    if (--users > 0) return;
    stderr = usual;
    if (silent != nullptr) std::fclose(silent);
  }
  SilentStderr(const SilentStderr&) = delete;
  SilentStderr& operator=(const SilentStderr&) = delete;

 private:
  static ssize_t discard(void*, const char*, std::size_t size) { return static_cast<ssize_t>(size); }

  // As stderr itself, which is one for all threads.
  static inline std::mutex lock;
  static inline int users = 0;
  static inline std::FILE *usual = nullptr, *silent = nullptr;
};

StoredImage decode_silently(const std::function<StoredImage()>& decode) {
  const SilentStderr silent;
  return decode();
}

/// What the child writes before the pixels.
struct Header {
  std::uint64_t kind = 0;  ///< an index of StoredImage::pixels
  std::int32_t width = 0, height = 0, orientation = 1;
  std::uint32_t profile_bytes = 0;
};

void send(const StoredImage& image, ChildAnswer& answer) {
  std::visit(
      [&](const auto& pixels) {
        const Header header{image.pixels.index(), pixels.width(), pixels.height(), image.orientation,
                            static_cast<std::uint32_t>(image.profile.size())};
        answer.write(&header, sizeof header);
        answer.write(image.profile.data(), image.profile.size());
        answer.write(pixels.values().data(), pixels.values().size_bytes());
      },
      image.pixels);
}

template <class Image>
Image receive(const Header& header, LimitedChild& child) {
  Image pixels(header.width, header.height);
  child.read(pixels.values().data(), pixels.values().size_bytes());
  return pixels;
}

}  // namespace

StoredImage decode_in_child(const std::string& place, Library library, std::uint64_t memory, std::uint64_t max_pixels,
                            const std::function<StoredImage()>& decode) {
  if (is_limited_child()) return decode_silently(decode);
  const Stopwatch clock;
  LimitedChild::Limits limits;
  limits.memory = memory;
  limits.check_time = [&] {
    check_deadline();
    if (clock.ms() > limits.seconds * 1000) throw Error(ErrorKind::Input, place + ": takes longer than the limit");
  };
  LimitedChild child(
      place, limits, [&](ChildAnswer& answer) { send(decode_silently(decode), answer); },
      [&] { static_cast<void>(SharedLibrary(library, place)); });
  Header header;
  child.read(&header, sizeof header);
  const bool is_sound =
      header.width > 0 && header.height > 0 && header.kind < 3 && header.profile_bytes <= max_icc_bytes &&
      static_cast<std::uint64_t>(header.width) * static_cast<std::uint64_t>(header.height) <= max_pixels;
  if (!is_sound) throw Error(ErrorKind::Input, place + ": its reader gave a wrong answer");
  StoredImage image{.pixels = {}, .orientation = header.orientation};
  image.profile.resize(header.profile_bytes);
  child.read(image.profile.data(), image.profile.size());
  if (header.kind == 0) image.pixels = receive<Rgba8Image>(header, child);
  if (header.kind == 1) image.pixels = receive<Rgba16Image>(header, child);
  if (header.kind == 2) image.pixels = receive<LinearImage>(header, child);
  return image;
}

}  // namespace zoneplate
