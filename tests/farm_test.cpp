// SPDX-License-Identifier: Apache-2.0
// Batches that are divided, killed, resumed and verified. Runs the built program.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/os/program_for_test.h"
#include "zoneplate/report/json_for_test.h"

namespace {

namespace fs = std::filesystem;
using zoneplate::contains;
using zoneplate::ProgramAnswer;
using zoneplate::text_of;

class Farm : public zoneplate::ProgramTest {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(place / name, std::ios::binary) << text;
  }
  /// Jobs whose images all differ.
  void write_jobs(int count, const std::string& more = "") const {
    std::string text;
    for (int i = 0; i < count; ++i)
      text += fmt::format(R"({{"input":"teapot","output":"out/{}.png","camera-azimuth-angle":{}{}}})"
                          "\n",
                          i, i * 7 % 360, more);
    write("jobs.jsonl", text);
  }
  /// Starts the program; stdout and stderr go to out.txt and err.txt.
  pid_t start(const std::string& arguments) const {
    const std::string command = "exec '" + std::string(zoneplate::program_file) + "' " + arguments;
    const pid_t child = ::fork();
    if (child != 0) return child;
    if (::chdir(place.c_str()) != 0) ::_exit(127);
    ::dup2(::open("/dev/null", O_RDONLY), STDIN_FILENO);
    ::dup2(::open("out.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
    ::dup2(::open("err.txt", O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    ::_exit(127);
  }
  /// The exit code, or 1000 and the signal.
  static int finish(pid_t child) {
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
  }
  std::vector<nlohmann::json> lines_of(const std::string& text) const {
    std::vector<nlohmann::json> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);)
      if (line.starts_with("{")) lines.push_back(zoneplate::parsed_json(line));
    return lines;
  }
  std::map<std::string, std::string> files(const std::string& folder = "out") const {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::directory_iterator(place / folder))
      if (entry.is_regular_file()) out[entry.path().filename()] = text_of(entry.path());
    return out;
  }
  /// Waits until a file is there.
  void wait_for(const std::string& name) const {
    for (int i = 0; i < 60'000 && !fs::exists(place / name); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_TRUE(fs::exists(place / name)) << name;
  }
};

constexpr const char* options = "jobs.jsonl --size 24 --aa none --ledger ledger";

TEST_F(Farm, VerifyNamesEachFaultAndTheArrayThatMendsIt) {
  constexpr int count = 60, shards = 12;
  write_jobs(count);
  const auto run_shard = [&](int shard) {
    const ProgramAnswer answer = run(fmt::format("{} --shard {}/{}", options, shard, shards));
    EXPECT_EQ(answer.code, 0) << answer.out;
    return answer.out;
  };
  for (int shard = 0; shard < shards; ++shard) run_shard(shard);
  ProgramAnswer answer = run(std::string("verify ") + options);
  EXPECT_EQ(answer.code, 0) << answer.out;
  EXPECT_EQ(lines_of(answer.out).back()["array"], "");
  const std::map<std::string, std::string> whole = files();
  ASSERT_EQ(whole.size(), 60u);

  // Items 0 to 4 are missing, 12 to 15 cut off, 24 to 27 have a flipped bit, 36 to 39 are another item's image, 48 is
  // of another program, 49 and 50 were made with other options.
  std::map<int, std::string> faults;
  const auto path = [&](int item) { return fmt::format("out/{}.png", item); };
  for (int i = 0; i < 5; ++i) fs::remove(place / path(i)), faults[i] = "missing";
  for (int i = 12; i < 16; ++i) fs::resize_file(place / path(i), 40), faults[i] = "truncated";
  for (int i = 24; i < 28; ++i) {
    std::string text = text_of(place / path(i));
    text[text.size() / 2] = static_cast<char>(text[text.size() / 2] ^ 4);
    write(path(i), text), faults[i] = "damaged";
  }
  for (int i = 36; i < 40; ++i) write(path(i), text_of(place / path(i + 8))), faults[i] = "damaged";
  std::string ledger = text_of(place / "ledger/shard-0.jsonl");
  const std::size_t line = ledger.find("out/48.png"), program = ledger.find("\"program\":\"", line) + 11;
  ledger.insert(program, "0.0.1 of ");
  write("ledger/shard-0.jsonl", ledger), faults[48] = "other-program";
  for (const int i : {49, 50}) {
    const std::string shard = fmt::format("ledger/shard-{}.jsonl", i % shards);
    ledger = text_of(place / shard);
    ledger.replace(ledger.find("\"job\":\"", ledger.find(path(i))) + 7, 4, "none");
    write(shard, ledger), faults[i] = "other-options";
  }
  ASSERT_EQ(faults.size(), 20u);

  answer = run(std::string("verify ") + options);
  EXPECT_EQ(answer.code, 5);
  std::map<int, std::string> found;
  const std::vector<nlohmann::json> lines = lines_of(answer.out);
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    found[lines[i]["item"]] = lines[i]["status"];
    EXPECT_EQ(lines[i]["output"], path(lines[i]["item"]));
  }
  EXPECT_EQ(found, faults);
  EXPECT_EQ(lines.back()["faulty"], 20);
  EXPECT_EQ(lines.back()["array"], "0-4");
  EXPECT_TRUE(contains(answer.out, "20 of 60 items are faulty; resubmit --array=0-4")) << answer.out;
  EXPECT_EQ(run(fmt::format("verify {} --shard 1/12", options)).code, 5);
  EXPECT_EQ(run(fmt::format("verify {} --shard 7/12", options)).code, 0);

  // What is whole is not made again.
  int made = 0;
  for (const nlohmann::json& shard : lines.back()["faulty_shards"])
    for (const nlohmann::json& result : lines_of(run_shard(shard))) made += result["status"] == "done";
  EXPECT_EQ(made, 20);
  answer = run(std::string("verify ") + options);
  EXPECT_EQ(answer.code, 0) << answer.out;
  EXPECT_EQ(files(), whole);
}

TEST_F(Farm, VerifyTellsOptionsAndVersionsOfWholeBatches) {
  write_jobs(3);
  ASSERT_EQ(run(options).code, 0);
  ProgramAnswer answer = run(std::string("verify ") + options + " --ambient-occlusion rays");
  EXPECT_EQ(answer.code, 5);
  for (const nlohmann::json& line : lines_of(answer.out))
    EXPECT_EQ(line.value("status", "other-options"), "other-options");
  // How a batch is run does not change its images.
  EXPECT_EQ(run(std::string("verify ") + options + " --threads 1 --isa scalar --max-memory 1G --quiet").out, "");
  // Another option set is made anew, not skipped.
  EXPECT_TRUE(contains(run(std::string(options) + " --exposure 1").out, R"("status":"done")"));

  write_jobs(4);
  answer = run(std::string("verify ") + options);
  EXPECT_EQ(answer.code, 2);
  EXPECT_TRUE(contains(answer.out, "begun with 3 items, and these are 4")) << answer.out;
  answer = run("verify jobs.jsonl --ledger nowhere");
  EXPECT_EQ(answer.code, 3);
  EXPECT_TRUE(contains(answer.out, "nowhere: is not the ledger of a batch")) << answer.out;
}

TEST_F(Farm, VerifyWithoutALedgerFindsWhatIsMissingOrTruncated) {
  write_jobs(4);
  ASSERT_EQ(run("jobs.jsonl --size 24").code, 0);
  EXPECT_EQ(run("verify jobs.jsonl --size 24").code, 0);
  fs::remove(place / "out/1.png"), fs::resize_file(place / "out/2.png", 30);
  const ProgramAnswer answer = run("verify jobs.jsonl --size 24");
  EXPECT_EQ(answer.code, 5);
  const std::vector<nlohmann::json> lines = lines_of(answer.out);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0]["status"], "missing");
  EXPECT_EQ(lines[1]["status"], "truncated");
}

TEST_F(Farm, VerifyKnowsFramesPassesAndFailures) {
  write("jobs.jsonl", R"({"input":"teapot","output":"out/a.##.png","turntable":3,"aov":"depth"})"
                      "\n"
                      R"({"input":"nothing.stl","output":"out/b.png"})"
                      "\n"
                      R"({"input":"wheel","output":"out/c.apng","frames":2})"
                      "\n"
                      R"({"input":"teapot","output":"out/d.exr","aov":"depth,normal"})"
                      "\n");
  EXPECT_EQ(run(options).code, 5);
  ProgramAnswer answer = run(std::string("verify ") + options);
  EXPECT_EQ(answer.code, 5);
  std::vector<nlohmann::json> lines = lines_of(answer.out);
  ASSERT_EQ(lines.size(), 2u) << answer.out;
  EXPECT_EQ(lines[0]["status"], "failed");
  EXPECT_TRUE(contains(lines[0].value("cause", ""), "nothing.stl")) << answer.out;
  fs::remove(place / "out/a.01.depth.png");
  lines = lines_of(run(std::string("verify ") + options).out);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0]["output"], "out/a.01.depth.png");
  EXPECT_EQ(run(options).code, 5);
  EXPECT_EQ(lines_of(run(std::string("verify ") + options).out).size(), 2u);
}

TEST_F(Farm, TheNumberOfShardsIsPinned) {
  write_jobs(6);
  EXPECT_EQ(run(std::string(options) + " --shard 1/3").code, 0);
  const ProgramAnswer answer = run(std::string(options) + " --shard 0/2");
  EXPECT_EQ(answer.code, 2);
  EXPECT_TRUE(contains(answer.out, "--shard: '0/2' is one of 2 shards, and the batch was begun with 3")) << answer.out;
  EXPECT_TRUE(contains(run(std::string(options) + " --shard auto", "SLURM_ARRAY_TASK_ID=2").out, "out/5.png"));
  EXPECT_EQ(files().size(), 4u);
}

// What each moment leaves is a prefix of the work: nothing half-written, nothing recorded that is not there.
TEST_F(Farm, KilledAtAnyMomentABatchGoesOn) {
  write_jobs(150);
  ASSERT_EQ(run("jobs.jsonl --size 24 --aa none").code, 0);
  const std::map<std::string, std::string> whole = files();
  fs::remove_all(place / "out");
  std::mt19937 random(3);
  int killed = 0;
  for (int i = 0; i < 12; ++i) {
    const pid_t child = start(fmt::format("{} --shard {}/2 --grace 5", options, i % 2));
    std::this_thread::sleep_for(std::chrono::microseconds(2'000 + random() % 40'000));
    ::kill(child, i % 3 == 0 ? SIGTERM : SIGKILL);
    const int code = finish(child);
    EXPECT_TRUE(code == 0 || code == 143 || code == 1000 + SIGKILL || code == 1000 + SIGTERM)
        << code << text_of(place / "err.txt");
    killed += code != 0;
  }
  EXPECT_GT(killed, 0);
  for (const char* shard : {"0/2", "1/2"}) EXPECT_EQ(run(std::string(options) + " --shard " + shard).code, 0);
  const ProgramAnswer answer = run(std::string("verify --remove-leftovers ") + options);
  EXPECT_EQ(answer.code, 0) << answer.out;
  EXPECT_EQ(files(), whole);
}

TEST_F(Farm, VerifyRemovesWhatKilledProcessesLeave) {
  write_jobs(2);
  ASSERT_EQ(run(options).code, 0);
  write("out/.0.png.4711.tmp", "half"), write("out/.1.png.4711.2.tmp", "half");
  write("out/.mine.tmp", "kept"), write("out/.0.png.x1.tmp", "kept");
  ProgramAnswer answer = run(std::string("verify ") + options);
  EXPECT_EQ(answer.code, 0);
  EXPECT_EQ(lines_of(answer.out).back()["leftovers"].size(), 2u) << answer.out;
  EXPECT_EQ(files().size(), 6u);
  EXPECT_EQ(run(std::string("verify --remove-leftovers ") + options).code, 0);
  EXPECT_EQ(files().size(), 4u);
}

TEST_F(Farm, SigtermLetsTheItemAtHandFinish) {
  const std::string slow = R"(,"size":"500x400","aa":"ssaa:n=4")";
  write_jobs(400, slow);
  const std::string arguments = "jobs.jsonl --ledger ledger -t 1";
  for (const int grace : {60, 0}) {
    fs::remove_all(place / "out"), fs::remove_all(place / "ledger");
    const pid_t child = start(fmt::format("{} --grace {}", arguments, grace));
    wait_for("out/1.png");
    // The engine signals every process of the task.
    const std::string children = text_of(fmt::format("/proc/{0}/task/{0}/children", child));
    for (std::istringstream ids(children); pid_t id = (ids >> id, ids ? id : 0);)
      if (grace > 0) ::kill(id, SIGTERM);
    ::kill(child, SIGTERM);
    EXPECT_EQ(finish(child), 143) << text_of(place / "err.txt");
    const auto count = files().size();
    EXPECT_LT(count, 400u);
    EXPECT_EQ(contains(text_of(place / "err.txt"), "items are complete; run again to go on"), grace > 0);
    for (const auto& [name, bytes] : files()) EXPECT_FALSE(name.ends_with(".tmp")) << name;
    int done = 0;
    for (const nlohmann::json& line : lines_of(text_of(place / "ledger/shard-0.jsonl"))) {
      done += line.contains("status");
      EXPECT_EQ(line.value("status", "done"), "done") << line.dump();
    }
    if (grace > 0) {
      EXPECT_EQ(static_cast<std::size_t>(done), count);
    }
  }
}

TEST_F(Farm, AGraceThatIsOverEndsTheItem) {
  write("jobs.jsonl", R"({"input":"teapot","output":"out/a.png","aa":"ssaa:n=16","size":"8000x8000"})"
                      "\n");
  const pid_t child = start("jobs.jsonl --ledger ledger --grace 0.2");
  wait_for("ledger/shard-0.jsonl");
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const auto before = std::chrono::steady_clock::now();
  ::kill(child, SIGTERM);
  EXPECT_EQ(finish(child), 143);
  EXPECT_GE(std::chrono::steady_clock::now() - before, std::chrono::milliseconds(190));
  EXPECT_TRUE(files().empty());
}

TEST_F(Farm, CausesAreToldApartAndAKilledItemIsTriedAgain) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer's allocator ends the process by itself";
#endif
  write("jobs.jsonl", R"({"input":"sphere:triangles=50000000","output":"out/a.png","max-memory":"64M"})"
                      "\n"
                      R"({"input":"teapot","output":"out/b.png","aa":"ssaa:n=16","size":"4000x4000","max-seconds":0.2})"
                      "\n"
                      R"({"input":"nothing.stl","output":"out/c.png"})"
                      "\n"
                      R"({"input":"teapot","output":"jobs.jsonl/d.png"})"
                      "\n"
                      R"({"input":"teapot","output":"out/e.png","siz":"8"})"
                      "\n"
                      R"({"input":"teapot","output":"out/f.png","aa":"ssaa:n=8","size":"1200x900"})"
                      "\n");
  const pid_t child = start(std::string("jobs.jsonl --ledger ledger -t 1 --retries 2"));
  // The process of the last item is killed once, as by a system without memory.
  wait_for("ledger/shard-0.jsonl");
  for (int i = 0; i < 60'000 && !contains(text_of(place / "ledger/shard-0.jsonl"), "\"item\":4"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::string children;
  for (int i = 0; i < 1000 && children.empty(); ++i) {
    children = text_of(fmt::format("/proc/{0}/task/{0}/children", child));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (children.empty()) GTEST_SKIP() << "the system does not list the children of processes";
  ::kill(std::stoi(children), SIGKILL);
  EXPECT_EQ(finish(child), 5);
  std::vector<std::string> causes;
  for (const nlohmann::json& line : lines_of(text_of(place / "out.txt"))) {
    causes.push_back(line.value("cause", ""));
    if (line["status"] == "done") {
      EXPECT_EQ(line["output"], "out/f.png");
      EXPECT_EQ(line["attempts"], 2);
    }
  }
  EXPECT_EQ(causes, (std::vector<std::string>{"memory", "time", "input", "output", "usage", ""}));
  EXPECT_TRUE(contains(text_of(place / "err.txt"), "it is tried again")) << text_of(place / "err.txt");
}

TEST_F(Farm, APlanDividesABatchAndPinsItsShards) {
  std::string jobs;
  for (int i = 0; i < 200; ++i)
    jobs += fmt::format(R"({{"input":"sphere:triangles={}","output":"out/{}.png"}})"
                        "\n",
                        12 * (1 + i % 40) * (1 + i % 40), i);
  write("jobs.jsonl", jobs);
  const std::string some = "jobs.jsonl --size 64 -t 1 --ledger ledger";
  ProgramAnswer answer = run("plan " + some + " --task-seconds 0.1 --sample 40");
  ASSERT_EQ(answer.code, 0) << answer.out;
  const nlohmann::json plan = lines_of(answer.out).front();
  EXPECT_FALSE(fs::exists(place / "out"));
  EXPECT_EQ(plan["items"], 200);
  EXPECT_EQ(plan["sample"], 40);
  const int shards = plan["shards"];
  EXPECT_GE(shards, 1);
  EXPECT_EQ(plan["array"], shards == 1 ? "0" : fmt::format("0-{}", shards - 1));
  EXPECT_GE(plan["items_per_task"].get<int>() * shards, 200);
  EXPECT_GE(plan["seconds"].get<double>() / shards, 0.099 / (shards == 1 ? 1e9 : 1));

  // The tasks take the number of shards from the ledger.
  for (int task = 0; task < shards; ++task) {
    answer = run(some + " --shard auto", fmt::format("SLURM_ARRAY_TASK_ID={}", task));
    EXPECT_EQ(answer.code, 0) << answer.out;
  }
  EXPECT_EQ(run("verify " + some).code, 0);
  std::uintmax_t bytes = 0;
  for (const auto& [name, text] : files()) bytes += text.size();
  EXPECT_NEAR(plan["disk_bytes"].get<double>(), static_cast<double>(bytes) + 200 * 400,
              0.1 * static_cast<double>(bytes));
  EXPECT_EQ(run("plan " + some + fmt::format(" --shards {}", shards + 1)).code, 2);
  EXPECT_EQ(lines_of(run("plan " + some + " --sample 2").out).front()["shards"], shards);
}

}  // namespace
