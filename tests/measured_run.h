// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "zoneplate/base/paths_for_test.h"

namespace zoneplate {

/// How a run of the built program ended and what it took.
struct MeasuredRun {
  int code = -1;  ///< its exit code; 1000 and the number of the signal that ended it
  double seconds = 0;
  /// The greatest sum over the process and all that descend from it, looked at every 5 ms, of their resident pages.
  /// Pages that several of them share count once for each.
  std::uint64_t resident_bytes = 0;
  /// The same with shared pages divided by the number of those who share them (smaps_rollup), looked at every 50 ms.
  std::uint64_t proportional_bytes = 0;
  std::string err;  ///< what it wrote to stderr
};

/// A process and all that descend from it.
inline std::vector<pid_t> process_tree(pid_t root) {
  namespace fs = std::filesystem;
  std::vector<pid_t> tree{root};
  for (std::size_t i = 0; i < tree.size(); ++i) {
    std::error_code gone;
    for (fs::directory_iterator thread("/proc/" + std::to_string(tree[i]) + "/task", gone), end; !gone && thread != end;
         thread.increment(gone)) {
      std::ifstream children(thread->path() / "children");
      for (pid_t child = 0; children >> child;) tree.push_back(child);
    }
  }
  return tree;
}

inline std::uint64_t resident_bytes_of(pid_t process) {
  std::ifstream statm("/proc/" + std::to_string(process) + "/statm");
  std::uint64_t size = 0, resident = 0;
  statm >> size >> resident;
  return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

inline std::uint64_t proportional_bytes_of(pid_t process) {
  std::ifstream rollup("/proc/" + std::to_string(process) + "/smaps_rollup");
  for (std::string word; rollup >> word;)
    if (std::uint64_t kilobytes = 0; word == "Pss:" && rollup >> kilobytes) return kilobytes * 1024;
  return 0;
}

/// Runs the built program in a folder, stdout and stderr to the files `out` and `err` there; it is killed, with all its
/// children, after `max_seconds`.
inline MeasuredRun run_measured(std::vector<std::string> words, const std::filesystem::path& folder,
                                double max_seconds) {
  words.insert(words.begin(), program_file);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const std::string out = (folder / "out").string(), err = (folder / "err").string(), in = folder.string();
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = ::fork();
  if (child == 0) {
    ::setpgid(0, 0);
    ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
    ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    if (::chdir(in.c_str()) == 0) ::execv(program_file, arguments.data());
    ::_exit(127);
  }
  ::setpgid(child, child);  // whichever of the two comes first
  MeasuredRun run;
  int status = 0;
  for (int look = 0; ::waitpid(child, &status, WNOHANG) == 0; ++look) {
    std::uint64_t resident = 0, proportional = 0;
    for (const pid_t process : process_tree(child)) {
      resident += resident_bytes_of(process);
      if (look % 10 == 9) proportional += proportional_bytes_of(process);
    }
    run.resident_bytes = std::max(run.resident_bytes, resident);
    run.proportional_bytes = std::max(run.proportional_bytes, proportional);
    run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (run.seconds > max_seconds) ::kill(-child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  ::kill(-child, SIGKILL);  // none that the program left behind
  run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  std::stringstream text;
  text << std::ifstream(err).rdbuf();
  run.err = text.str();
  return run;
}

}  // namespace zoneplate
