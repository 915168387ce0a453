// SPDX-License-Identifier: Apache-2.0
// A fuzz target of libFuzzer: bytes that pretend to be the weights of a network or a table of filters.
//
// They are refused in one line that names the file, or become a network whose outputs are numbers, or a table of
// numbers.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "zoneplate/base/error.h"
#include "zoneplate/network/network.h"
#include "zoneplate/upscale/table/filter_table.h"

namespace zoneplate {
namespace {

constexpr network::NetworkForm form{12, 16};
constexpr upscale::FilterTable::Form table_form{2, 5};

void check_network(std::span<const std::uint8_t> bytes) {
  const network::Network network(bytes, form, "weights");
  network::NetworkFrame frame(5, 4, form.features);
  for (int y = 0; y < 4; ++y)
    for (int i = 0; i < 5 * form.features; ++i)
      frame.features.at(0, y)[i] = static_cast<std::int16_t>((37 * i + y) % 128);
  network.read(frame);
  float out[5 * form.outputs];
  network.write(frame, 0, 2, 5, 0, form.outputs, out);
  if (!std::ranges::all_of(out, [](float v) { return std::isfinite(v); })) std::abort();
}

void check_table(std::span<const std::uint8_t> bytes) {
  const upscale::FilterTable table(bytes, table_form, "weights");
  if (!std::ranges::all_of(table.weights(), [](float v) { return std::isfinite(v); })) std::abort();
}

template <class Check>
void refused_or_checked(const Check& check, std::span<const std::uint8_t> bytes) {
  try {
    check(bytes);
  } catch (const Error& error) {
    const std::string_view message = error.what();
    if (!message.starts_with("weights: ") || message.find('\n') != message.npos) std::abort();
  }
}

}  // namespace
}  // namespace zoneplate

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t max_bytes = 1 << 16;
  if (size > max_bytes) return 0;
  zoneplate::refused_or_checked(zoneplate::check_network, {data, size});
  zoneplate::refused_or_checked(zoneplate::check_table, {data, size});
  return 0;
}
