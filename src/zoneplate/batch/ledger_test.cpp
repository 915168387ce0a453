// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/batch/ledger.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "zoneplate/base/error.h"
#include "zoneplate/base/sha256.h"
#include "zoneplate/batch/program_name.h"
#include "zoneplate/os/program_for_test.h"

namespace zoneplate {
namespace {

class Ledgers : public ProgramTest {
 protected:
  std::string folder() const { return (place / "ledger").string(); }
  /// Writes a file and gives its record.
  RecordedFile write(const std::string& name, const std::string& text) const {
    std::ofstream(place / name, std::ios::binary) << text;
    return {.item = 3, .bytes = text.size(), .sha256 = sha256_of(text), .job = "job", .program = program_name()};
  }
  std::string refusal(const BatchPin& batch) const {
    try {
      pin(folder(), batch, {});
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Usage);
      return error.what();
    }
    return "";
  }
};

TEST_F(Ledgers, PinOneBatch) {
  EXPECT_FALSE(find_pin(folder(), {}));
  EXPECT_EQ(refusal({8, 100, "abc"}), "");
  EXPECT_EQ(refusal({8, 100, "abc"}), "");
  EXPECT_NE(refusal({10, 100, "abc"}).find("begun with 8 shards, and this is one of 10"), std::string::npos);
  EXPECT_NE(refusal({8, 99, "abc"}).find("begun with 100 items, and these are 99"), std::string::npos);
  EXPECT_NE(refusal({8, 100, "abd"}).find("digest abc, and these have abd"), std::string::npos);
  const std::optional<BatchPin> found = find_pin(folder(), {});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->shards, 8u);
  int files = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder())) ++files;
  EXPECT_EQ(files, 1);
}

TEST_F(Ledgers, KeepAFileOnlyAsItWasRecorded) {
  const std::string path = (place / "a.png").string();
  const RecordedFile record = write("a.png", "picture");
  {
    Ledger ledger(folder(), 0, {}, {});
    EXPECT_FALSE(ledger.has_whole(path, "job"));
    ledger.add_file(path, record);
    EXPECT_TRUE(ledger.has_whole(path, "job"));  // for an item that is tried again
  }
  const auto is_kept = [&](const std::string& job) { return Ledger(folder(), 0, {}, {}).has_whole(path, job); };
  EXPECT_TRUE(is_kept("job"));
  EXPECT_FALSE(is_kept("another"));
  for (const char* other : {"pictura", "pictur", "picture!"}) {
    write("a.png", other);
    EXPECT_FALSE(is_kept("job")) << other;
  }
  write("a.png", "picture");
  EXPECT_TRUE(is_kept("job"));
  std::filesystem::remove(path);
  EXPECT_FALSE(is_kept("job"));
}

// A process may be killed after any byte of a line.
TEST_F(Ledgers, IgnoreALineThatWasCutOffAndGoOnAfterIt) {
  const std::string shard = folder() + "/shard-0.jsonl";
  { Ledger(folder(), 0, {}, {}).add_file("a.png", write("a", "a")); }
  const std::string line = text_of(shard);
  for (std::size_t size = 0; size + 1 < line.size(); ++size) {
    std::ofstream(shard, std::ios::binary) << line << line.substr(0, size);
    { Ledger(folder(), 0, {}, {}).add_file("b.png", write("b", "b")); }
    const LedgerRecords records = read_records(folder(), 0, {});
    EXPECT_EQ(records.files.size(), 2u) << size;
    EXPECT_TRUE(records.files.contains("a.png") && records.files.contains("b.png")) << size;
  }
}

TEST_F(Ledgers, TellTheLastResultOfAnItem) {
  {
    Ledger ledger(folder(), 1, {.shards = 2}, {});
    ledger.add_result({{"item", 5}, {"status", "failed"}, {"error", "no such file"}});
    ledger.add_result({{"item", 7}, {"status", "failed"}, {"error", "late"}});
    ledger.add_result({{"item", 5}, {"status", "done"}});
  }
  const LedgerRecords records = read_records(folder(), 1, {});
  EXPECT_TRUE(records.results.at(5).is_done);
  EXPECT_FALSE(records.results.at(7).is_done);
  EXPECT_EQ(records.results.at(7).error, "late");
  EXPECT_TRUE(read_records(folder(), 0, {}).results.empty());
}

}  // namespace
}  // namespace zoneplate
