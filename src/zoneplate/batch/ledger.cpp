// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/ledger.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <thread>

#include "zoneplate/base/clock.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/sha256.h"
#include "zoneplate/batch/program_name.h"
#include "zoneplate/formats/json/json.h"
#include "zoneplate/os/file.h"
#include "zoneplate/report/report_version.h"

namespace zoneplate {
namespace {

constexpr const char* ledger_format = "zoneplate-ledger";

[[noreturn]] void refuse(const std::string& path, int error) {
  throw Error(ErrorKind::Output, fmt::format("{}: cannot be written: {}", path, std::strerror(error)));
}

std::string pin_path(const std::string& ledger) { return ledger + "/batch.json"; }
std::string shard_path(const std::string& ledger, std::uint64_t shard) {
  return fmt::format("{}/shard-{}.jsonl", ledger, shard);
}

std::span<const std::uint8_t> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

bool exists(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

void add_record(const JsonView& line, LedgerRecords& records) {
  constexpr auto whole = std::uint64_t{0};
  if (line.has("file"))
    records.files[line.text("file")] = {.item = line.whole("item", whole),
                                        .bytes = line.whole("bytes", whole),
                                        .sha256 = line.text("sha256"),
                                        .job = line.text("job"),
                                        .program = line.text("program")};
  else if (line.has("status"))
    records.results[line.whole("item", whole)] = {
        .is_done = line.text("status") != "failed", .error = line.text("error"), .frames = line.whole("frames", whole)};
}

bool is_empty(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::file_size(path, ignored) == 0;
}

void check_pin(const std::string& path, const BatchPin& found, const BatchPin& batch) {
  const auto differ = [&](const std::string& what) {
    throw Error(ErrorKind::Usage, fmt::format("{}: {}: give another folder for --ledger", path, what));
  };
  if (found.shards != batch.shards)
    differ(fmt::format("the batch was begun with {} shards, and this is one of {}", found.shards, batch.shards));
  if (found.items != batch.items)
    differ(fmt::format("the batch was begun with {} items, and these are {}", found.items, batch.items));
  if (found.jobs != batch.jobs)
    differ(fmt::format("the batch was begun with other items (digest {}, and these have {})", found.jobs, batch.jobs));
}

// Creates a file with its whole contents, unless there is one of this name: false then.
bool create_whole(const std::string& path, const std::string& text) {
  const std::filesystem::path place(path);
  const std::string draft =
      (place.parent_path() / fmt::format(".{}.{}.tmp", place.filename().string(), ::getpid())).string();
  save_bytes(draft, bytes_of(text));
  const int result = ::link(draft.c_str(), path.c_str()), error = errno;
  ::unlink(draft.c_str());
  if (result == 0) return true;
  if (error == EEXIST) return false;
  // File systems without hard links: whoever creates the file writes it at once.
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0 && errno == EEXIST) return false;
  if (file < 0) refuse(path, errno);
  const int trouble = write_fully(file, bytes_of(text));
  ::close(file);
  if (trouble != 0) refuse(path, trouble);
  return true;
}

}  // namespace

std::optional<BatchPin> find_pin(const std::string& ledger, const LoadLimits& limits) {
  const std::string path = pin_path(ledger);
  if (!exists(path)) return std::nullopt;
  // Without hard links the file is empty for a moment (create_whole), or for ever, if its process was killed then.
  for (const Stopwatch waited; is_empty(path) && waited.ms() < 2000;)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  if (is_empty(path)) return std::nullopt;
  constexpr std::uint64_t max_bytes = 1 << 16;
  const FileBytes file(path, max_bytes);
  ImportBudget budget(path, limits);
  const JsonValue value = parse_json(file.bytes(), budget);
  const JsonView view(value, path);
  if (view.text("format") != ledger_format) view.fail("is not the pin of a batch");
  return BatchPin{.shards = view.whole("shards"), .items = view.whole("items"), .jobs = view.text("jobs")};
}

void pin(const std::string& ledger, const BatchPin& batch, const LoadLimits& limits) {
  std::error_code error;
  std::filesystem::create_directories(ledger, error);
  if (error) throw Error(ErrorKind::Output, fmt::format("{}: {}", ledger, error.message()));
  const std::string path = pin_path(ledger);
  const std::string text = Json(Json::Object{{"format", ledger_format},
                                             {"version", report_version},
                                             {"shards", batch.shards},
                                             {"items", batch.items},
                                             {"jobs", batch.jobs}})
                               .text() +
                           '\n';
  if (!exists(path) && create_whole(path, text)) return;
  if (const std::optional<BatchPin> found = find_pin(ledger, limits)) return check_pin(path, *found, batch);
  save_bytes(path, bytes_of(text));
}

LedgerRecords read_records(const std::string& ledger, std::uint64_t shard, const LoadLimits& limits) {
  LedgerRecords records;
  const std::string path = shard_path(ledger, shard);
  if (!exists(path)) return records;
  std::string line;
  const auto end_line = [&] {
    try {
      ImportBudget budget(path, limits);
      const JsonValue value = parse_json(bytes_of(line), budget);
      add_record(JsonView(value, path), records);
    } catch (const Error&) {  // empty, cut off by the end of its process, or not ours
    }
    line.clear();
  };
  read_parts(path, [&](std::span<const std::uint8_t> part) {
    std::string_view text(reinterpret_cast<const char*>(part.data()), part.size());
    for (std::size_t end = text.find('\n'); end != text.npos; end = text.find('\n')) {
      line += text.substr(0, end);
      end_line();
      text.remove_prefix(end + 1);
    }
    line += text;
    return true;
  });
  end_line();
  return records;
}

std::string file_digest(const std::string& path) {
  Sha256 digest;
  read_parts(path, [&](std::span<const std::uint8_t> part) {
    digest.add(part);
    return true;
  });
  return digest.hex();
}

Ledger::Ledger(const std::string& folder, std::uint64_t shard, const BatchPin& batch, const LoadLimits& limits,
               Access access)
    : path_(shard_path(folder, shard)) {
  if (access == Access::Write)
    pin(folder, batch, limits);
  else if (const std::optional<BatchPin> found = find_pin(folder, limits))
    check_pin(pin_path(folder), *found, batch);
  records_ = read_records(folder, shard, limits);
  if (access == Access::Read) return;
  file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) refuse(path_, errno);
  // A line that was cut off ends here.
  char last = '\n';
  const off_t size = ::lseek(file_, 0, SEEK_END);
  if (size > 0 && ::pread(file_, &last, 1, size - 1) == 1 && last != '\n')
    if (const int error = write_fully(file_, bytes_of("\n")); error != 0) refuse(path_, error);
}

Ledger::~Ledger() {
  if (file_ >= 0) ::close(file_);
}

bool Ledger::has_whole(const std::string& path, const std::string& job) const {
  const auto found = records_.files.find(path);
  if (found == records_.files.end()) return false;
  const RecordedFile& record = found->second;
  std::error_code error;
  if (record.job != job || record.program != program_name()) return false;
  if (!std::filesystem::is_regular_file(path, error) || std::filesystem::file_size(path, error) != record.bytes)
    return false;
  try {
    return file_digest(path) == record.sha256;
  } catch (const Error&) {  // without permission to read it, for example
    return false;
  }
}

void Ledger::add_file(const std::string& path, const RecordedFile& file) {
  add({{"file", path},
       {"item", file.item},
       {"bytes", file.bytes},
       {"sha256", file.sha256},
       {"job", file.job},
       {"program", file.program}});
  records_.files[path] = file;
}

void Ledger::add(Json::Object line) {
  if (const int error = write_fully(file_, bytes_of(Json(std::move(line)).text() + '\n')); error != 0)
    refuse(path_, error);
}

}  // namespace zoneplate
