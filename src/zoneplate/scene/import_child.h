#pragma once

#include "zoneplate/base/limited_child.h"
#include "zoneplate/scene/import_budget.h"

namespace zoneplate {

/// What a child process may have that reads for an import. The budget outlives it.
inline LimitedChild::Limits child_limits(const ImportBudget& budget) {
  // Beyond what the budget has left: stacks of threads, and what the libraries set up for themselves.
  constexpr std::uint64_t spare_bytes = std::uint64_t{16} << 20;
  return {.memory = budget.memory_left() + spare_bytes,
          .seconds = budget.limits().seconds,
          .options = "--max-memory, --max-import-seconds",
          .check_time = [&budget] { budget.check_time(); }};
}

}  // namespace zoneplate
