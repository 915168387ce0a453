// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/process/item_process.h"

#include <fmt/format.h>

#include <atomic>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/job/import_time.h"
#include "zoneplate/os/library.h"
#include "zoneplate/os/memory_limit.h"
#include "zoneplate/os/sandbox.h"

namespace zoneplate {

namespace {

/// Seconds after the time limit at which a process that has not ended is killed.
constexpr double grace = 0.5;

/// `limit` is memory_limit_text of the limits.
std::string out_of_memory(const std::string& name, const ItemLimits& limits, const std::string& limit,
                          const std::bad_alloc& error, bool has_read) {
  const auto* named = dynamic_cast<const OutOfMemory*>(&error);
  return fmt::format(
      "{}: {} more memory than the limit of {}", name,
      named ? std::string(named->what()) + " need" : std::string(has_read ? limits.work : "reading it") + " needs",
      limit);
}

}  // namespace

std::string late_item(const std::string& name, double seconds) {
  return fmt::format("{}: takes longer than the limit of {:.6g} s (--max-seconds)", name, seconds);
}

ItemProcess::ItemProcess(ItemLimits limits, std::size_t jobs, Work work)
    : limits_(std::move(limits)), jobs_(jobs), work_(std::move(work)) {}

ItemProcess::~ItemProcess() = default;

void ItemProcess::check_time() const {
  if (!has_read_ && reading_.ms() / 1000 > limits_.load.seconds + grace)
    throw ItemError(ErrorKind::Input, late_reading(input_, limits_.load), ItemCause::Time);
  if (watch_.ms() / 1000 > limits_.seconds + grace)
    throw ItemError(ErrorKind::Failed, late_item(limits_.name, limits_.seconds), ItemCause::Time);
}

void ItemProcess::start(std::size_t first) {
  LimitedChild::Limits limits;
  limits.memory = limits_.load.memory;
  limits.seconds = std::numeric_limits<double>::infinity();  // the parent measures the elapsed time instead
  limits.options = "--max-memory, --max-seconds";
  memory_limit_ = memory_limit_text(limits_.load.memory, "--max-memory");
  limits.check_time = [this] { check_time(); };
  limits.is_sandboxed = limits_.is_sandboxed;
  limits.readable = limits_.readable;
  limits.worker = "its process";
  limits.ignores_termination = limits_.ignores_termination;
  limits.siblings = limits_.siblings;
  child_ = std::make_unique<LimitedChild>(
      limits_.name, limits, [this, first](ChildAnswer& answer) { work_on(first, answer); }, limits_.open);
}

void ItemProcess::start_ahead() noexcept {
  try {
    start(0);
  } catch (const std::exception&) {
  }
}

/// Runs in the child. The first failing job ends the process, so that no job starts in a damaged one.
void ItemProcess::work_on(std::size_t first, ChildAnswer& answer) {
  ItemSender sender([&](std::span<const std::uint8_t> bytes) { answer.write(bytes.data(), bytes.size()); });
  for (std::size_t job = first; job < jobs_; ++job) {
    sender.begin_job();
    try {
      std::vector<std::uint8_t> result;
      with_deadline(limits_.seconds, ErrorKind::Failed, late_item(limits_.name, limits_.seconds),
                    [&] { result = work_(job, sender); });
      sender.result(result);
      continue;
    } catch (const LibraryNeeded& needed) {
      sender.needs_library(needed.library(), needed.what());
    } catch (const Error& error) {
      // Errors after reading and rendering errors do not contain the model's name.
      const std::string message = error.what();
      const bool needs_name = sender.is_past_reading() || error.kind() == ErrorKind::Failed;
      const bool is_named = !limits_.names_errors || !needs_name || message.find(limits_.name) != message.npos;
      const bool is_late = dynamic_cast<const DeadlinePassed*>(&error) != nullptr;
      const bool is_killed = dynamic_cast<const ChildEnded*>(&error) != nullptr;  // a process of a library
      sender.failure(error.kind(), is_named ? message : limits_.name + ": " + message,
                     is_late     ? ItemCause::Time
                     : is_killed ? ItemCause::Killed
                                 : ItemCause::Other);
    } catch (const std::bad_alloc& error) {
      sender.failure(sender.is_past_reading() ? ErrorKind::Failed : ErrorKind::Input,
                     out_of_memory(sender.input().empty() ? limits_.name : sender.input(), limits_, memory_limit_,
                                   error, sender.is_past_reading()),
                     ItemCause::Memory);
    } catch (const std::exception& error) {
      sender.failure(ErrorKind::Failed, limits_.name + ": " + error.what());
    }
    return;
  }
}

/// A failure of the process while the model is read is an error of the input; later it is an error of rendering.
void ItemProcess::read(std::span<std::uint8_t> out) {
  try {
    child_->read(out.data(), out.size());
  } catch (const ItemError&) {
    throw;
  } catch (const Error& error) {
    const bool is_killed = dynamic_cast<const ChildEnded*>(&error) != nullptr;
    throw ItemError(has_read_ && error.kind() == ErrorKind::Input ? ErrorKind::Failed : error.kind(), error.what(),
                    is_killed ? ItemCause::Killed : ItemCause::Other);
  }
}

void ItemProcess::begin_again_with(Library library, const std::string& message) {
  if (!open_library(library)) throw Error(ErrorKind::Input, message);
  child_.reset();
  start(next_ - 1);
}

std::vector<std::uint8_t> ItemProcess::next(ItemEvents events) {
  const std::size_t job = next_++;
  watch_ = reading_ = Stopwatch();
  has_read_ = false;
  input_ = limits_.name;
  std::optional<std::pair<Library, std::string>> needed;
  events.has_read = [&] { has_read_ = true; };
  events.begins_to_read = [&](const std::string& input) {
    has_read_ = false, reading_ = Stopwatch();
    input_ = input.empty() ? limits_.name : input;
  };
  events.needs_library = [&](Library library, const std::string& message) { needed.emplace(library, message); };
  try {
    if (!child_) start(job);
    for (;;) {
      std::optional<std::vector<std::uint8_t>> result =
          receive_message(limits_.name, events, [&](std::span<std::uint8_t> out) { read(out); });
      if (result) return std::move(*result);
      if (needed) begin_again_with(needed->first, needed->second), needed.reset();
    }
  } catch (...) {
    child_.reset();
    throw;
  }
}

bool uses_sandbox(bool is_requested, const std::function<void(const std::string&)>& warn) {
  if (!is_requested) return false;
  static std::atomic<bool> has_warned = false;
  const SandboxLacks& lacks = sandbox_lacks();
  if ((lacks.filter.empty() && lacks.files.empty()) || has_warned.exchange(true)) return true;
  // The parts that are there still apply.
  warn(fmt::format(
      "the sandbox is incomplete: {}{}{}; a hostile model could {} with your rights (--no-sandbox omits this warning)",
      lacks.filter.empty() ? "" : "no filter of system calls (seccomp: " + lacks.filter + ")",
      lacks.filter.empty() || lacks.files.empty() ? "" : ", ",
      lacks.files.empty() ? "" : "no confinement to the model's files (Landlock: " + lacks.files + ")",
      lacks.filter.empty() ? "read files" : "act"));
  return true;
}

}  // namespace zoneplate
