// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "zoneplate/image/rgb.h"

namespace zoneplate {

/// What takes the files and reports of a job while it runs; by default it ignores reports. Files and frames of a film
/// arrive in order, from any thread.
class JobSink {
 public:
  virtual ~JobSink() = default;

  /// Takes a whole file. `frame` is its number in a sequence, or -1; `layer` is its index among the data passes, or -1
  /// for the image.
  virtual void file(int frame, int layer, std::span<const std::uint8_t> bytes) = 0;
  /// Takes a frame of a film that the receiver encodes.
  virtual void film_frame(const Rgba8Image& image) = 0;

  /// `stage` begins when the fraction `done` of the whole work, in [0, 1], is complete.
  virtual void progress(std::string_view, double) {}
  /// A function that takes the progress of a stage which begins at `from` and ends at `to`; any thread may call it.
  virtual std::function<void(double)> progress_of(std::string, double, double) { return {}; }
  /// The next file is read, by this name or that of the job; and reading is complete.
  virtual void begins_to_read(const std::string&) {}
  virtual void has_read() {}
  /// Takes a prepared environment for the cache, by its key (environment_file.h).
  virtual void environment(std::uint64_t, std::span<const std::uint8_t>) {}
};

/// Of a job whose images stay in memory.
class NoFiles final : public JobSink {
  void file(int, int, std::span<const std::uint8_t>) override {}
  void film_frame(const Rgba8Image&) override {}
};

}  // namespace zoneplate
