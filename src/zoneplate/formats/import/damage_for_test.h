// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <string>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/scene/validate.h"

namespace zoneplate {

/// A file in memory, so that thousands of variants can be written in a second.
class MemoryFile {
 public:
  MemoryFile() : number_(memfd_create("model", 0)) {}
  ~MemoryFile() { close(number_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string write(const std::vector<std::uint8_t>& bytes) const {
    EXPECT_EQ(ftruncate(number_, static_cast<off_t>(bytes.size())), 0);
    EXPECT_EQ(pwrite(number_, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
    return "/proc/self/fd/" + std::to_string(number_);
  }

 private:
  int number_;
};

/// Fails the test unless all invariants documented in scene.h, mesh.h and material.h hold.
inline void expect_sound(const Scene& s) { ASSERT_EQ(find_invalid(s).value_or(""), ""); }

/// Loads a file with `load(path, limits)` and validates the scene. Returns the error message, or "" if the file was
/// loaded.
template <class Load>
std::string load_soundly(const Load& load, const std::string& path) {
  try {
    expect_sound(load(path, {.memory = 1 << 24, .pixels = 1 << 20, .seconds = 5}));
    return "";
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::Input);
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    return e.what();
  }
}

}  // namespace zoneplate
