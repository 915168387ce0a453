// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/base/processors.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>

#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// A fixture with a temporary folder of control groups.
class CpuQuota : public testing::Test {
 protected:
  CpuQuota() {
    std::string name = (fs::temp_directory_path() / "zoneplate_cgroup_XXXXXX").string();
    mount_ = ::mkdtemp(name.data());
  }
  ~CpuQuota() override { fs::remove_all(mount_); }

  void write(const std::string& file, const std::string& text) const {
    fs::create_directories((mount_ / file).parent_path());
    std::ofstream(mount_ / file) << text;
  }
  double quota(const std::string& membership) const { return cpu_quota(membership, mount_.string()); }

 private:
  fs::path mount_;
};

TEST_F(CpuQuota, OfVersionTwoIsTheLeastOnTheWayToTheRoot) {
  EXPECT_EQ(quota("0::/\n"), unlimited);
  write("pods/one/cpu.max", "max 100000\n");
  EXPECT_EQ(quota("0::/pods/one\n"), unlimited);
  write("pods/cpu.max", "250000 100000\n");
  EXPECT_EQ(quota("0::/pods/one\n"), 2.5);
  write("pods/one/cpu.max", "50000 100000\n");
  EXPECT_EQ(quota("0::/pods/one\n"), 0.5);
  EXPECT_EQ(quota("0::/other\n"), unlimited);
  // In a container the mounted folder is the container's own, independently of its group's name outside.
  write("cpu.max", "150000 100000\n");
  EXPECT_EQ(quota("0::/not/visible/here\n"), 1.5);
}

TEST_F(CpuQuota, OfVersionOneIsInTwoFiles) {
  write("cpu/docker/a/cpu.cfs_quota_us", "300000\n");
  write("cpu/docker/a/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(quota("5:memory:/docker/b\n4:cpu,cpuacct:/docker/a\n"), 3);
  EXPECT_EQ(quota("4:cpuacct,cpuset:/docker/a\n"), unlimited);
  write("cpu/docker/a/cpu.cfs_quota_us", "-1\n");
  EXPECT_EQ(quota("4:cpu,cpuacct:/docker/a\n"), unlimited);
}

TEST_F(CpuQuota, BrokenTextIsNoQuota) {
  write("cpu.max", "much\n");
  for (const char* text : {"", "0", "0:", "::", "0::", "4:cpu:", "\n\n"}) EXPECT_EQ(quota(text), unlimited) << text;
}

TEST(Processors, ThreadsAreNoMoreThanTheAffinityMaskAllows) {
  // In a separate process, because the first call caches the number.
  const std::string self = fs::read_symlink("/proc/self/exe").string();
  const int child = ::fork();
  if (child == 0) {
    cpu_set_t all, one;
    CPU_ZERO(&one);
    if (::sched_getaffinity(0, sizeof all, &all) != 0) ::_exit(100);
    for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++i)
      if (CPU_ISSET(i, &all)) CPU_SET(i, &one);
    if (::sched_setaffinity(0, sizeof one, &one) != 0) ::_exit(101);
    ::execl(self.c_str(), self.c_str(), "--gtest_also_run_disabled_tests",
            "--gtest_filter=Processors.DISABLED_OneProcessorIsOneThread", static_cast<char*>(nullptr));
    ::_exit(102);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

// Run by the test above with an affinity mask of one processor.
TEST(Processors, DISABLED_OneProcessorIsOneThread) {
  EXPECT_EQ(usable_processors(), 1);
  EXPECT_EQ(thread_limit(), 1);
  with_threads(0, [] { EXPECT_EQ(thread_limit(), 1); });
  with_threads(3, [] { EXPECT_EQ(thread_limit(), 3); });  // an explicit number is not limited
}

}  // namespace
}  // namespace zoneplate
