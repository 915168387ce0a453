// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/mapped_file_guard.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/os/file.h"

namespace zoneplate {
namespace {

// In a child process, because the signal handler is global.
TEST(LostBytes, OfAFileThatIsCutOffReadAsZeroAndAreToldOf) {
  const std::string path = testing::TempDir() + "cut-" + std::to_string(::getpid());
  save_bytes(path, std::vector<std::uint8_t>(1 << 16, 7));
  const pid_t child = ::fork();
  if (child == 0) {
    survive_truncated_mappings();
    const MappedFileWatch watch;
    const FileBytes file(path);
    std::filesystem::resize_file(path, 5000);
    const auto bytes = file.bytes();
    const bool has_first = std::count(bytes.begin(), bytes.begin() + 5000, 7) == 5000;
    const bool has_rest = std::all_of(bytes.begin() + 5000, bytes.end(), [](std::uint8_t b) { return b == 0; });
    std::string said;
    try {
      watch.check(path);
    } catch (const Error& error) {
      said = error.what();
    }
    MappedFileWatch().check(path);  // a watch that starts after the loss
    ::_exit(has_first && has_rest && said == path + ": cannot be read: bytes were lost meanwhile" ? 0 : 1);
  }
  int status = -1;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace zoneplate
