#pragma once

#include "zoneplate/base/limited_child.h"
#include "zoneplate/scene/import_budget.h"

namespace zoneplate {

/// What a child process may have that reads for an import. The budget outlives it.
inline LimitedChild::Limits child_limits(const ImportBudget& budget) {
  // Beyond the limit of decoded data: what readers need on the way, and the stacks of threads.
  constexpr std::uint64_t spare_bytes = std::uint64_t{512} << 20;
  return {.memory = 2 * budget.memory_left() + spare_bytes,
          .seconds = budget.limits().seconds,
          .options = "--max-memory, --max-import-seconds",
          .check_time = [&budget] { budget.check_time(); }};
}

}  // namespace zoneplate
