// SPDX-License-Identifier: Apache-2.0
// A fuzz target of libFuzzer: bytes that pretend to be the messages of an item's process, and the results in them.
#include <algorithm>
#include <cstdlib>

#include "zoneplate/process/item_messages.h"
#include "zoneplate/process/packed_summary.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace zoneplate;
  std::span<const std::uint8_t> left(data, size);
  const auto source = [&](std::span<std::uint8_t> out) {
    if (out.size() > left.size()) throw Error(ErrorKind::Input, "the pipe ends here");
    std::copy_n(left.begin(), out.size(), out.begin());
    left = left.subspan(out.size());
  };
  ItemEvents events;
  const auto take_all = [](std::uint64_t bytes, const ItemEvents::Read& read) {
    std::uint8_t part[64];
    for (; bytes > 0; bytes -= std::min<std::uint64_t>(bytes, sizeof part))
      read({part, static_cast<std::size_t>(std::min<std::uint64_t>(bytes, sizeof part))});
  };
  events.progress = [](std::string_view, double done) {
    if (!(done >= 0 && done <= 1)) std::abort();
  };
  events.file = [&](int, int layer, std::uint64_t bytes, const ItemEvents::Read& read) {
    if (layer < -1) std::abort();
    take_all(bytes, read);
  };
  events.named_file = [&](const std::string&, std::uint64_t bytes, const ItemEvents::Read& read) {
    take_all(bytes, read);
  };
  events.text = [](TextKind kind, const std::string&) {
    if (kind > TextKind::Warning) std::abort();
  };
  events.begins_to_read = [](const std::string&) {};
  events.film_frame = take_all;
  events.environment = [&](std::uint64_t, std::uint64_t bytes, const ItemEvents::Read& read) { take_all(bytes, read); };
  events.has_read = [] {};
  events.needs_library = [](Library library, const std::string&) {
    if (library > Library::Lcms) std::abort();
  };
  try {
    for (;;)
      if (const auto result = receive_message("item", events, source)) unpack_summary(*result);
  } catch (const Error&) {
  }
  return 0;
}
