// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/confined.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/formats/font/font.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/library.h"
#include "zoneplate/process/item_process.h"
#include "zoneplate/process/packed.h"
#include "zoneplate/process/packed_plots.h"

namespace zoneplate::cli {
namespace {

/// How the work of a confined process ended, if it threw no Error.
enum class Ending : std::uint8_t { Done, Partly, Differs };

std::vector<std::uint8_t> packed_end(Ending ending, const std::string& text, std::span<const std::uint8_t> result) {
  Packer out;
  out.value(ending);
  out.text(text);
  out.text({result.begin(), result.end()});
  return std::move(out).bytes();
}

std::vector<std::uint8_t> work_packed(const std::function<void(Delivery&)>& work, Delivery& delivery) {
  try {
    work(delivery);
  } catch (const PartialFailure& failure) {
    return packed_end(Ending::Partly, failure.what(), {});
  } catch (const Difference& difference) {
    return packed_end(Ending::Differs, difference.what(), {});
  }
  return packed_end(Ending::Done, "", delivery.result());
}

std::vector<std::uint8_t> bytes_read(std::uint64_t size, std::uint64_t most, const std::string& name,
                                     const ItemEvents::Read& read) {
  if (size > most) throw Error(ErrorKind::Failed, name + ": its file needs more memory than --max-memory allows");
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
  read(bytes);
  return bytes;
}

/// The files that a process has delivered, which it may deliver again when it is restarted.
class DeliveredFiles {
 public:
  /// Passes a file on in parts, so that a large one is never in memory as a whole.
  void add(const std::string& path, std::uint64_t size, const ItemEvents::Read& read) {
    std::vector<std::uint8_t> part(static_cast<std::size_t>(std::min<std::uint64_t>(size, 1 << 20)));
    FileWriter& file = begin(path);
    for (std::uint64_t left = size; left > 0;) {
      const std::span<std::uint8_t> some(part.data(),
                                         static_cast<std::size_t>(std::min<std::uint64_t>(left, part.size())));
      read(some);
      file.write(some);
      left -= some.size();
    }
  }
  void add(const std::string& path, std::span<const std::uint8_t> bytes) { begin(path).write(bytes); }
  /// Only now they are there: none of a process that fails.
  void commit() {
    for (const auto& [path, file] : files_) file->commit();
    files_.clear();
  }

 private:
  FileWriter& begin(const std::string& path) { return *(files_[path] = std::make_unique<FileWriter>(path)); }
  std::map<std::string, std::unique_ptr<FileWriter>> files_;
};

/// `readable` and the fonts of figures.
std::vector<std::string> with_fonts(std::vector<std::string> readable) {
  for (const char* file : {"DejaVuSans.ttf", "DejaVuSans-Bold.ttf"}) try {
      readable.push_back(dejavu_path(file));
    } catch (const Error&) {  // not installed: what needs it says so
    }
  return readable;
}

}  // namespace

std::vector<std::uint8_t> run_confined(const ConfinedRun& run, const std::function<void(Delivery&)>& work) {
  const LoadLimits& load = run.limits.load;
  // Standard input cannot be read again, as would be necessary if its format turned out to need one of these libraries.
  if (std::ranges::find(run.readable, "-") != run.readable.end())
    for (const Library library : {Library::Avif, Library::Jxl, Library::Lcms, Library::OpenExr, Library::Tiff})
      static_cast<void>(open_library(library));
  ItemProcess process({.name = run.name == "-" ? "standard input" : run.name,
                       .load = load,
                       .seconds = run.limits.seconds,
                       .is_sandboxed = uses_sandbox(run.limits.is_sandboxed, say_warning),
                       .readable = with_fonts(run.readable),
                       .open = run.open,
                       .names_errors = false,
                       .work = "working on it"},
                      1, [&](std::size_t, ItemSender& sender) {
                        if (!run.progress || !run.progress->is_shown()) sender.mute_progress();
                        Delivery delivery(sender, load);
                        sender.has_read();  // until Delivery::read
                        return work_packed(work, delivery);
                      });
  const auto clear_progress = [&] {
    if (run.progress) run.progress->clear();
  };
  const Stopwatch watch;
  const auto is_output = [&](const std::string& name) {
    return std::ranges::find(run.outputs, name) != run.outputs.end();
  };
  const auto take = [&](const std::string& name, std::vector<std::uint8_t> bytes) {
    if (!run.take) throw Error(ErrorKind::Failed, run.name + ": its process sent a file that is not expected");
    run.take(name, std::move(bytes));
  };
  DeliveredFiles files;
  ItemEvents events;
  events.progress = [&](std::string_view stage, double done) {
    if (run.progress) run.progress->begin(stage, done);
  };
  events.text = [&](TextKind kind, const std::string& text) {
    clear_progress();
    if (kind == TextKind::Output) print(text);
    if (kind == TextKind::Report || kind == TextKind::Aside) print_report(text, kind == TextKind::Aside);
    if (kind == TextKind::Warning) say_warning(text);
  };
  events.named_file = [&](const std::string& name, std::uint64_t size, const ItemEvents::Read& read) {
    if (!is_output(name)) return take(name, bytes_read(size, load.memory, run.name, read));
    files.add(name, size, read);
    if (run.are_results) files.commit();
  };
  events.plots = [&](const std::string& name, std::uint64_t size, const ItemEvents::Read& read) {
    const std::vector<std::uint8_t> packed = bytes_read(size, load.memory, run.name, read);
    std::vector<std::uint8_t> bytes;
    try {
      bytes = drawn_plots(unpack_plots(packed), name, run.limits.seconds - watch.ms() / 1000);
    } catch (const Error&) {
      if (watch.ms() / 1000 < run.limits.seconds) throw;
      throw Error(ErrorKind::Failed, late_item(run.name, run.limits.seconds));
    }
    is_output(name) ? files.add(name, bytes) : take(name, std::move(bytes));
  };
  if (run.take_environment)
    events.environment = [&](std::uint64_t key, std::uint64_t size, const ItemEvents::Read& read) {
      run.take_environment(key, bytes_read(size, load.memory, run.name, read));
    };

  const std::vector<std::uint8_t> answer = process.next(std::move(events));
  files.commit();
  Unpacker unpacker(answer);
  const auto ending = unpacker.value<std::uint8_t>();
  const std::string text = unpacker.text();
  clear_progress();
  if (ending == static_cast<std::uint8_t>(Ending::Partly)) throw PartialFailure(text);
  if (ending == static_cast<std::uint8_t>(Ending::Differs)) throw Difference(text);
  const std::string result = unpacker.text();
  return {result.begin(), result.end()};
}

}  // namespace zoneplate::cli
