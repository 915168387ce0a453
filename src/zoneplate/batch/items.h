// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "zoneplate/base/sha256.h"
#include "zoneplate/batch/item.h"
#include "zoneplate/batch/ledger.h"
#include "zoneplate/job/render_job.h"
#include "zoneplate/process/item_process.h"

namespace zoneplate {

/// The files and folders that the process of an item may read: its model's, environment's and material's, and the
/// cache.
std::vector<std::string> item_readable_paths(const BatchItem& item);

/// Stores the environments that the process of an item, which outlives this, has prepared in the item's cache.
using EnvironmentStorer = decltype(ItemEvents::environment);
EnvironmentStorer environment_storer(const BatchItem& item);

/// Items with one model (`model_key`), which are processed one after the other in a separate process (item_process.h);
/// this class writes their files.
class RenderItems {
 public:
  /// `siblings`: the processes of other items that work at the same time; none if null. `ledger`: where their files are
  /// recorded; nowhere if null.
  /// Requires  at least one item.
  RenderItems(std::vector<BatchItem> items, RunEvents events, LimitedChildren* siblings = nullptr,
              Ledger* ledger = nullptr);

  /// Starts the process, whose results `next` then returns.
  void start_ahead() noexcept { process_.start_ahead(); }
  bool is_working() const { return process_.is_working(); }

  /// Processes the next item.
  ///
  /// Errors    those of reading, rendering and writing it; the following items can still be processed.
  Summary next();

 private:
  void record(const BatchItem& args, const std::string& path, std::uint64_t bytes, Sha256& digest);

  const RunEvents events_;
  Ledger* ledger_;
  std::vector<BatchItem> items_;
  std::size_t next_ = 0;
  ItemProcess process_;
};

}  // namespace zoneplate
