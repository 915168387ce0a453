// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "zoneplate/batch/shard.h"
#include "zoneplate/formats/import/load_options.h"
#include "zoneplate/report/json.h"

namespace zoneplate {

// The ledger of a batch is a folder: batch.json, which pins the shards, and shard-N.jsonl, which only shard N writes. A
// line of the latter is written by one call after the file that it records has its name, so that each process may be
// killed at any moment: a line that was cut off is ignored, and its file is unrecorded.

/// What all shards of a batch agree about.
struct BatchPin {
  std::uint64_t shards = 1, items = 0;
  std::string jobs = {};  ///< digest of the list of items
};

/// The pin of a ledger; nothing if it has none yet.
///
/// Errors    ErrorKind::Input naming the file if it is no pin.
std::optional<BatchPin> find_pin(const std::string& ledger, const LoadLimits& limits);

/// Makes the folder and its pin, if there is none.
///
/// Errors    ErrorKind::Usage naming both numbers if there is another one; ErrorKind::Output.
void pin(const std::string& ledger, const BatchPin& batch, const LoadLimits& limits);

/// A file that an item wrote.
struct RecordedFile {
  std::uint64_t item = 0, bytes = 0;
  std::string sha256;
  std::string job;      ///< digest of the options that determine it
  std::string program;  ///< that made it: program_name (program_name.h)
};

/// What a ledger says, by the names of files and the numbers of items; the last line about each counts.
struct LedgerRecords {
  struct Result {
    bool is_done = false;
    std::string error = {};    ///< of an item that failed
    std::uint64_t frames = 0;  ///< of a sequence
  };
  std::unordered_map<std::string, RecordedFile> files;
  std::unordered_map<std::uint64_t, Result> results;

  /// Adds the records of another shard.
  void merge(LedgerRecords other) { files.merge(other.files), results.merge(other.results); }
};

/// Reads the records of one shard; none if it has written none. Lines that are no records are ignored.
LedgerRecords read_records(const std::string& ledger, std::uint64_t shard, const LoadLimits& limits);

/// The digest of a file.
///
/// Errors    ErrorKind::Input if it cannot be read.
std::string file_digest(const std::string& path);

/// The ledger of one shard, to which its process adds records.
class Ledger {
 public:
  /// What is read is not made: the folder, its pin and the shard's file may be missing.
  enum class Access { Read, Write };
  /// Errors    those of `pin`; ErrorKind::Output if the shard's file cannot be opened.
  Ledger(const std::string& folder, std::uint64_t shard, const BatchPin& batch, const LoadLimits& limits,
         Access access = Access::Write);
  ~Ledger();
  Ledger(const Ledger&) = delete;
  Ledger& operator=(const Ledger&) = delete;

  /// Whether the file is recorded as made by this program for that job, and still has those bytes.
  bool has_whole(const std::string& path, const std::string& job) const;

  /// Errors    ErrorKind::Output.
  void add_file(const std::string& path, const RecordedFile& file);
  void add_result(Json::Object result) { add(std::move(result)); }

 private:
  void add(Json::Object line);

  std::string path_;
  int file_ = -1;
  LedgerRecords records_;
};

}  // namespace zoneplate
