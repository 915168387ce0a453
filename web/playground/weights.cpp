// SPDX-License-Identifier: Apache-2.0
// The weights of networks and tables, in files that the page fetches when a method needs them: the module is smaller
// without them.
#include <emscripten.h>

#include <array>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/network/trained.h"

namespace zoneplate::network {
namespace {

/// In the order of Trained.
constexpr const char* names[] = {"learned",       "learned_filters", "learned_smaa",
                                 "learned_still", "learned_table",   "learned_table_still"};

std::vector<std::uint8_t> bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(ErrorKind::Failed, path + " is missing");
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

std::span<const std::uint8_t> trained_weights(Trained file) {
  static const auto read = [] {
    std::array<std::vector<std::uint8_t>, std::size(names)> out;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = bytes_of(std::string("/weights/") + names[i] + ".bin");
    return out;
  }();
  return read[static_cast<std::size_t>(file)];
}

}  // namespace zoneplate::network

/// The names of the files, as a list of JSON.
extern "C" EMSCRIPTEN_KEEPALIVE const char* list_weights() {
  static const std::string list = [] {
    std::string out;
    for (const char* const name : zoneplate::network::names)
      out += (out.empty() ? "[\"" : ",\"") + std::string(name) + '"';
    return out + ']';
  }();
  return list.c_str();
}
