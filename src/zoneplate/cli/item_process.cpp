#include "zoneplate/cli/item_process.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/library.h"
#include "zoneplate/base/memory_limit.h"
#include "zoneplate/base/sandbox.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/packed.h"

namespace zoneplate::cli {

enum class ItemSender::Kind : std::uint8_t { Progress, HasRead, File, FilmFrame, Result, Failed, NeedsLibrary };

struct ItemSender::Header {
  Kind kind;
  std::int32_t frame, layer;
  std::uint64_t size;
};

namespace {

/// A process that does not end by itself when its time is up has so much longer, in seconds.
constexpr double grace = 0.5;
/// Of a message that is kept in memory: an error, a result, the name of a stage.
constexpr std::uint64_t most_kept_bytes = std::uint64_t{1} << 30;

std::string megabytes(std::uint64_t bytes) { return fmt::format("{:.6g} MB", static_cast<double>(bytes) / (1 << 20)); }

std::string late_reading(const std::string& name, const LoadLimits& limits) {
  return fmt::format("{}: takes longer to load than the limit of {:.6g} s (--max-import-seconds)", name,
                     limits.seconds);
}
std::string late_item(const ItemLimits& limits) {
  return fmt::format("{}: takes longer than the limit of {:.6g} s (--max-seconds)", limits.name, limits.seconds);
}
std::string out_of_memory(const ItemLimits& limits, const std::bad_alloc& error, bool has_read) {
  const auto* named = dynamic_cast<const OutOfMemory*>(&error);
  return fmt::format(
      "{}: {} more memory than the limit of {} (--max-memory)", limits.name,
      named ? std::string(named->what()) + " need" : std::string(has_read ? "drawing it" : "reading it") + " needs",
      megabytes(limits.load.memory));
}

}  // namespace

void ItemSender::send(Kind kind, int frame, int layer, std::span<const std::uint8_t> bytes) {
  const Header header{kind, frame, layer, bytes.size()};
  const std::lock_guard lock(mutex_);
  pipe_.write(&header, sizeof header);
  pipe_.write(bytes.data(), bytes.size());
}

void ItemSender::progress(std::string_view stage, double done) {
  send(Kind::Progress, static_cast<int>(done * 1000), 0,
       {reinterpret_cast<const std::uint8_t*>(stage.data()), stage.size()});
}

void ItemSender::has_read() {
  has_read_ = true;
  send(Kind::HasRead, 0, 0, {});
}

void ItemSender::file(int frame, int layer, std::span<const std::uint8_t> bytes) {
  send(Kind::File, frame, layer, bytes);
}

void ItemSender::film_frame(const Rgba8Image& image) {
  send(Kind::FilmFrame, 0, 0,
       {reinterpret_cast<const std::uint8_t*>(image.values().data()), image.values().size_bytes()});
}

ItemProcess::ItemProcess(ItemLimits limits, std::size_t jobs, Work work)
    : limits_(std::move(limits)), jobs_(jobs), work_(std::move(work)) {}

ItemProcess::~ItemProcess() = default;

void ItemProcess::check_time() const {
  const double seconds = watch_.ms() / 1000;
  if (!has_read_ && seconds > limits_.load.seconds + grace)
    throw Error(Trouble::Input, late_reading(limits_.name, limits_.load));
  if (seconds > limits_.seconds + grace) throw Error(Trouble::Failed, late_item(limits_));
}

void ItemProcess::start(std::size_t first) {
  LimitedChild::Limits limits;
  limits.memory = limits_.load.memory;
  limits.seconds = std::numeric_limits<double>::infinity();  // the wall clock is watched here
  limits.options = "--max-memory, --max-seconds";
  limits.check_time = [this] { check_time(); };
  limits.is_sandboxed = limits_.is_sandboxed;
  limits.readable = limits_.readable;
  limits.worker = "its process";
  child_ = std::make_unique<LimitedChild>(limits_.name, limits,
                                          [this, first](ChildAnswer& answer) { work_on(first, answer); });
}

/// In the child. The first job that fails ends the process, so that every job begins in a sound one.
void ItemProcess::work_on(std::size_t first, ChildAnswer& answer) {
  using Kind = ItemSender::Kind;
  ItemSender sender(answer);
  const auto fail = [&](Trouble trouble, const std::string& message) {
    sender.send(Kind::Failed, static_cast<int>(trouble), 0,
                {reinterpret_cast<const std::uint8_t*>(message.data()), message.size()});
  };
  for (std::size_t job = first; job < jobs_; ++job) {
    sender.has_read_ = false;
    try {
      std::vector<std::uint8_t> result;
      with_deadline(limits_.seconds, Trouble::Failed, late_item(limits_), [&] { result = work_(job, sender); });
      sender.send(Kind::Result, 0, 0, result);
      continue;
    } catch (const LibraryNeeded& needed) {
      const std::string message = needed.what();
      sender.send(Kind::NeedsLibrary, static_cast<int>(needed.library()), 0,
                  {reinterpret_cast<const std::uint8_t*>(message.data()), message.size()});
    } catch (const Error& error) {
      fail(error.trouble(), error.what());
    } catch (const std::bad_alloc& error) {
      fail(sender.has_read_ ? Trouble::Failed : Trouble::Input, out_of_memory(limits_, error, sender.has_read_));
    } catch (const std::exception& error) {
      fail(Trouble::Failed, limits_.name + ": " + error.what());
    }
    return;
  }
}

/// What goes wrong while the model is read is a trouble of the input; later, of rendering.
void ItemProcess::read(std::span<std::uint8_t> out) {
  try {
    child_->read(out.data(), out.size());
  } catch (const Error& error) {
    if (has_read_ && error.trouble() == Trouble::Input) throw Error(Trouble::Failed, error.what());
    throw;
  }
}

std::optional<std::vector<std::uint8_t>> ItemProcess::receive(const ItemEvents& events) {
  using Kind = ItemSender::Kind;
  ItemSender::Header header;
  read({reinterpret_cast<std::uint8_t*>(&header), sizeof header});
  std::uint64_t left = header.size;
  const ItemEvents::Read read_part = [&](std::span<std::uint8_t> out) {
    if (out.size() > left) throw Error(Trouble::Failed, limits_.name + ": its process sent less than it announced");
    read(out);
    left -= out.size();
  };
  const auto kept = [&] {
    if (left > most_kept_bytes) throw Error(Trouble::Failed, limits_.name + ": its process sent too much");
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(left));
    read_part(bytes);
    return bytes;
  };
  const auto text = [&] {
    const std::vector<std::uint8_t> bytes = kept();
    return std::string(bytes.begin(), bytes.end());
  };
  switch (header.kind) {
    case Kind::Progress:
      if (const std::string stage = text(); events.progress) events.progress(stage, header.frame / 1000.0);
      return std::nullopt;
    case Kind::HasRead:
      has_read_ = true;
      return std::nullopt;
    case Kind::File:
      if (events.file) events.file(header.frame, header.layer, header.size, read_part);
      return std::nullopt;
    case Kind::FilmFrame:
      if (events.film_frame) events.film_frame(header.size, read_part);
      return std::nullopt;
    case Kind::Result:
      return kept();
    case Kind::Failed:
      throw Error(header.frame >= 0 && header.frame <= static_cast<int>(Trouble::Output)
                      ? static_cast<Trouble>(header.frame)
                      : Trouble::Failed,
                  text());
    case Kind::NeedsLibrary: {
      const std::string message = text();
      if (header.frame < 0 || header.frame > static_cast<int>(Library::OpenExr) ||
          !open_library(static_cast<Library>(header.frame)))
        throw Error(Trouble::Input, message);
      child_.reset();
      start(next_ - 1);
      return std::nullopt;
    }
  }
  throw Error(Trouble::Failed, limits_.name + ": its process sent what is no message");
}

std::vector<std::uint8_t> ItemProcess::next(const ItemEvents& events) {
  const std::size_t job = next_++;
  watch_ = Stopwatch();
  has_read_ = false;
  try {
    if (!child_) start(job);
    for (;;)
      if (std::optional<std::vector<std::uint8_t>> result = receive(events)) return std::move(*result);
  } catch (...) {
    child_.reset();
    throw;
  }
}

void within_import_time(const std::string& name, const LoadLimits& limits, const std::function<void()>& read) {
  with_deadline(limits.seconds, Trouble::Input, late_reading(name, limits), read);
}

bool wants_sandbox(bool is_asked_for) {
  if (!is_asked_for) return false;
  static const bool is_there = [] {
    const bool filters = sandbox_support().filters_calls;
    if (!filters) say_warning("this system has no seccomp filters: models are read with all rights of the user");
    return filters;
  }();
  return is_there;
}

}  // namespace zoneplate::cli
