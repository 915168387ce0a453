// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/formats/import/import_budget.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/mapped_file_guard.h"
#include "zoneplate/scene/stream/triangle_stream.h"

namespace zoneplate {

/// The triangles of a mapped file, whose pages the system may reclaim.
class FileStream : public TriangleStream {
 public:
  FileStream(const std::string& path, const LoadLimits& limits)
      : path_(path), limits_(limits), file_(FileBytes::reclaimable(path)) {}

  /// The least memory, in bytes, that load_scene takes for the file, and the renderer for its vertices.
  virtual std::uint64_t bytes_in_memory() const = 0;
  static constexpr std::uint64_t max_in_bins = 128;  ///< bytes of a small triangle's samples
  /// The same with what the renderer may take for the samples of small triangles.
  std::uint64_t bytes_to_draw() const { return bytes_in_memory() + max_in_bins * count(); }

  /// The memory, in bytes, that `mesh` and the renderer take for a visible triangle: its vertices, those of the
  /// triangles around it of which its normals are made, and what the renderer derives from them.
  virtual std::uint64_t visible_bytes() const { return 500; }

  /// Errors    ErrorKind::Input naming what the file has that cannot be read in parts.
  virtual void check() const {}

  /// Errors    ErrorKind::Input if the file has lost bytes since it was opened.
  void check_whole() const { watch_.check(path_); }

  void forget() const override { file_.forget(file_.bytes().data(), file_.bytes().size()); }

 protected:
  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(ErrorKind::Input, path_ + ": " + what + ", and needs more memory than --max-memory allows");
  }
  [[noreturn]] void throw_changed() const { throw Error(ErrorKind::Input, path_ + ": was changed while it was read"); }
  const FileBytes& file() const { return file_; }
  const std::string& path() const { return path_; }
  /// Calls body(i) for every i below `count`, in ascending steps after which the system may reclaim what was read.
  template <class Body>
  void in_steps(std::size_t count, const Body& body) const {
    constexpr std::size_t step = 1 << 14, grain = 1 << 11;
    for (std::size_t first = 0; first < count; first += step) {
      parallel_ranges(std::min(step, count - first), grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = first + begin; i < first + end; ++i) body(i);
      });
      forget();
    }
  }
  /// The limits of one access: the time of an import does not limit that of drawing.
  ImportBudget budget() const { return {path_, limits_}; }

 private:
  std::string path_;
  LoadLimits limits_;
  MappedFileWatch watch_;
  FileBytes file_;
};

}  // namespace zoneplate
