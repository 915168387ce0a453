// SPDX-License-Identifier: Apache-2.0
// What holds for every verb that opens a file from outside: it works in a process that is confined and limited, its
// options of limits act, and it waits for no FIFO. Runs the built program.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <fstream>

#include "measured_run.h"
#include "verbs_for_test.h"
#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/sandbox.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// An image that takes some time in every verb.
Rgba8Image noise(int side) {
  Rgba8Image image(side, side);
  std::uint32_t state = 1;
  for (Rgba8& c : image.values()) {
    state = state * 1664525 + 1013904223;
    c = {static_cast<std::uint8_t>(state >> 24), static_cast<std::uint8_t>(state >> 16),
         static_cast<std::uint8_t>(state >> 8), 255};
  }
  return image;
}

constexpr const char* shapes =
    "canvas 4000 4000\nfill #ff0000 smooth-union(20, circle(900, 900, 700), "
    "rectangle(2000, 2000, 900, 400))\n";

class Confinement : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "zoneplate_confinement_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    place = name;
    save_bytes((place / "image.png").string(), encode_png(noise(1500)));
    std::ofstream(place / "scene.sdf") << shapes;
  }
  void TearDown() override { fs::remove_all(place); }

  MeasuredRun run(const Words& words) const { return run_measured(words, place, 20); }
  /// Every command with a slow input of its kind, but `fidelity`, whose input is small.
  std::vector<std::pair<FileCommand, std::string>> slow_commands() const {
    std::vector<std::pair<FileCommand, std::string>> out;
    for (const FileCommand& c : image_commands()) out.emplace_back(c, "image.png");
    for (const FileCommand& c : model_commands()) out.emplace_back(c, "sphere:triangles=1000000");
    for (const FileCommand& c : text_commands())
      if (c.name != "fidelity") out.emplace_back(c, "scene.sdf");
    return out;
  }
  fs::path place;
};

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Whether a child of the run was seen under a filter for system calls.
bool is_seen_filtered(Words words, const fs::path& folder) {
  words.insert(words.begin(), program_file);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t program = ::fork();
  if (program == 0) {
    const int null = ::open("/dev/null", O_RDWR);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(null, stream);
    if (::chdir(folder.c_str()) == 0) ::execv(program_file, arguments.data());
    ::_exit(127);
  }
  bool is_filtered = false;
  int status = 0;
  while (::waitpid(program, &status, WNOHANG) == 0) {
    for (const pid_t process : process_tree(program)) {
      std::ifstream file("/proc/" + std::to_string(process) + "/status");
      for (std::string line; std::getline(file, line);) is_filtered = is_filtered || line == "Seccomp:\t2";
    }
    if (is_filtered) ::kill(program, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return is_filtered;
}

TEST_F(Confinement, EveryVerbWorksUnderAFilter) {
  if (!sandbox_lacks().filter.empty()) GTEST_SKIP() << "no seccomp";
  for (const auto& [command, input] : slow_commands()) {
    const Words words = command.with(input, "made.png");
    fs::remove_all(place / "made.png");
    EXPECT_TRUE(is_seen_filtered(words, place)) << command.name;
  }
  const Words trusted = with(image_commands()[3].with("image.png", "made.png"), {"--no-sandbox"});
  EXPECT_FALSE(is_seen_filtered(trusted, place));
}

TEST_F(Confinement, EveryOptionOfLimitsActs) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer takes memory of its own";
#endif
  struct Limit {
    Words words;
    std::string expected;
  };
  const std::vector<Limit> limits{{{"--max-memory", "8M"}, "--max-memory"},
                                  {{"--max-seconds", "0.001"}, "--max-seconds"},
                                  {{"--max-import-seconds", "0.001"}, "--max-import-seconds"},
                                  {{"--max-pixels", "1"}, "pixels"}};
  for (const auto& [command, input] : slow_commands())
    for (const Limit& limit : limits) {
      const bool is_image = input == "image.png";
      if (!is_image && limit.expected == "pixels") continue;                           // there is no image
      if (input == "scene.sdf" && limit.words[0] == "--max-import-seconds") continue;  // two lines
      const MeasuredRun r = run(with(command.with(input, "made.png"), limit.words));
      const std::string about = command.name + ' ' + limit.words[0] + ": " + r.err;
      EXPECT_TRUE(r.code == 1 || r.code == 3 || r.code == (command.writes_always ? 5 : 3)) << r.code << about;
      EXPECT_NE(r.err.find(limit.expected), std::string::npos) << about;
      EXPECT_LT(r.seconds, 10) << about;
      EXPECT_EQ(fs::exists(place / "made.png"), r.code == 5) << about;
      fs::remove_all(place / "made.png");
    }
}

TEST_F(Confinement, LargeOutputsKeepTheLimits) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer takes memory of its own";
#endif
  const Words limits{"--max-memory", "200M", "--max-import-seconds", "2", "--max-seconds", "2"};
  const Words compare{"compare", "--aa", "none", "-o", "made.png"};
  const Words sheet{"contact-sheet", "-o", "made.png", "--size", "3000x3000"};
  for (const Words& words : {with(compare, {"triangles", "--reference", "ssaa:n=2", "--size", "8000x8000"}),
                             with(compare, {"teapot", "--size", "1500x1500"}), with(sheet, Words(12, "triangles"))}) {
    const MeasuredRun r = run(with(words, limits));
    EXPECT_EQ(r.code, 1) << words[0] << r.err;
    EXPECT_NE(r.err.find("--max-"), std::string::npos) << words[0] << r.err;
    EXPECT_LT(r.seconds, 10) << words[0];
    EXPECT_LT(r.resident_bytes, 260'000'000u) << words[0];
    EXPECT_FALSE(fs::exists(place / "made.png")) << words[0];
  }
}

TEST_F(Confinement, NoVerbWaitsForAFifoOrReadsADevice) {
  ASSERT_EQ(::mkfifo((place / "fifo.png").c_str(), 0600), 0);
  const int server = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  const std::string socket = (place / "socket.png").string();
  ASSERT_LT(socket.size(), sizeof address.sun_path);
  socket.copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(server, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  fs::create_directory(place / "folder.png");
  std::vector<FileCommand> commands = image_commands();
  commands.insert(commands.end(), text_commands().begin(), text_commands().end());
  for (const FileCommand& command : commands)
    for (const auto& [input, kind] : std::vector<std::pair<std::string, std::string>>{
             {"fifo.png", "a FIFO"}, {"/dev/zero", "a device"}, {"socket.png", "a socket"}}) {
      const MeasuredRun r = run(command.with(input, "made.png"));
      EXPECT_EQ(r.code, 3) << command.name << ": " << r.err;
      EXPECT_NE(r.err.find(input + ": is " + kind + ", not a file\n"), std::string::npos) << command.name << r.err;
      EXPECT_LT(r.seconds, 5) << command.name;
      EXPECT_FALSE(fs::exists(place / "made.png")) << command.name;
    }
  ::close(server);
  for (const char* ending : {".obj", ".ply", ".stl", ".glb", ".gltf"}) {
    const std::string name = std::string("fifo") + ending;
    ASSERT_EQ(::mkfifo((place / name).c_str(), 0600), 0);
    for (const FileCommand& command : model_commands()) {
      const MeasuredRun r = run(command.with(name, "made.png"));
      EXPECT_EQ(r.code, command.writes_always ? 5 : 3) << command.name << ": " << r.err;
      EXPECT_NE(r.err.find(name + ": is a FIFO, not a file\n"), std::string::npos) << command.name << r.err;
      EXPECT_LT(r.seconds, 5) << command.name;
      fs::remove_all(place / "made.png");
    }
  }
}

}  // namespace
}  // namespace zoneplate
