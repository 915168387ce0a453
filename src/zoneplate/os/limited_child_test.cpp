// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/limited_child.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <vector>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate {
namespace {

/// The parent's error message for a child with this work.
std::string complaint_about(const std::function<void(ChildAnswer&)>& work, const LimitedChild::Limits& limits = {},
                            const std::function<void()>& open = {}) {
  try {
    LimitedChild child("model.xyz", limits, work, open);
    std::uint8_t byte = 0;
    child.read(&byte, 1);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

void answer_one(ChildAnswer& answer) {
  const std::uint8_t byte = 1;
  answer.write(&byte, 1);
}

TEST(LimitedChild, AnswersFromManyThreads) {
  std::vector<std::uint32_t> expected(1 << 20);
  std::iota(expected.begin(), expected.end(), 7u);
  with_threads(3, [&] {
    LimitedChild child("model.xyz", {}, [](ChildAnswer& answer) {
      std::vector<std::uint32_t> values(1 << 20);
      parallel_ranges(values.size(), 1000, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) values[i] = static_cast<std::uint32_t>(i + 7);
      });
      answer.write(values.data(), values.size() * 4);
    });
    std::vector<std::uint32_t> values(1 << 20);
    child.read(values.data(), values.size() * 4);
    EXPECT_EQ(values, expected);
  });
}

TEST(LimitedChild, PassesErrorsOn) {
  try {
    LimitedChild child("model.xyz", {}, [](ChildAnswer&) { throw Error(ErrorKind::Usage, "two\nlines"); });
    std::uint8_t byte = 0;
    child.read(&byte, 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Usage);
    EXPECT_STREQ(error.what(), "two lines");
  }
}

TEST(LimitedChild, MayBeLost) {
  EXPECT_EQ(complaint_about(answer_one), "");
  EXPECT_EQ(complaint_about([](ChildAnswer&) { std::abort(); }), "model.xyz: its reader crashed (signal 6)");
  EXPECT_EQ(complaint_about([](ChildAnswer&) { ::_exit(3); }), "model.xyz: its reader gave no answer");
  EXPECT_NE(complaint_about([](ChildAnswer&) { ::pause(); }).find("model.xyz: its reader made a system call"),
            std::string::npos);
  const auto loop = [](ChildAnswer&) {
    for (std::atomic<int> i = 0;; ++i) continue;
  };
  EXPECT_EQ(complaint_about(loop, {.seconds = 0}), "model.xyz: its reader ran out of time or memory");
  const Stopwatch clock;
  const auto be_patient = [&] {
    if (clock.ms() > 200) throw Error(ErrorKind::Input, "that is enough");
  };
  EXPECT_EQ(complaint_about(loop, {.check_time = be_patient}), "that is enough");
}

TEST(LimitedChild, HasSoMuchMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer's allocator ends the process by itself";
#endif
  const auto eat = [](ChildAnswer& answer) {
    std::vector<std::vector<char>> eaten;
    for (int i = 0; i < 64; ++i) eaten.emplace_back(std::size_t{32} << 20, 'x');
    answer_one(answer);
  };
  EXPECT_EQ(complaint_about(eat, {.memory = 1 << 20, .options = "--more"}),
            "model.xyz: needs more memory than the limit (--more)");
}

TEST(LimitedChild, OpensBeforeItsRightsAreTaken) {
  int file = -1;
  const auto open = [&] { file = ::open("/dev/null", O_WRONLY); };
  const auto write = [&](ChildAnswer& answer) {
    if (::write(file, "x", 1) != 1 || !is_limited_child()) std::abort();
    answer_one(answer);
  };
  EXPECT_EQ(complaint_about(write, {}, open), "");
  EXPECT_EQ(complaint_about(answer_one, {}, [] { throw Error(ErrorKind::Failed, "no library"); }), "no library");
  EXPECT_FALSE(is_limited_child());
}

TEST(LimitedChild, ALateOneIsNotWaitedFor) {
  const Stopwatch watch;
  {
    LimitedChild child("model.xyz", {}, [](ChildAnswer&) {
      for (std::atomic<int> i = 0;; ++i) continue;
    });
  }
  EXPECT_LT(watch.ms(), 5000);
}

TEST(LimitedChild, IsEndedByWhatNoReaderNeeds) {
  const std::string file = testing::TempDir() + "zoneplate_sandbox_" + std::to_string(::getpid());
  const pid_t parent = ::getpid();
  const std::vector<std::pair<const char*, std::function<void()>>> deeds = {
      {"a file to write", [&] { ::open(file.c_str(), O_WRONLY | O_CREAT, 0600); }},
      {"a file to read and write", [&] { ::open("/dev/null", O_RDWR); }},
      {"a file to remove", [&] { ::unlink(file.c_str()); }},
      {"a network", [] { ::socket(AF_INET, SOCK_STREAM, 0); }},
      {"a process", [] { static_cast<void>(::fork()); }},
      {"a program", [] { ::execl("/bin/true", "true", nullptr); }},
      {"a signal to the parent", [&] { ::kill(parent, 0); }},
      {"a signal to a thread of the parent", [&] { ::syscall(SYS_tgkill, parent, parent, 0); }},
      {"code", [] { ::mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0); }},
      {"memory of others", [] { ::mmap(nullptr, 4096, PROT_READ, MAP_SHARED | MAP_ANONYMOUS, -1, 0); }}};
  for (const auto& [name, deed] : deeds) {
    const auto work = [&, act = deed](ChildAnswer& answer) { act(), answer_one(answer); };
    EXPECT_EQ(complaint_about(work), "model.xyz: its reader made a system call that it has no right to, and was ended")
        << name;
  }
  EXPECT_NE(::access(file.c_str(), F_OK), 0);
  const auto read = [](ChildAnswer& answer) {
    if (::open("/dev/null", O_RDONLY) < 0) std::abort();
    answer_one(answer);
  };
  EXPECT_EQ(complaint_about(read), "");
}

/// The first child answers after the second has ended, which writes more than a pipe holds.
TEST(LimitedChildren, WorkWhileTheParentReadsOneOfThem) {
  constexpr std::size_t size = 5'000'000;
  int ended = 0, second_has_ended[2];  // a pipe that the parent closes
  ASSERT_EQ(::pipe(second_has_ended), 0);
  LimitedChildren children([&] {
    ++ended;
    ::close(second_has_ended[1]);
  });
  const Stopwatch watch;
  LimitedChild::Limits limits{.check_time =
                                  [&] {
                                    if (watch.ms() > 20000) throw Error(ErrorKind::Failed, "they wait for each other");
                                  },
                              .is_sandboxed = false,
                              .siblings = &children};
  const auto answer_bytes = [](ChildAnswer& answer, std::uint8_t value) {
    const std::vector<std::uint8_t> bytes(size, value);
    answer.write(bytes.data(), bytes.size());
  };
  LimitedChild first("first", limits, [&](ChildAnswer& answer) {
    ::close(second_has_ended[1]);
    std::uint8_t byte = 0;
    if (::read(second_has_ended[0], &byte, 1) != 0) std::abort();
    answer_bytes(answer, 1);
  });
  LimitedChild second("second", limits, [&](ChildAnswer& answer) { answer_bytes(answer, 2); });
  std::vector<std::uint8_t> bytes(size);
  first.read(bytes.data(), bytes.size());
  EXPECT_EQ(bytes, std::vector<std::uint8_t>(size, 1));
  EXPECT_EQ(ended, 1);
  EXPECT_TRUE(second.has_ended());
  second.read(bytes.data(), 100);
  second.read(bytes.data() + 100, bytes.size() - 100);
  EXPECT_EQ(bytes, std::vector<std::uint8_t>(size, 2));
  EXPECT_THROW(second.read(bytes.data(), 1), Error);
  ::close(second_has_ended[0]);
}

// `ulimit -t` of the session ends a child that has no limit of processor time of its own.
TEST(LimitedChild, ALimitOfProcessorTimeOfTheSessionIsNamed) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_CPU, &before), 0);
  rlimit limit = before;
  limit.rlim_cur = std::min<rlim_t>(100'000, before.rlim_max);  // seconds
  ASSERT_EQ(::setrlimit(RLIMIT_CPU, &limit), 0);
  const std::string message =
      complaint_about([](ChildAnswer&) { std::raise(SIGKILL); },
                      {.seconds = std::numeric_limits<double>::infinity(), .options = "--more", .is_sandboxed = false});
  ::setrlimit(RLIMIT_CPU, &before);
  EXPECT_EQ(message, "model.xyz: its reader ran out of processor time or memory (ulimit -t)");
}

}  // namespace
}  // namespace zoneplate
