// SPDX-License-Identifier: Apache-2.0
// Runs that end badly: no room, nobody who reads, no folder, killed at any moment. What stands under an output's name
// is always the whole of it. Runs the built program.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <sstream>
#include <thread>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/os/program_for_test.h"
#include "zoneplate/report/json_for_test.h"

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

using zoneplate::text_of;

// Runs the program in an empty folder of its own, which is removed at the end.
class Endings : public zoneplate::ProgramTest {
 protected:
  // Starts the program, after `prepare` in the new process; stdout and stderr go to files.
  pid_t start(Words words, const std::function<void()>& prepare = {}) const {
    words.insert(words.begin(), zoneplate::program_file);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const std::string out = (place / ".out").string(), err = (place / ".err").string();
    const pid_t child = ::fork();
    if (child != 0) return child;
    ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
    ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    for (int fd = 3; fd < 64; ++fd) ::close(fd);
    if (prepare) prepare();
    if (::chdir(place.c_str()) == 0) ::execv(zoneplate::program_file, arguments.data());
    ::_exit(127);
  }
  // The exit code, or 1000 and the signal.
  static int finish(pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  int run(const Words& words, const std::function<void()>& prepare = {}) const { return finish(start(words, prepare)); }
  std::string complaint() const { return text_of(place / ".err"); }

  // What stands in a folder under names that do not begin with a dot.
  std::map<std::string, std::string> files(const std::string& folder = ".") const {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::directory_iterator(place / folder))
      if (const std::string name = entry.path().filename(); name[0] != '.' && entry.is_regular_file())
        out[name] = text_of(entry.path());
    return out;
  }
  bool has_temporaries() const {
    for (const auto& entry : fs::directory_iterator(place))
      if (entry.path().extension() == ".tmp") return true;
    return false;
  }
  // Jobs whose images all differ, into a folder.
  void write_manifest(const std::string& name, const std::string& folder, int count) const {
    fs::create_directories(place / folder);
    std::ofstream file(place / name);
    for (int i = 0; i < count; ++i)
      file << R"({"input":"teapot","output":")" << folder << "/" << i << R"(.png","camera-azimuth-angle":)"
           << i * 7 % 360 << "}\n";
  }
};

void allow_files_of(rlim_t bytes) {
  const rlimit limit{bytes, bytes};
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

TEST_F(Endings, AFullDiskGives4AndLeavesNothing) {
  for (const char* name : {"a.png", "a.jpg", "a.webp", "a.pfm"}) {
    EXPECT_EQ(run({"teapot", "-o", name, "--size", "200x200"}, [] { allow_files_of(900); }), 4) << name;
    EXPECT_NE(complaint().find(std::string(name) + ": cannot be written: File too large"), std::string::npos)
        << complaint();
  }
  EXPECT_EQ(run({"teapot", "-o", "a.apng", "--turntable", "3", "--size", "200x200"}, [] { allow_files_of(900); }), 4);
  EXPECT_EQ(run({"contact-sheet", "teapot", "triangles", "-o", "s.png"}, [] { allow_files_of(900); }), 4);
  EXPECT_EQ(run({"signal", "filter", "bricks", "--low-pass", "0.06", "-o", "f.png"}, [] { allow_files_of(900); }), 4);
  EXPECT_TRUE(files().empty());
  EXPECT_FALSE(has_temporaries());
  EXPECT_EQ(run({"teapot", "-o", "/dev/full", "--size", "20x20"}), 2);  // no image's ending
}

TEST_F(Endings, AFilmOfAnotherProgramNeedsRoomToo) {
  if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not installed";
  const int code = run({"teapot", "-o", "a.gif", "--turntable", "3", "--size", "200x200"}, [] { allow_files_of(900); });
  EXPECT_TRUE(code == 1 || code == 4) << code;  // it is ffmpeg that finds no room first;
  EXPECT_TRUE(files().empty()) << files().begin()->first;
  EXPECT_FALSE(has_temporaries());
}

TEST_F(Endings, AClosedStdoutIsNotTakenForAFile) {
  // The first file that is opened gets the number of a stream that is closed: nothing else may be written there.
  ASSERT_EQ(run({"teapot", "-o", "whole.png", "--size", "64x64"}), 0);
  const std::string whole = files().at("whole.png");
  for (const int stream : {0, 1, 2}) {
    const int code = run({"teapot", "-o", "a.png", "--size", "64x64", "--json", "--verbose"}, [&] { ::close(stream); });
    EXPECT_EQ(code, stream == 1 ? 4 : 0);
    EXPECT_EQ(files().at("a.png"), whole);
    fs::remove(place / "a.png");
  }
  EXPECT_EQ(run({"teapot", "-o", "-", "--size", "64x64"}, [] { ::close(1); }), 4);
}

TEST_F(Endings, AFolderThatGoesAwayIsToldOfAndNothingStays) {
  write_manifest("jobs.jsonl", "out", 400);
  const pid_t child = start({"--manifest", "jobs.jsonl", "--size", "64x64"});
  while (!fs::exists(place / "out/3.png")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::error_code again;
  do fs::remove_all(place / "out", again);
  while (fs::exists(place / "out"));
  EXPECT_EQ(finish(child), 5);
  EXPECT_NE(complaint().find("out/399.png: "), std::string::npos);
  EXPECT_FALSE(fs::exists(place / "out"));

  fs::create_directory(place / "frames");
  const pid_t film = start({"teapot", "-o", "frames/f.####.png", "--turntable", "400", "--size", "64x64"});
  while (!fs::exists(place / "frames/f.0003.png")) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  do fs::remove_all(place / "frames", again);
  while (fs::exists(place / "frames"));
  EXPECT_EQ(finish(film), 4);
}

TEST_F(Endings, KilledAtAnyMomentNothingPartialHasItsName) {
  const Words words = {"teapot", "-o", "a.png", "--size", "600x400", "--aa", "none", "--aov", "depth"};
  const auto before = std::chrono::steady_clock::now();
  ASSERT_EQ(run(words), 0);
  const auto whole_time = std::chrono::steady_clock::now() - before;
  const std::map<std::string, std::string> whole = files();
  ASSERT_EQ(whole.size(), 2u);
  std::mt19937 random(4);
  int killed = 0;
  for (int i = 0; i < 50; ++i) {
    for (const auto& [name, bytes] : whole) fs::remove(place / name);
    const pid_t child = start(words);
    std::this_thread::sleep_for(whole_time * (random() % 1000) / 900);
    ::kill(child, SIGKILL);
    killed += finish(child) == 1000 + SIGKILL;
    for (const auto& [name, bytes] : files()) EXPECT_EQ(bytes, whole.at(name)) << name << ", run " << i;
  }
  EXPECT_GT(killed, 10);
  EXPECT_EQ(run(words), 0);  // what killed runs left does not stand in the way
  EXPECT_EQ(files(), whole);
}

TEST_F(Endings, AComparisonThatIsEndedLeavesAWholeFolderOrNothing) {
  const Words words = {"compare",     "triangles", "--aa",   "none,fxaa", "--turns", "1",
                       "--reference", "none",      "--size", "64x48",     "-o",      "out"};
  const auto before = std::chrono::steady_clock::now();
  ASSERT_EQ(run(words), 0) << complaint();
  const auto whole_time = std::chrono::steady_clock::now() - before;
  const auto count = [&] {
    return std::distance(fs::recursive_directory_iterator(place / "out"), fs::recursive_directory_iterator());
  };
  const auto whole = count();
  std::mt19937 random(5);
  int ended = 0;
  for (int i = 0; i < 20; ++i) {
    fs::remove_all(place / "out");
    const pid_t child = start(words);
    // At any moment, and more often near the end, where the folder is written.
    std::this_thread::sleep_for(whole_time * (i % 2 == 0 ? random() % 800 : 700 + random() % 300) / 1000);
    ::kill(child, SIGTERM);
    const int code = finish(child);
    ASSERT_TRUE(code == 0 || code == 128 + SIGTERM || code == 1000 + SIGTERM) << code << complaint();
    ended += code != 0;
    const auto found = fs::exists(place / "out") ? count() : 0;
    EXPECT_TRUE(found == whole || (found == 0 && code != 0)) << found << " files of " << whole << ", exit " << code;
    EXPECT_FALSE(has_temporaries());
  }
  EXPECT_GT(ended, 0);
}

TEST_F(Endings, KilledShardsThatBeginAgainMakeTheFilesOfOneRun) {
  write_manifest("whole.jsonl", "whole", 60);
  write_manifest("parts.jsonl", "parts", 60);
  ASSERT_EQ(run({"--manifest", "whole.jsonl", "--size", "48x48"}), 0) << complaint();
  std::mt19937 random(9);
  for (const char* shard : {"0/4", "1/4", "2/4", "3/4"}) {
    const Words words = {"--manifest", "parts.jsonl", "--size", "48x48", "--shard", shard, "--skip-existing"};
    for (int i = 0; i < 3; ++i) {
      const pid_t child = start(words);
      std::this_thread::sleep_for(std::chrono::microseconds(random() % 40000));
      ::kill(child, i == 0 ? SIGTERM : SIGKILL);
      finish(child);
    }
    EXPECT_EQ(run(words), 0) << complaint();
  }
  EXPECT_EQ(files("parts"), files("whole"));
  EXPECT_EQ(files("whole").size(), 60u);
}

TEST_F(Endings, AnimationsKeepAFrameAtMostTwice) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer keeps what is freed";
#endif
  const auto peak = [&](const char* output, const char* frames) {
    EXPECT_EQ(run({"teapot", "-o", output, "--turntable", frames, "--size", "256x256", "--aa", "none", "--json"}), 0)
        << complaint();
    return zoneplate::parsed_json(text_of(place / ".out"))["peak_memory_bytes"].get<std::uint64_t>();
  };
  constexpr std::uint64_t frame = 256 * 256 * 4, more = 24;
  for (const char* output : {"a.apng", "a.webp"}) EXPECT_LT(peak(output, "32"), peak(output, "8") + more * frame * 2);
  if (std::system("command -v ffmpeg >/dev/null 2>&1") == 0) {
    // No frame is kept: what threads take for themselves is far below a quarter of the frames.
    EXPECT_LT(peak("a.mp4", "80"), peak("a.mp4", "8") + 72 * frame / 4);
  }
}

TEST_F(Endings, ManyItemsNeedNoMoreMemoryThanAFew) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer keeps what is freed";
#endif
  std::string model =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
      "endfacet\nendsolid\n";
  std::ofstream(place / "a.stl") << model;
  std::ofstream(place / "b.stl") << model;
  std::ofstream jobs(place / "jobs.jsonl");
  for (int i = 0; i < 2000; ++i)
    jobs << R"({"input":")" << (i % 2 ? "a" : "b") << R"(.stl","output":"o)" << i << R"(.png"})"
         << "\n";
  jobs.close();
  ASSERT_EQ(run({"--manifest", "jobs.jsonl", "--size", "32x32"}), 0) << complaint();
  std::istringstream out(text_of(place / ".out"));
  std::vector<std::uint64_t> peaks;
  for (std::string line; std::getline(out, line);)
    peaks.push_back(zoneplate::parsed_json(line)["peak_memory_bytes"].get<std::uint64_t>());
  ASSERT_EQ(peaks.size(), 2000u);
  EXPECT_LT(peaks[1999], peaks[99] + (1 << 20));
}

}  // namespace
