// SPDX-License-Identifier: Apache-2.0
// A fuzz target of libFuzzer: bytes that pretend to be a scene of shapes, in the text language or as JSON.
//
// They are refused in one line that names line and column, or become a drawing whose distances are numbers.
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "zoneplate/base/error.h"
#include "zoneplate/sdf/evaluate.h"
#include "zoneplate/sdf/language/scene_file.h"

namespace zoneplate {
namespace {

void check(const sdf::SceneFile& scene) {
  constexpr std::size_t max_evaluated = 4096;  // instructions, of each of the first shapes
  sdf::PointBatch points;
  for (int i = 0; i < sdf::batch_size; ++i)
    points.x[i] = static_cast<float>(i % 8) * 7.5f - 20, points.y[i] = static_cast<float>(i / 8) * 9.25f - 30;
  sdf::EvaluationStacks stacks(scene.drawing.program);
  std::size_t evaluated = 0;
  for (const sdf::Drawing::Layer& layer : scene.drawing.layers) {
    evaluated += layer.shape.end - layer.shape.first;
    if (evaluated > max_evaluated) return;
    sdf::CoverageKernels::of(Isa::Scalar).evaluate(scene.drawing.program, layer.shape, points, stacks);
    for (const float d : stacks.values[0].d)
      if (std::isnan(d)) std::abort();
  }
}

}  // namespace
}  // namespace zoneplate

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t max_bytes = 1 << 16;
  if (size > max_bytes) return 0;
  try {
    zoneplate::check(zoneplate::sdf::read_scene_file({reinterpret_cast<const char*>(data), size}, "scene"));
  } catch (const zoneplate::Error& error) {
    const std::string_view message = error.what();
    if (!message.starts_with("scene: line ") || message.find(", column ") == message.npos ||
        message.find('\n') != message.npos)
      std::abort();
  }
  return 0;
}
