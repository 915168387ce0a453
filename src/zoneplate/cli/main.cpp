// SPDX-License-Identifier: Apache-2.0
// zoneplate: the command. Contains the table of verbs, and the conversion of errors to exit codes.
#include <fmt/format.h>

#include <fcntl.h>
#include <pthread.h>
#include <unistd.h>
#include <csignal>
#include <filesystem>
#include <new>
#include <vector>

#include "zoneplate/base/closest.h"
#include "zoneplate/base/error.h"
#include "zoneplate/cli/exit_code.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/cli/version.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/mapped_file_guard.h"
#include "zoneplate/os/run_program.h"
#include "zoneplate/scene/builtin/builtin.h"

namespace zoneplate::cli {
namespace {

const Verb* find_verb(std::string_view name) {
  for (const Verb& verb : all_verbs())
    if (verb.name == name) return &verb;
  return nullptr;
}

std::string overview() {
  return "Zoneplate renders 3D models to antialiased images, on the CPU.\n"
         "\n"
         "Usage: zoneplate [VERB] ARGUMENTS\n"
         "\n" +
         lines_of(all_verbs(), 15) +
         "\n"
         "Examples:\n"
         "  zoneplate teapot -o teapot.png\n"
         "  zoneplate render chair.glb -o chair.png --size 1024x768 --aa ssaa:n=4\n"
         "  zoneplate list methods\n"
         "\n"
         "More: zoneplate VERB -h (short), zoneplate VERB --help (everything), zoneplate man, zoneplate --version\n";
}

// A first word that is not a verb is the input of render. Throws if it is a misspelt verb or scene.
void refuse_misspelt_verb(const std::string& word) {
  std::error_code ignored;
  if (word.starts_with('-') || word.find_first_of("./:") != std::string::npos) return;
  if (std::filesystem::exists(word, ignored)) return;
  std::vector<std::string_view> names{"help"};
  for (const Verb& verb : all_verbs()) names.push_back(verb.name);
  const std::size_t verb_count = names.size();
  for (const BuiltinScene& scene : builtin_scenes()) names.push_back(scene.name);
  for (const BuiltinScene& scene : builtin_scenes())
    if (scene.name == word) return;

  const std::string_view near = closest(word, names);
  if (near.empty()) return;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == near)
      throw Error(
          i < verb_count ? ErrorKind::Usage : ErrorKind::Input,
          fmt::format("{}: no such {}; did you mean {}?", word, i < verb_count ? "verb" : "file or scene", near));
}

void run(std::vector<std::string> arguments) {
  if (arguments.empty()) return print(overview());
  const std::string first = arguments.front();
  if (first == "--version" || first == "-V" || first == "version") return print(version_text());
  if (first == "-h" || first == "--help") return print(overview());
  if (first == "help") {
    if (arguments.size() == 1) return print(overview());
    arguments = {arguments[1], "--help"};
    if (find_verb(arguments.front()) == nullptr) refuse_misspelt_verb(arguments.front());
  }

  const std::span<const std::string> all(arguments);
  if (const Verb* verb = find_verb(arguments.front())) return verb->run(all.subspan(1));
  refuse_misspelt_verb(arguments.front());
  run_render(all);
}

// Opens /dev/null for closed standard streams, so that no output file gets their descriptors.
void occupy_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0) static_cast<void>(::open("/dev/null", O_RDONLY));
}

// The stacks of threads count towards the memory limit whether used or not; the default of 8 MB each is too much.
void shorten_stacks_of_threads() {
  constexpr std::size_t stack_bytes = std::size_t{2} << 20;
  pthread_attr_t attributes;
  if (::pthread_attr_init(&attributes) != 0) return;
  if (::pthread_attr_setstacksize(&attributes, stack_bytes) == 0) ::pthread_setattr_default_np(&attributes);
  ::pthread_attr_destroy(&attributes);
}

bool has_progress_bar = false;

// Signal handler: removes temporary files, ends the programs that were started, and exits with the shell's code for the
// signal. On a terminal the prompt follows on a new line, below the progress bar.
extern "C" void leave(int signal) {
  remove_temporaries();
  end_programs();
  if (has_progress_bar) static_cast<void>(!::write(STDERR_FILENO, "\n", 1));
  ::_exit(128 + signal);
}

}  // namespace
}  // namespace zoneplate::cli

int main(int argc, char** argv) {
  using namespace zoneplate;
  cli::occupy_closed_streams();
  cli::has_progress_bar = cli::stderr_is_terminal();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (std::signal(signal, cli::leave) == SIG_IGN) std::signal(signal, SIG_IGN);  // nohup ignores signals
  std::signal(SIGPIPE, SIG_IGN);  // writing to a closed stdout is an error of write(), with exit code 4
  std::signal(SIGXFSZ, SIG_IGN);  // the same for the maximum size of files
  survive_truncated_mappings();
  cli::shorten_stacks_of_threads();
  try {
    cli::run(std::vector<std::string>(argv + 1, argv + argc));
    return 0;
  } catch (const Error& error) {
    cli::say_error(error.what());
    return cli::exit_code(error.kind());
  } catch (const cli::PartialFailure& failure) {
    cli::say_error(failure.what());
    return 5;
  } catch (const cli::Difference& difference) {
    cli::say_note(difference.what());
    return 1;
  } catch (const cli::Terminated& ended) {
    cli::say_note(ended.what());
    return 128 + SIGTERM;
  } catch (const std::bad_alloc&) {
    cli::say_error("out of memory");
    return 1;
  } catch (const std::exception& error) {
    cli::say_error(error.what());
    return 1;
  }
}
