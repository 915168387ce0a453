// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/os/file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <thread>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/os/memory_limit.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes made(std::size_t count) {
  Bytes bytes(count);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{3});
  return bytes;
}

Bytes loaded(const std::string& path) {
  const FileBytes file(path);
  return {file.bytes().begin(), file.bytes().end()};
}

template <class Body>
std::string error_of(ErrorKind kind, Body body) {
  try {
    body();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind);
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

/// A fixture with an empty temporary directory.
class File : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (std::filesystem::temp_directory_path() / "zoneplate-file-XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) all.push_back(entry.path().filename());
    std::sort(all.begin(), all.end());
    return all;
  }

  std::filesystem::path folder_;
};

/// Runs `body` in a child process and returns its exit code.
template <class Body>
int exit_code_in_child(Body body) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(body());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + status;
}

TEST_F(File, HoldsWhatWasSaved) {
  for (const std::size_t count : {0u, 1u, 4096u, 100001u}) {
    save_bytes(path("a.bin"), made(count));
    EXPECT_EQ(loaded(path("a.bin")), made(count));
  }
  EXPECT_EQ(names(), std::vector<std::string>{"a.bin"});
}

TEST_F(File, HasTheSameBytesAfterItForgotThem) {
  save_bytes(path("a.bin"), made(100001));
  const FileBytes file(path("a.bin"));
  file.forget(file.bytes().data(), file.bytes().size());
  file.forget(file.bytes().data() + 5000, 20000);
  file.forget(file.bytes().data(), 10);
  EXPECT_EQ(Bytes(file.bytes().begin(), file.bytes().end()), made(100001));
}

TEST_F(File, ReclaimablePagesAreNoMemoryOfTheProcess) {
#if defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer takes memory of its own";
#endif
  save_bytes(path("a.bin"), made(1 << 24));
  const auto size_under_limit = [&](auto open) {
    const pid_t child = ::fork();
    if (child == 0) {
      limit_memory(1 << 22);
      try {
        const FileBytes file = open(path("a.bin"));
        ::_exit(std::accumulate(file.bytes().begin(), file.bytes().end(), 0u) > 0 ? 0 : 2);
      } catch (...) {
        ::_exit(1);
      }
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WEXITSTATUS(status);
  };
  EXPECT_EQ(size_under_limit([](const std::string& name) { return FileBytes::reclaimable(name); }), 0);
  EXPECT_EQ(size_under_limit([](const std::string& name) { return FileBytes(name); }), 1);
  const FileBytes file = FileBytes::reclaimable(path("a.bin"));
  file.read_ahead(file.bytes().data(), 1 << 20);
  file.forget(file.bytes().data(), file.bytes().size());
  EXPECT_EQ(Bytes(file.bytes().begin(), file.bytes().end()), made(1 << 24));
  error_of(ErrorKind::Input, [&] { FileBytes::reclaimable(path("missing")); });
  save_bytes(path("empty"), {});
  error_of(ErrorKind::Input, [&] { FileBytes::reclaimable(path("empty")); });
}

TEST_F(File, MovesWithItsBytes) {
  save_bytes(path("a"), made(10));
  FileBytes first(path("a"));
  FileBytes second(std::move(first));
  EXPECT_TRUE(first.bytes().empty());
  save_bytes(path("b"), made(20));
  second = FileBytes(path("b"));
  EXPECT_EQ(second.bytes().size(), 20u);
}

TEST_F(File, ReadsWhatCannotBeMapped) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  const Bytes bytes = made(300000);
  std::thread writer([&] {
    save_bytes("/dev/fd/" + std::to_string(ends[1]), bytes);
    ::close(ends[1]);
  });
  Bytes found;
  EXPECT_NO_THROW(found = loaded("/dev/fd/" + std::to_string(ends[0])));  // as a shell's process substitution
  writer.join();
  ::close(ends[0]);
  EXPECT_EQ(found, bytes);
  EXPECT_FALSE(loaded("/proc/self/status").empty());
}

TEST_F(File, RefusesWhatIsNoFileAtOnce) {
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  std::filesystem::create_symlink("pipe", path("link"));
  const auto refusal = [](const std::string& name) -> std::string {
    try {
      FileBytes file(name);
      return "";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Input);
      return error.what();
    }
  };
  EXPECT_EQ(refusal(path("pipe")), path("pipe") + ": is a FIFO, not a file");
  EXPECT_EQ(refusal(path("link")), path("link") + ": is a FIFO, not a file");
  EXPECT_EQ(refusal("/dev/zero"), "/dev/zero: is a device, not a file");
  EXPECT_EQ(refusal(folder_.string()), folder_.string() + ": is a directory, not a file");
}

TEST_F(File, ReadsStandardInput) {
  save_bytes(path("a"), made(70000));
  EXPECT_EQ(exit_code_in_child([&] {
              ::dup2(::open(path("a").c_str(), O_RDONLY), STDIN_FILENO);
              return loaded("-") == made(70000) ? 0 : 1;
            }),
            0);
}

TEST_F(File, SaysWhyItCannotBeRead) {
  EXPECT_EQ(error_of(ErrorKind::Input, [&] { FileBytes(path("none")); }),
            path("none") + ": cannot be read: No such file or directory");
  EXPECT_EQ(error_of(ErrorKind::Input, [&] { FileBytes(folder_.string()); }),
            folder_.string() + ": is a directory, not a file");
  save_bytes(path("a"), made(101));
  EXPECT_EQ(FileBytes(path("a"), 101).bytes().size(), 101u);
  EXPECT_EQ(error_of(ErrorKind::Input, [&] { FileBytes(path("a"), 100); }),
            path("a") + ": cannot be read: larger than the limit of 100 bytes");
  EXPECT_NE(error_of(ErrorKind::Input, [&] { FileBytes("/proc/self/maps", 1); }).find("larger"), std::string::npos);
}

TEST_F(File, APointerOfGitLfsIsNotTheFile) {
  const std::string text = "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a2146 (and more)\nsize 12345\n";
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  save_bytes(path("a.glb"), bytes);
  const std::string refusal =
      path("a.glb") + ": is a pointer of Git LFS to a file that is not fetched: see `git lfs pull`";
  EXPECT_EQ(error_of(ErrorKind::Input, [&] { FileBytes(path("a.glb")); }), refusal);
  EXPECT_EQ(error_of(ErrorKind::Input, [&] { read_parts(path("a.glb"), [](auto) { return true; }); }), refusal);
  save_bytes(path("begin"), bytes.first(30));
  EXPECT_EQ(loaded(path("begin")), std::vector<std::uint8_t>(bytes.begin(), bytes.begin() + 30));
}

TEST_F(File, SaysWhyItCannotBeWritten) {
  EXPECT_EQ(error_of(ErrorKind::Output, [&] { save_bytes(path("none/a.png"), made(1)); }),
            path("none/a.png") + ": cannot be written: no directory " + path("none"));
  EXPECT_EQ(error_of(ErrorKind::Output, [&] { save_bytes(folder_.string(), made(1)); }),
            folder_.string() + ": cannot be written: it is a directory");
  EXPECT_EQ(error_of(ErrorKind::Output, [&] { save_bytes(path("b/"), made(1)); }),
            path("b/") + ": cannot be written: it names a directory");
  EXPECT_EQ(error_of(ErrorKind::Output, [&] { save_bytes("", made(1)); }), ": cannot be written: not a file name");
  save_bytes(path("a"), made(1));
  EXPECT_EQ(error_of(ErrorKind::Output, [&] { save_bytes(path("a/b"), made(1)); }),
            path("a/b") + ": cannot be written: Not a directory");
  EXPECT_EQ(error_of(ErrorKind::Output, [&] { save_bytes(path(std::string(300, 'x')), made(1)); }),
            path(std::string(300, 'x')) + ": cannot be written: File name too long");
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
  save_bytes(path(std::string(255, 'x')), made(1));
}

TEST_F(File, IsNotReplacedWithoutPermission) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everything";
  save_bytes(path("a"), made(5));
  ::chmod(path("a").c_str(), 0400);
  error_of(ErrorKind::Output, [&] { save_bytes(path("a"), made(1)); });
  EXPECT_EQ(loaded(path("a")), made(5));
}

TEST_F(File, KeepsPermissionsAndFollowsLinks) {
  save_bytes(path("a"), made(5));
  ::chmod(path("a").c_str(), 0640);
  std::filesystem::create_directory(folder_ / "sub");
  std::filesystem::create_symlink("../a", folder_ / "sub" / "link");
  std::filesystem::create_symlink("sub/link", folder_ / "far");
  save_bytes(path("far"), made(9));
  EXPECT_EQ(loaded(path("a")), made(9));
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "far"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder_ / "sub" / "link"));
  struct stat status {};
  ASSERT_EQ(::stat(path("a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, mode_t{0640});

  std::filesystem::create_symlink("later", folder_ / "early");
  save_bytes(path("early"), made(2));
  EXPECT_EQ(loaded(path("later")), made(2));
  std::filesystem::create_symlink("circle", folder_ / "circle");
  error_of(ErrorKind::Output, [&] { save_bytes(path("circle"), made(2)); });
}

TEST_F(File, WritesIntoDevices) {
  save_bytes("/dev/null", made(100));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  EXPECT_EQ(error_of(ErrorKind::Output, [] { save_bytes("/dev/full", made(100)); }),
            "/dev/full: cannot be written: No space left on device");
}

TEST_F(File, WritesStandardOutput) {
  for (const std::string name : {"-", "/dev/stdout", "/dev/fd/1"}) {
    EXPECT_EQ(exit_code_in_child([&] {
                ::dup2(::open(path("out").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
                save_bytes(name, made(70000));
                return 0;
              }),
              0);
    EXPECT_EQ(loaded(path("out")), made(70000)) << name;
  }
  EXPECT_EQ(names(), std::vector<std::string>{"out"});
}

TEST_F(File, ReportsAClosedPipe) {
  EXPECT_EQ(exit_code_in_child([&] {
              int ends[2];
              if (::pipe(ends) != 0) return 1;
              ::dup2(ends[1], STDOUT_FILENO);
              ::close(ends[0]);
              try {
                save_bytes("-", made(1000));
              } catch (const Error& error) {
                return error.kind() == ErrorKind::Output &&
                               error.what() == std::string("standard output: cannot be written: Broken pipe")
                           ? 0
                           : 2;
              }
              return 3;
            }),
            0);
}

/// Limits the size of files that this process writes, to simulate a full disk.
void limit_file_size(rlim_t bytes) {
  const rlimit limit{bytes, bytes};
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

TEST_F(File, LeavesNothingBehindWhenTheDiskIsFull) {
  save_bytes(path("a"), made(5));
  EXPECT_EQ(exit_code_in_child([&] {
              ::signal(SIGXFSZ, SIG_IGN);
              limit_file_size(10000);
              try {
                save_bytes(path("a"), made(50000));
              } catch (const Error& error) {
                return error.kind() == ErrorKind::Output ? 0 : 1;
              }
              return 2;
            }),
            0);
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
  EXPECT_EQ(loaded(path("a")), made(5));
}

/// Refuses files without names to this process, as NFS does.
void refuse_unnamed_files() {
  constexpr __u32 unnamed = O_TMPFILE & ~O_DIRECTORY;
  sock_filter filter[] = {BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
                          BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_openat, 0, 3),
                          BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, args[2])),
                          BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, unnamed, 0, 1),
                          BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EOPNOTSUPP),
                          BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)};
  const sock_fprog program{std::size(filter), filter};
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}

// In one child that has a hidden name for its files, and one that has none.
TEST_F(File, LeavesNothingBehindWhenTheProcessIsKilled) {
  std::ofstream(path("a")) << "old";
  const int probe = ::open(folder_.c_str(), O_RDWR | O_TMPFILE, 0600);
  if (probe < 0) GTEST_SKIP() << "the file system has no files without names";
  ::close(probe);
  for (const bool is_refused : {false, true}) {
    const pid_t child = ::fork();
    if (child == 0) {
      if (is_refused) refuse_unnamed_files();
      FileWriter replaced(path("a")), made_anew(path("b"));
      replaced.write(made(50000)), made_anew.write(made(50000));
      ::raise(SIGKILL);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    EXPECT_EQ(WTERMSIG(status), SIGKILL);
    EXPECT_EQ(names().size(), is_refused ? 3u : 1u);
    EXPECT_EQ(std::ranges::count(names(), "a"), 1);
  }
}

TEST_F(File, IsTheSameWhereItCannotBeWithoutAName) {
  std::ofstream(path("b")) << "old";
  EXPECT_EQ(exit_code_in_child([&] {
              refuse_unnamed_files();
              save_bytes(path("a"), made(50000)), save_bytes(path("b"), made(70000));
              return 0;
            }),
            0);
  EXPECT_EQ(names(), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(loaded(path("a")), made(50000));
  EXPECT_EQ(loaded(path("b")), made(70000));
}

TEST_F(File, LeavesNothingBehindWhenASignalEndsTheProcess) {
  EXPECT_EQ(exit_code_in_child([&] {
              refuse_unnamed_files();
              // The signal arrives during writing, while the temporary file exists.
              ::signal(SIGXFSZ, [](int) {
                remove_temporaries();
                ::_exit(7);
              });
              limit_file_size(10000);
              save_bytes(path("a"), made(50000));
              return 0;
            }),
            7);
  EXPECT_EQ(names(), std::vector<std::string>{});
}

TEST_F(File, WritersOfOneNameDoNotMix) {
  std::vector<std::thread> writers;
  for (std::size_t i = 1; i <= 12; ++i) {
    writers.emplace_back([&, i] { save_bytes(path("a"), made(i * 10000)); });
  }
  for (std::thread& writer : writers) writer.join();
  const Bytes bytes = loaded(path("a"));
  EXPECT_EQ(bytes.size() % 10000, 0u);
  EXPECT_EQ(bytes, made(bytes.size()));
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

}  // namespace
}  // namespace zoneplate
