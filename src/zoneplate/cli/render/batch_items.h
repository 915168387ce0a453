// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "zoneplate/batch/ledger.h"
#include "zoneplate/batch/manifest.h"
#include "zoneplate/cli/render/args.h"

namespace zoneplate::cli {

/// The items of a batch: the inputs of the command line, or the jobs of its manifest.
class BatchItems {
 public:
  /// Errors    those of Manifest.
  explicit BatchItems(RenderArgs common);
  ~BatchItems();

  std::uint64_t count() const { return manifest_ ? manifest_->size() : inputs_.size(); }
  std::string name(std::uint64_t i) const { return manifest_ ? manifest_->place(i) : inputs_[i]; }
  /// The arguments of an item, complete and checked.
  ///
  /// Errors    ErrorKind::Input or Usage, naming the line.
  RenderArgs args(std::uint64_t i);

  /// What a ledger of these items pins.
  BatchPin pin() const;

 private:
  class Jobs;

  const std::vector<std::string> inputs_;
  const RenderArgs common_;  ///< without the inputs
  std::unique_ptr<Jobs> jobs_;
  std::optional<Manifest> manifest_;
};

}  // namespace zoneplate::cli
