// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "zoneplate/formats/gltf/file.h"

namespace zoneplate {

/// Decompresses a buffer view with EXT_meshopt_compression; `packed` are the bytes of the extension's own range.
///
/// Errors    ErrorKind::Input naming the place: a mode, filter or size that the extension does not have, corrupt data,
///           more memory than the budget, or if libmeshoptimizer, which this function opens, is not installed.
/// Source    EXT_meshopt_compression; decoded by meshoptimizer.
std::vector<std::uint8_t> decode_meshopt(const JsonView& extension, std::span<const std::uint8_t> packed,
                                         ImportBudget& budget);

}  // namespace zoneplate
