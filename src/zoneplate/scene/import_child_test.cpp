#include "zoneplate/scene/import_child.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <numeric>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/scene/damage_for_test.h"
#include "zoneplate/scene/load.h"
#include "zoneplate/scene/mesh_samples_for_test.h"
#include "zoneplate/scene/scene_bytes.h"

namespace zoneplate {
namespace {

/// What the parent says of a child that does this.
std::string complaint_about(const std::function<void(ImportAnswer&)>& work, const LoadLimits& limits = {}) {
  ImportBudget budget("model.xyz", limits);
  try {
    ImportChild child("model.xyz", budget, work);
    std::uint8_t byte = 0;
    child.read(&byte, 1);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

void answer_one(ImportAnswer& answer) {
  const std::uint8_t byte = 1;
  answer.write(&byte, 1);
}

TEST(ImportChild, AnswersFromManyThreads) {
  std::vector<std::uint32_t> wanted(1 << 20);
  std::iota(wanted.begin(), wanted.end(), 7u);
  ImportBudget budget("model.xyz", {});
  with_threads(3, [&] {
    ImportChild child("model.xyz", budget, [](ImportAnswer& answer) {
      std::vector<std::uint32_t> values(1 << 20);
      parallel_ranges(values.size(), 1000, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) values[i] = static_cast<std::uint32_t>(i + 7);
      });
      answer.write(values.data(), values.size() * 4);
    });
    std::vector<std::uint32_t> values(1 << 20);
    child.read(values.data(), values.size() * 4);
    EXPECT_EQ(values, wanted);
  });
}

TEST(ImportChild, PassesErrorsOn) {
  ImportBudget budget("model.xyz", {});
  try {
    ImportChild child("model.xyz", budget, [](ImportAnswer&) { throw Error(Trouble::Usage, "two\nlines"); });
    std::uint8_t byte = 0;
    child.read(&byte, 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.trouble(), Trouble::Usage);
    EXPECT_STREQ(error.what(), "two lines");
  }
}

TEST(ImportChild, MayBeLost) {
  EXPECT_EQ(complaint_about(answer_one), "");
  EXPECT_EQ(complaint_about([](ImportAnswer&) { std::abort(); }), "model.xyz: its reader crashed (signal 6)");
  EXPECT_EQ(complaint_about([](ImportAnswer&) { ::_exit(3); }), "model.xyz: its reader gave no answer");
  EXPECT_NE(complaint_about([](ImportAnswer&) { ::pause(); }).find("model.xyz: its reader asked"), std::string::npos);
  const auto loop = [](ImportAnswer&) {
    for (std::atomic<int> i = 0;; ++i) continue;
  };
  EXPECT_EQ(complaint_about(loop, {.seconds = 0.2}), "model.xyz: takes longer to load than the limit of 200 ms");
}

TEST(ImportChild, HasSoMuchMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer's allocator ends the process by itself";
#endif
  const auto eat = [](ImportAnswer& answer) {
    std::vector<std::vector<char>> eaten;
    for (int i = 0; i < 64; ++i) eaten.emplace_back(std::size_t{32} << 20, 'x');
    answer_one(answer);
  };
  EXPECT_EQ(complaint_about(eat, {.memory = 1 << 20}), "model.xyz: needs more memory than the limit (--max-memory)");
}

TEST(ImportChild, IsEndedByWhatNoReaderNeeds) {
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
      {"code", [] { ::mmap(nullptr, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0); }},
      {"memory of others", [] { ::mmap(nullptr, 4096, PROT_READ, MAP_SHARED | MAP_ANONYMOUS, -1, 0); }}};
  for (const auto& [name, deed] : deeds) {
    const auto work = [&, act = deed](ImportAnswer& answer) { act(), answer_one(answer); };
    EXPECT_EQ(complaint_about(work), "model.xyz: its reader asked the system for what no reader needs, and was ended")
        << name;
  }
  EXPECT_NE(::access(file.c_str(), F_OK), 0);
  const auto read = [](ImportAnswer& answer) {
    if (::open("/dev/null", O_RDONLY) < 0) std::abort();
    answer_one(answer);
  };
  EXPECT_EQ(complaint_about(read), "");
}

std::vector<std::uint8_t> bytes_of(const Scene& scene) {
  std::vector<std::uint8_t> out;
  write_scene(scene, [&](const void* data, std::size_t size) {
    const auto* at = static_cast<const std::uint8_t*>(data);
    out.insert(out.end(), at, at + size);
  });
  return out;
}

TEST(Sandbox, GivesTheSameScenesAndErrors) {
  const MemoryFile file;
  for (const auto& [format, bytes] :
       std::vector<std::pair<const char*, mesh_samples::Bytes>>{{"ply", mesh_samples::binary_ply(true)},
                                                                {"stl", mesh_samples::binary_stl()},
                                                                {"obj", mesh_samples::bytes_of(mesh_samples::obj)}}) {
    const std::string path = file.write(bytes);
    const LoadOptions plain{.limits = {}, .format = format, .choice = {}};
    LoadOptions boxed = plain;
    boxed.is_sandboxed = true;
    EXPECT_EQ(bytes_of(load_scene(path, boxed)), bytes_of(load_scene(path, plain))) << format;
    const std::string broken = file.write({bytes.begin(), bytes.begin() + 20});
    std::string said[2];
    for (const LoadOptions& options : {plain, boxed}) try {
        load_scene(broken, options);
      } catch (const Error& error) {
        said[options.is_sandboxed] = error.what();
      }
    EXPECT_EQ(said[0], said[1]);
  }
}

}  // namespace
}  // namespace zoneplate
