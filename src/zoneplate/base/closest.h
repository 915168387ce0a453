// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace zoneplate {

/// The name nearest to `word` by edit distance, for "did you mean"; empty if none is near. A name is near if at most 2
/// letters or a third of the word differ, and not all of them.
std::string_view closest(std::string_view word, std::span<const std::string_view> names);

}  // namespace zoneplate
