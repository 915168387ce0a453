// SPDX-License-Identifier: Apache-2.0
// A fuzz target of libFuzzer: bytes that pretend to be the answer of a child process that has read a scene.
//
// Whatever they are, they are refused in one line or become a scene that is sound and that is the same when it is
// written and read again.
#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/formats/import/scene_bytes_for_test.h"
#include "zoneplate/scene/validate.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

Scene read(const Bytes& bytes) {
  std::size_t at = 0;
  ImportBudget budget("answer", {.memory = 1 << 24, .pixels = 1 << 20, .seconds = 5});
  const ByteSource source = [&](void* out, std::size_t size) {
    if (size > bytes.size() - at) throw Error(ErrorKind::Input, "answer: ends early");
    std::copy_n(bytes.data() + at, size, static_cast<std::uint8_t*>(out));
    at += size;
  };
  return read_scene(source, budget);
}

void check(const Scene& scene) {
  if (find_invalid(scene)) std::abort();
  for (const Instance& i : scene.instances) static_cast<void>(scene.objects[static_cast<std::size_t>(i.object)].size());
  if (!scene.instances.empty()) static_cast<void>(scene.bounds());
  const Bytes bytes = written(scene);
  if (written(read(bytes)) != bytes) std::abort();
}

}  // namespace
}  // namespace zoneplate

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    zoneplate::check(zoneplate::read({data, data + size}));
  } catch (const zoneplate::Error& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
