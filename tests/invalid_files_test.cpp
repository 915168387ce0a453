// Every broken file of a folder beside the sources: the command says no with one line that names the file, or draws
// what can be drawn and warns; at once, in little memory, and without leaving anything half written.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Result {
  int code = -1;
  std::string err;
  double seconds = 0;
  long megabytes = 0;
};

Result run(std::vector<std::string> words, const fs::path& err) {
  std::string program = ZONEPLATE_PROGRAM;
  std::vector<char*> arguments{program.data()};
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(::open("/dev/null", O_WRONLY), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    ::execv(ZONEPLATE_PROGRAM, arguments.data());
    ::_exit(127);
  }
  int status = 0;
  rusage usage{};
  while (::wait4(child, &status, WNOHANG, &usage) == 0) {
    if (seconds() > 20) ::kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  std::stringstream text;
  text << std::ifstream(err).rdbuf();
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text.str(), seconds(),
          usage.ru_maxrss / 1024};
}

/// How the command is asked to read a file of this name; nothing for what only belongs to another file.
std::vector<std::string> command_for(const fs::path& file) {
  const std::string extension = file.extension().string();
  std::vector<std::string> words;
  for (const char* model : {".gltf", ".glb", ".obj", ".ply", ".stl"})
    if (extension == model) words = {"render", "--size", "64x64"};
  for (const char* image : {".png", ".jpg", ".hdr"})
    if (extension == image) words = {"signal", "spectrum"};
  if (words.empty()) return words;
  words.push_back(file.string());
  words.push_back("-o");
  return words;
}

TEST(InvalidFiles, AreRefusedOrDrawnWithAWarning) {
  const fs::path root = fs::path(ZONEPLATE_SOURCE_DIR) / "../shared/data/invalid";
  if (!fs::exists(root)) GTEST_SKIP() << "no shared files";
  std::string name = (fs::temp_directory_path() / "zoneplate_invalid_XXXXXX").string();
  ASSERT_NE(::mkdtemp(name.data()), nullptr);
  const fs::path folder = name;
  fs::create_directory(folder / "out");
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    std::vector<std::string> words = command_for(entry.path());
    if (!entry.is_regular_file() || words.empty()) continue;
    ++files;
    const fs::path out = folder / "out" / "picture.png";
    words.push_back(out.string());
    const Result r = run(words, folder / "err");
    const std::string about = entry.path().string() + ": " + r.err;
    EXPECT_TRUE(r.code == 3 || r.code == 0) << about << " exit " << r.code;
    EXPECT_EQ(r.code == 0, fs::exists(out)) << about;
    if (r.code == 3) {
      EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << about;
      EXPECT_NE(r.err.find(entry.path().filename().string()), std::string::npos) << about;
    }
    EXPECT_LT(r.seconds, 5) << about;
    EXPECT_LT(r.megabytes, 1024) << about;
    fs::remove(out);
    EXPECT_TRUE(fs::is_empty(folder / "out")) << about;
  }
  EXPECT_GT(files, 10u);
  fs::remove_all(folder);
}

}  // namespace
