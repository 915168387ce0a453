// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/render/method.h"

namespace zoneplate {

std::unique_ptr<Resolver> make_resolver(std::span<const Method> catalogue, std::string_view text) {
  const auto [method, settings] = parse_spec("method", catalogue, text);
  return method.make(settings);
}

}  // namespace zoneplate
