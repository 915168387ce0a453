// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "zoneplate/cli/render/item_process.h"
#include "zoneplate/cli/render/job.h"

namespace zoneplate::cli {

/// Items with one model (`model_key`), done one after the other in a process of their own (item_process.h); their files
/// are written here.
class RenderItems {
 public:
  /// Requires  at least one item.
  explicit RenderItems(std::vector<RenderArgs> items);

  /// Does the next item.
  ///
  /// Errors    of reading, rendering and writing it; the item after it can be done all the same.
  Summary next();

 private:
  std::vector<RenderArgs> items_;
  std::size_t next_ = 0;
  ItemProcess process_;
};

}  // namespace zoneplate::cli
