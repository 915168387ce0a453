// SPDX-License-Identifier: Apache-2.0
// zoneplate-mpi: one image by several processes, each of which draws a part of the triangles (docs/farms.md).
#include <fmt/format.h>
#include <mpi.h>

#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <ctime>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "mpi_ranks.h"
#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/base/processors.h"
#include "zoneplate/batch/item_files.h"
#include "zoneplate/cli/exit_code.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/render/args.h"
#include "zoneplate/job/check.h"
#include "zoneplate/job/option_values.h"
#include "zoneplate/job/parts/render_parts.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/mapped_file_guard.h"
#include "zoneplate/os/memory_limit.h"
#include "zoneplate/process/item_process.h"

namespace zoneplate::cli {
namespace {

/// An error of some rank that every rank has.
struct SharedError : Error {
  using Error::Error;
};

/// Runs `body` on every rank. If it fails on some, every rank throws the error of the first of them; `memory` is that
/// of an allocation that fails.
void agree(Ranks& ranks, const std::function<void()>& body, const std::string& memory = "out of memory") {
  std::optional<Error> own;
  try {
    body();
  } catch (const SharedError&) {
    throw;
  } catch (const Error& error) {
    own.emplace(error.kind(), error.what());
  } catch (const std::bad_alloc&) {
    own.emplace(ErrorKind::Failed, memory);
  } catch (const std::exception& error) {
    own.emplace(ErrorKind::Failed, error.what());
  }
  const std::string text = own ? own->what() : "";
  std::vector<ByteBuffer> to(static_cast<std::size_t>(ranks.count()));
  for (ByteBuffer& buffer : to) {
    buffer.put(own ? static_cast<int>(own->kind()) : -1);
    buffer.append(std::as_bytes(std::span(text)));
  }
  const std::vector<ByteBuffer> from = ranks.exchange(to);
  for (std::size_t r = 0; r < from.size(); ++r) {
    ByteReader reader((static_cast<int>(r) == ranks.rank() ? to[r] : from[r]).bytes());
    const int kind = reader.take<int>();
    const auto message = reader.rest();
    if (kind >= 0)
      throw SharedError(static_cast<ErrorKind>(kind),
                        std::string(reinterpret_cast<const char*>(message.data()), message.size()));
  }
}

/// Files that are written, and have no names yet.
using Written = std::vector<std::unique_ptr<FileWriter>>;

/// Keeps the files until every rank has done its part, and then writes them: no file remains of a run that ends early.
class FilesAtEnd : public JobSink {
 public:
  explicit FilesAtEnd(const RenderArgs& args) : args_(args) {}
  void file(int frame, int layer, std::span<const std::uint8_t> bytes) override {
    files_.push_back({output_path(args_, frame, layer), {bytes.begin(), bytes.end()}});
  }
  void film_frame(const Rgba8Image&) override {}

  /// Writes the files without their names, which `commit` gives them.
  Written written(Ranks& ranks) const {
    Written out;
    agree(ranks, [&] {
      for (const File& file : files_) {
        out.push_back(std::make_unique<FileWriter>(file.path));
        out.back()->write(file.bytes);
      }
    });
    return out;
  }

 private:
  struct File {
    std::string path;
    std::vector<std::uint8_t> bytes;
  };
  const RenderArgs& args_;
  std::vector<File> files_;
};

struct MpiArgs : RenderArgs {
  Partition partition = Partition::Index;
};

/// Whether an option of render is one of batches, or of what the command does beside rendering.
bool is_of_command(const Option& option) {
  constexpr std::string_view names[] = {"--dry-run",  "--preset",  "--no-config", "--json",
                                        "--progress", "--sandbox", "--no-sandbox"};
  return option.group == "Batches" || std::ranges::find(names, names_of(option).front()) != std::end(names);
}

Syntax mpi_syntax(MpiArgs& args) {
  Syntax syntax = render_syntax(args);
  syntax.program = "zoneplate-mpi";
  syntax.summary = "Render one image of a model, or of several that form one scene, by the ranks of MPI";
  syntax.operands = "IN... -o OUT";
  syntax.examples =
      "  mpirun -n 2 zoneplate-mpi render chair.glb -o chair.png --size 1920x1080\n"
      "  mpirun -n 4 zoneplate-mpi render floor*.obj -o house.png --aa msaa\n";
  syntax.notes = "Each rank rasterizes and shades a part of the triangles; the file has the bytes of one process.";
  std::erase_if(syntax.options, is_of_command);
  static const Choices names = {"node", "index", "interleaved"};
  syntax.options.push_back(choice_option(
      "--partition", "HOW",
      "How the triangles of one model are distributed over the ranks: node (whole nodes), index (default; as many "
      "triangles for each) or interleaved (runs of 64, by a hash). Of several models each rank reads some",
      "Ranks", false, names, [&](std::size_t i) { args.partition = static_cast<Partition>(i); }));
  return syntax;
}

[[noreturn]] void refuse(const std::string& what) { throw Error(ErrorKind::Usage, what); }

/// The job of the command line; nothing after printing the help.
std::optional<PartsJob> parse_parts(MpiArgs& args, std::vector<std::string> arguments) {
  if (!arguments.empty() && arguments.front() == "render") arguments.erase(arguments.begin());
  Syntax syntax = mpi_syntax(args);
  if (!parse(syntax, arguments)) return std::nullopt;
  args.inputs = syntax.found_operands;
  if (args.inputs.empty()) refuse("no input: give a model, or several that form one scene");
  args.input = args.inputs.front();
  set_output(args, args.output, 0);
  check_args(args);
  return PartsJob{args, args.inputs, args.partition};
}

void report(const MpiArgs& args, const MpiRanks& ranks, const Summary& summary, const PartTimes& times) {
  for (const std::string& warning : summary.warnings)
    if (args.verbosity != Verbosity::Quiet) say_warning(warning);
  if (args.verbosity != Verbosity::Verbose) return;
  std::string steps;
  for (const auto& [name, ms] : summary.times) steps += fmt::format(", {} {:.1f} ms", name, ms);
  const double processor = 1000.0 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  say_note(
      fmt::format("rank {} of {}: visibility {:.1f} ms, merge {:.1f} ms, shading {:.1f} ms, resolve {:.1f} ms{}; "
                  "processor {:.1f} ms, sent {} bytes",
                  ranks.rank(), ranks.count(), times.visibility, times.merge, times.shading, times.resolve, steps,
                  processor, ranks.sent_bytes()));
}

Written run(MpiRanks& ranks, std::vector<std::string> arguments) {
  MpiArgs args;
  std::optional<PartsJob> parts;
  agree(ranks, [&] {
    // The help is printed once.
    const bool is_help =
        std::ranges::any_of(arguments, [](const std::string& a) { return a == "-h" || a.starts_with("--help"); });
    if (is_help && ranks.rank() != 0) return;
    parts = parse_parts(args, std::move(arguments));
    if (parts && ranks.rank() == 0) check_own_files(args), check_outputs(args);
  });
  if (all_values(ranks, parts ? 1 : 0).front() == 0) return {};
  int threads = args.threads;
  if (threads == 0) threads = std::max(1, usable_processors() / ranks.count_on_machine());
  FilesAtEnd files(args);
  const std::string memory = fmt::format("{}: needs more memory than the limit of {}", args.input,
                                         memory_limit_text(args.load.limits.memory, "--max-memory"));
  limit_memory(args.load.limits.memory);
  try {
    with_isa(args.isa, [&] {
      with_threads(threads, [&] {
        with_deadline(args.max_seconds, ErrorKind::Failed, late_item(args.input, args.max_seconds), [&] {
          PartTimes times;
          const Summary summary = render_parts(
              std::move(*parts), ranks, [&](const std::function<void()>& body) { agree(ranks, body, memory); }, files,
              times);
          report(args, ranks, summary, times);
        });
      });
    });
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::Failed, memory);
  }
  return files.written(ranks);
}

extern "C" void leave(int signal) {
  remove_temporaries();
  ::_exit(128 + signal);
}

/// Ends all ranks for an error of this one. Others that fail for the same reason are slower by their rank, so that one
/// line is printed.
[[noreturn]] void end_all(int rank, const std::string& message, int code) {
  std::this_thread::sleep_for(std::chrono::milliseconds(std::min(50 * rank, 2000)));
  say_error(message);
  remove_temporaries();
  MPI_Abort(MPI_COMM_WORLD, code);
  ::_exit(code);
}

}  // namespace
}  // namespace zoneplate::cli

int main(int argc, char** argv) {
  using namespace zoneplate;
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, cli::leave);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  survive_truncated_mappings();
  MpiRanks ranks;
  int code = 0;
  cli::Written files;
  try {
    files = cli::run(ranks, std::vector<std::string>(argv + 1, argv + argc));
  } catch (const cli::SharedError& error) {
    if (ranks.rank() == 0) cli::say_error(error.what());
    code = cli::exit_code(error.kind());
  } catch (const Error& error) {
    cli::end_all(ranks.rank(), error.what(), cli::exit_code(error.kind()));
  } catch (const std::bad_alloc&) {
    cli::end_all(ranks.rank(), "out of memory", 1);
  } catch (const std::exception& error) {
    cli::end_all(ranks.rank(), error.what(), 1);
  }
  MPI_Finalize();
  // No rank has anything left to do: one that is killed before has left no file.
  try {
    for (const std::unique_ptr<FileWriter>& file : files) file->commit();
  } catch (const Error& error) {
    cli::say_error(error.what());
    code = cli::exit_code(error.kind());
  }
  return code;
}
