// SPDX-License-Identifier: Apache-2.0
// zoneplate verify: whether the files of a batch are there, as they were written, of this program and of these options.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/batch/item_files.h"
#include "zoneplate/batch/ledger.h"
#include "zoneplate/batch/program_name.h"
#include "zoneplate/cli/confined.h"
#include "zoneplate/cli/render/batch_items.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/job/picture.h"
#include "zoneplate/report/report_version.h"

namespace zoneplate::cli {
namespace {

namespace fs = std::filesystem;

/// What is wrong with a file of an item, or with the item if there is no file.
struct Fault {
  std::string file, status, cause = {};
};

/// An item to be examined; `invalid` is the error of its arguments.
struct Subject {
  RenderArgs args;
  std::string name, invalid = {};
  std::vector<Fault> faults = {};
};

/// The records of all shards that are looked at.
class Records {
 public:
  Records(const RenderArgs& common, std::uint64_t shards) {
    if (common.ledger.empty()) return;
    for (std::uint64_t shard = 0; shard < shards; ++shard)
      if (common.shard.count == 1 || shard == common.shard.index)
        all_.merge(read_records(common.ledger, shard, common.load.limits));
  }

  const RecordedFile* find(const std::string& file) const {
    const auto found = all_.files.find(file);
    return found == all_.files.end() ? nullptr : &found->second;
  }
  const LedgerRecords::Result* result(std::uint64_t item) const {
    const auto found = all_.results.find(item);
    return found == all_.results.end() ? nullptr : &found->second;
  }

 private:
  LedgerRecords all_;
};

std::vector<std::string> files_of(const RenderArgs& args, const Records& records) {
  std::vector<std::string> out;
  const auto add = [&](std::int64_t frame) {
    for (int layer = -1; layer < static_cast<int>(args.aovs.size()); ++layer)
      if (std::string path = output_path(args, static_cast<int>(frame), layer); out.empty() || path != out.back())
        out.push_back(std::move(path));
  };
  if (!args.frame_place) {
    add(0);
  } else if (const std::optional<std::int64_t> last = args.sequence.last_frame()) {
    for (std::int64_t frame = args.sequence.first_frame(); frame <= *last; frame += args.sequence.jump) add(frame);
  } else if (const auto* result = records.result(args.number); result != nullptr && result->is_done) {
    for (std::uint64_t i = 0; i < result->frames; ++i)
      add(args.sequence.first_frame() + static_cast<std::int64_t>(i) * args.sequence.jump);
  } else {
    out.push_back(args.output);
  }
  return out;
}

/// The fault of a file; nothing if it is as it should be.
std::optional<Fault> fault_of(const RenderArgs& args, const std::string& file, const std::string& job,
                              const Records& records) {
  std::error_code error;
  const RecordedFile* const record = records.find(file);
  if (!fs::is_regular_file(file, error)) {
    const auto* result = records.result(args.number);
    if (result != nullptr && !result->is_done) return Fault{file, "failed", result->error};
    return Fault{file, "missing"};
  }
  if (record == nullptr) {
    if (!can_be_whole(args, file)) return Fault{file, "truncated"};
    return args.ledger.empty() ? std::nullopt : std::optional(Fault{file, "unrecorded"});
  }
  const std::uint64_t size = fs::file_size(file, error);
  if (size < record->bytes && !can_be_whole(args, file))
    return Fault{file, "truncated", fmt::format("{} bytes of {} are there", size, record->bytes)};
  if (size != record->bytes || file_digest(file) != record->sha256)
    return Fault{file, "damaged", "the bytes are not those that were written"};
  if (record->program != program_name()) return Fault{file, "other-program", "made by " + record->program};
  if (record->job != job)
    return Fault{file, "other-options", fmt::format("made with the options of digest {}, not {}", record->job, job)};
  return std::nullopt;
}

void examine(Subject& subject, const Records& records) {
  if (!subject.invalid.empty()) return subject.faults.push_back({subject.name, "failed", subject.invalid});
  const std::string job = job_digest(subject.args);
  for (const std::string& file : files_of(subject.args, records)) try {
      if (std::optional<Fault> fault = fault_of(subject.args, file, job, records))
        subject.faults.push_back(std::move(*fault));
    } catch (const Error& error) {
      subject.faults.push_back({file, "unreadable", error.what()});
    }
}

/// Whether a file has the name of a temporary file of FileWriter (os/file.h), which a killed process leaves.
bool is_leftover(const std::string& name) {
  constexpr std::string_view ending = ".tmp";
  if (!name.starts_with('.') || !name.ends_with(ending)) return false;
  const std::string stem = name.substr(0, name.size() - ending.size());
  const std::size_t dot = stem.find_last_not_of("0123456789");
  return dot != stem.npos && dot > 0 && stem[dot] == '.' && dot + 1 < stem.size();
}

std::vector<std::string> leftovers_in(const std::set<std::string>& folders) {
  std::vector<std::string> out;
  for (const std::string& folder : folders) {
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
      if (is_leftover(entry->path().filename().string())) out.push_back(entry->path().string());
  }
  std::ranges::sort(out);
  return out;
}

/// The folder of an item's files, up to one whose name has the number of a frame.
std::string folder_of(const RenderArgs& args) {
  const fs::path folder = fs::path(args.output.substr(0, folder_end(args))).parent_path();
  return folder.empty() ? "." : folder.string();
}

/// Whether the number of a frame is in the name of a folder.
bool has_frame_folders(const RenderArgs& args) {
  return args.frame_place && args.output.find('/', args.frame_place->begin) != args.output.npos;
}

void add_folders_below(const std::string& folder, std::set<std::string>& folders) {
  std::error_code error;
  for (fs::recursive_directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (entry->is_directory(error)) folders.insert(entry->path().string());
}

class Verification {
 public:
  Verification(const RenderArgs& common, bool prints_text)
      : common_(common), items_(common), prints_text_(prints_text) {
    const std::optional<BatchPin> pinned =
        common.ledger.empty() ? std::nullopt : find_pin(common.ledger, common.load.limits);
    if (!common.ledger.empty() && !pinned)
      throw Error(ErrorKind::Input, common.ledger + ": is not the ledger of a batch: it has no batch.json");
    shards_ = pinned ? pinned->shards : common.shard.count;
    if (!pinned) return;
    BatchPin own = items_.pin();
    own.shards = shards_;
    pin(common.ledger, own, common.load.limits);
  }

  /// The folders of all outputs, and the ledger.
  std::set<std::string> folders() {
    std::set<std::string> out, of_frame_folders;
    for_subjects([&](Subject& subject) {
      if (!subject.invalid.empty()) return;
      out.insert(folder_of(subject.args));
      if (has_frame_folders(subject.args)) of_frame_folders.insert(folder_of(subject.args));
    });
    for (const std::string& folder : of_frame_folders) add_folders_below(folder, out);
    if (!common_.ledger.empty()) out.insert(common_.ledger);
    return out;
  }

  /// Reports all faults, and these leftovers. The message about the faults; empty if there are none.
  std::string examine_all(const std::vector<std::string>& leftovers, Delivery& out) {
    const Records records(common_, shards_);
    std::vector<Subject> subjects;
    const auto examine_some = [&] {
      parallel_for(subjects.size(), [&](std::size_t i) { examine(subjects[i], records); });
      for (const Subject& subject : subjects) report(subject, out);
      subjects.clear();
    };
    for_subjects([&](Subject& subject) {
      constexpr std::size_t max_together = 256;
      subjects.push_back(std::move(subject));
      if (subjects.size() == max_together) examine_some();
    });
    examine_some();
    return conclude(leftovers, out);
  }

 private:
  template <class Use>
  void for_subjects(const Use& use) {
    for (std::uint64_t i = 0; i < items_.count(); ++i) {
      if (!common_.shard.has(i)) continue;
      Subject subject{.args = {}, .name = items_.name(i)};
      try {
        subject.args = items_.args(i);
      } catch (const Error& error) {
        subject.invalid = error.what();
      }
      subject.args.number = i;
      use(subject);
    }
  }

  void report(const Subject& subject, Delivery& out) {
    ++count_;
    if (subject.faults.empty()) return;
    ++faulty_;
    faulty_shards_.insert(subject.args.number % shards_);
    for (const Fault& fault : subject.faults) {
      const std::uint64_t shard = subject.args.number % shards_;
      if (prints_text_) {
        print(out, fmt::format("{}: {}{}{}", fault.file, fault.status, fault.cause.empty() ? "" : ": ", fault.cause));
        continue;
      }
      Json::Object line{{"format", "zoneplate-verify"},
                        {"version", report_version},
                        {"item", subject.args.number},
                        {"input", subject.name},
                        {"output", fault.file},
                        {"status", fault.status},
                        {"shard", shard}};
      if (!fault.cause.empty()) line.emplace_back("cause", fault.cause);
      print(out, Json(std::move(line)).text());
    }
  }

  std::string conclude(const std::vector<std::string>& leftovers, Delivery& out) {
    const std::vector<std::uint64_t> shards(faulty_shards_.begin(), faulty_shards_.end());
    const std::string array = array_of(shards);
    const std::string advice = shards.empty() ? "" : "; resubmit --array=" + array;
    for (const std::string& file : leftovers)
      if (prints_text_) print(out, file + ": left by a process that was killed");
    if (prints_text_)
      print(out, fmt::format("{} of {} items are as they were written{}", count_ - faulty_, count_, advice));
    else
      print(out, Json(Json::Object{{"format", "zoneplate-verify"},
                                   {"version", report_version},
                                   {"items", count_},
                                   {"faulty", faulty_},
                                   {"shards", shards_},
                                   {"faulty_shards", Json::Array(shards.begin(), shards.end())},
                                   {"array", array},
                                   {"array_from_1", array_of(shards, 1)},
                                   {"leftovers", Json::Array(leftovers.begin(), leftovers.end())}})
                     .text());
    if (faulty_ == 0) return "";
    return fmt::format("{} of {} items are faulty{}", faulty_, count_, advice);
  }

  void print(Delivery& out, const std::string& line) const {
    if (common_.verbosity != Verbosity::Quiet) out.print_report(line + '\n');
  }

  const RenderArgs& common_;
  BatchItems items_;
  const bool prints_text_;
  std::uint64_t shards_ = 1, count_ = 0, faulty_ = 0;
  std::set<std::uint64_t> faulty_shards_;
};

constexpr const char* verify_examples =
    "  zoneplate verify jobs.jsonl --size 512 --ledger out/ledger\n"
    "  zoneplate verify models/ -o thumbs/ --size 512 --ledger thumbs/ledger --json\n";

constexpr const char* verify_notes =
    "IN, OUT and the options are those of the batch (zoneplate render); a single IN that ends with .jsonl is its\n"
    "manifest. Each file that is not as it should be gives one line with its status: missing, failed, truncated,\n"
    "damaged (other bytes than were written), unrecorded, other-program (made by another version) or other-options.\n"
    "Without --ledger only missing and truncated files are found. --shard looks at one shard alone. The last line has\n"
    "the specification of the array that makes the faulty shards again, for the same command; Grid Engine and LSF "
    "count\n"
    "tasks from 1: add 1 to each (array_from_1 of --json).\n"
    "\n"
    "Exit codes: 0 all files are right, 2 wrong usage, 3 input missing or corrupt, 5 some files are not.\n";

}  // namespace

void run_verify(std::span<const std::string> arguments) {
  bool removes_leftovers = false;
  const std::optional<RenderArgs> args = parse_render_args(arguments, [&](Syntax& syntax) {
    syntax.verb = "verify", syntax.summary = "Check the files of a batch, and name those that must be made again";
    syntax.operands = "MANIFEST | IN... -o OUT", syntax.examples = verify_examples, syntax.notes = verify_notes;
    syntax.options.push_back({"--remove-leftovers", "",
                              "Remove temporary files of processes that were killed; no batch may be running",
                              "Batches", false, [&](auto&) { removes_leftovers = true; }});
  });
  if (!args) return;
  Verification verification(*args, ::isatty(STDOUT_FILENO) == 1 && !args->prints_json);
  const std::set<std::string> folders = verification.folders();
  const std::vector<std::string> leftovers = leftovers_in(folders);
  std::vector<std::string> readable(folders.begin(), folders.end());
  ConfinedRun run{.name = args->manifest.empty() ? "verify" : args->manifest,
                  .limits = {args->load.limits, args->max_seconds, args->is_sandboxed},
                  .readable = std::move(readable),
                  .outputs = {}};
  std::vector<std::uint8_t> answer;
  with_threads(args->threads, [&] {
    answer = run_confined(run, [&](Delivery& out) {
      const std::string failure = verification.examine_all(leftovers, out);
      out.set_result({failure.begin(), failure.end()});
    });
  });
  if (removes_leftovers)
    for (const std::string& file : leftovers) ::unlink(file.c_str());
  const std::string failure(answer.begin(), answer.end());
  if (!failure.empty()) throw PartialFailure(failure);
}

}  // namespace zoneplate::cli
