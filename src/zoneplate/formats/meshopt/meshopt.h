// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/formats/json/json.h"

namespace zoneplate {

/// The bytes of a buffer view that KHR_meshopt_compression or EXT_meshopt_compression packs; `packed` are those of the
/// extension's own range.
///
/// Errors    ErrorKind::Input naming the place: a mode, filter or size that the extension does not have, corrupt data,
///           more memory than the budget.
///           Also where libmeshoptimizer, which this opens, is not installed.
/// Source    EXT_meshopt_compression, decoded by meshoptimizer; KHR_meshopt_compression.
std::vector<std::uint8_t> decode_meshopt(const JsonView& extension, std::span<const std::uint8_t> packed,
                                         ImportBudget& budget);

}  // namespace zoneplate
