#pragma once

#include <cstdint>
#include <string>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/scene/scene.h"

namespace zoneplate {

/// What is left of the limits of one import. Bytes are taken before they are allocated.
class GltfBudget {
 public:
  GltfBudget(const std::string& file, const LoadLimits& limits) : file_(file), limits_(limits), left_(limits.memory) {}

  const std::string& file() const { return file_; }
  const LoadLimits& limits() const { return limits_; }
  std::uint64_t memory_left() const { return left_; }

  /// Errors    Trouble::Input when fewer than `bytes` are left.
  void take(std::uint64_t bytes) {
    if (bytes > left_)
      throw Error(Trouble::Input,
                  file_ + ": needs more than the limit of " + std::to_string(limits_.memory) + " bytes (--max-memory)");
    left_ -= bytes;
  }
  /// Bytes that were taken and are free again.
  void give_back(std::uint64_t bytes) { left_ += bytes; }

  /// Errors    Trouble::Input when the time is up.
  void check_time() const {
    if (clock_.ms() > limits_.seconds * 1000)
      throw Error(Trouble::Input,
                  file_ + ": takes longer to load than the limit of " + std::to_string(limits_.seconds) + " s");
  }

 private:
  std::string file_;
  LoadLimits limits_;
  std::uint64_t left_;
  Stopwatch clock_;
};

}  // namespace zoneplate
