// SPDX-License-Identifier: Apache-2.0
// Inputs of a small file and a large appetite, which fuzz/appetite.cpp writes: whatever they ask for, the program ends
// within its limits of time and memory, with a documented exit code and one line that names the input; and in a batch
// they do no harm to the jobs beside them. Runs the built program.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <set>

#include "measured_run.h"
#include "verbs_for_test.h"
#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/formats/assimp/assimp.h"
#include "zoneplate/report/json_for_test.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

struct Input {
  std::string name, kind;
  bool is_file = false;  ///< else a built-in scene
  std::vector<int> codes;
  nlohmann::json options;

  std::string output() const { return options.value("output", "image.png"); }
};

/// What the program is given, and what it is held to.
struct Limits {
  Words words;
  double max_seconds;
  std::uint64_t max_bytes;  ///< resident, of all processes together
};

Limits full_limits() {
  return {{"--max-memory", "200M", "--max-import-seconds", "2", "--max-seconds", "10"}, 15, 260'000'000};
}
/// The same in less time, with so much air that a busy machine does not matter.
Limits quick_limits() {
  return {{"--max-memory", "100M", "--max-import-seconds", "0.25", "--max-seconds", "0.5"}, 10, 160'000'000};
}

class Appetite : public testing::Test {
 protected:
  void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer takes memory and time of its own";
#endif
    std::string name = (fs::temp_directory_path() / "zoneplate_appetite_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    place = name;
    fs::create_directory(place / "images");
  }
  void TearDown() override {
    if (!place.empty()) fs::remove_all(place);
  }

  /// Has the inputs written, those that `choice` tells fuzz_appetite, and reads the list of them.
  std::vector<Input> make_inputs(const std::string& choice) const {
    const std::string command = "'" + std::string(appetite_program) + "' '" + (place / "in").string() + "' " + choice;
    EXPECT_EQ(std::system(command.c_str()), 0);
    std::vector<Input> inputs;
    std::ifstream index(place / "in/index.jsonl");
    for (std::string line; std::getline(index, line);) {
      const nlohmann::json j = parsed_json(line);
      inputs.push_back({j["name"], j["kind"], j["bytes"] != 0, j["exit"], j["options"]});
    }
    return inputs;
  }
  std::vector<Input> one_of_each_kind() const { return make_inputs("--one-of-each-kind"); }
  std::vector<Input> all_inputs() const { return make_inputs(""); }

  std::string path_of(const Input& input) const {
    return input.is_file ? (place / "in" / input.name).string() : input.name;
  }
  void empty_pictures() const {
    fs::remove_all(place / "images");
    fs::create_directory(place / "images");
  }

  void expect_within(const Limits& limits, const Input& input) const;
  void expect_within(const Limits& limits, const FileCommand& command, const fs::path& file) const;

  /// The images that the inputs consist of.
  std::vector<fs::path> images() const {
    std::vector<fs::path> out;
    for (const auto& entry : fs::directory_iterator(place / "in"))
      for (const char* ending : {".png", ".jpg", ".webp", ".hdr", ".exr", ".pfm"})
        if (entry.path().extension() == ending) out.push_back(entry.path());
    std::sort(out.begin(), out.end());
    return out;
  }
  void expect_others_are_done(const Limits& limits, const std::vector<Input>& hungry) const;

  fs::path place;
};

/// Checks that what was written to stderr is one error that names the input, and nothing but warnings besides.
void expect_one_error(const std::string& err, const std::string& name) {
  std::istringstream lines(err);
  int errors = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("zoneplate: warning: ")) continue;
    ++errors;
    EXPECT_TRUE(line.starts_with("zoneplate: error: ")) << line;
    EXPECT_NE(line.find(name), std::string::npos) << line;
  }
  EXPECT_EQ(errors, 1) << err.substr(0, 2000);
}

/// True if the input is read by assimp, whose crashes the child process contains; a crash of another reader is a fault
/// of the program, although its exit code is an allowed one.
bool is_read_by_assimp(const Input& input) {
  return std::ranges::any_of(assimp_formats(),
                             [&](const SceneFormat& format) { return input.name.ends_with(format.extension); });
}

void Appetite::expect_within(const Limits& limits, const Input& input) const {
  SCOPED_TRACE(input.kind + ": " + input.name);
  Words words{"render", path_of(input), "-o", "images/" + input.output()};
  words.insert(words.end(), limits.words.begin(), limits.words.end());
  for (const auto& [option, value] : input.options.items())
    if (option != "output") words.insert(words.end(), {"--" + option, value});
  const MeasuredRun run = run_measured(words, place, 2 * limits.max_seconds);
  std::printf("%-12s %-32s exit %d %6.2f s %5.0f MB (%.0f MB shared out) %s\n", input.kind.c_str(), input.name.c_str(),
              run.code, run.seconds, static_cast<double>(run.resident_bytes) / 1e6,
              static_cast<double>(run.proportional_bytes) / 1e6, run.err.substr(0, run.err.find('\n')).c_str());
  EXPECT_NE(std::find(input.codes.begin(), input.codes.end(), run.code), input.codes.end()) << run.code << run.err;
  EXPECT_LT(run.seconds, limits.max_seconds);
  EXPECT_LT(run.resident_bytes, limits.max_bytes);
  EXPECT_TRUE(is_read_by_assimp(input) || run.err.find("crashed (signal") == std::string::npos) << run.err;
  if (run.code == 0)
    EXPECT_EQ(run.err.find("error: "), std::string::npos) << run.err;
  else
    expect_one_error(run.err, run.code == 2 ? "" : input.name);
  EXPECT_EQ(fs::is_empty(place / "images"), run.code != 0);
  empty_pictures();
}

/// Any verb ends within the limits: with a documented exit code, and one error or an output.
void Appetite::expect_within(const Limits& limits, const FileCommand& command, const fs::path& file) const {
  SCOPED_TRACE(command.name + ": " + file.filename().string());
  Words words = command.with(file.string(), "images/image.png");
  words.insert(words.end(), limits.words.begin(), limits.words.end());
  const MeasuredRun run = run_measured(words, place, 2 * limits.max_seconds);
  std::printf("%-14s %-32s exit %d %6.2f s %5.0f MB %s\n", command.name.c_str(), file.filename().c_str(), run.code,
              run.seconds, static_cast<double>(run.resident_bytes) / 1e6,
              run.err.substr(0, run.err.find('\n')).c_str());
  const bool is_refused =
      run.code == 2 && run.err.find("is a scene-linear image, and images/image.png is not") != std::string::npos;
  EXPECT_TRUE(run.code == 0 || run.code == 1 || is_refused || run.code == 3 || (command.writes_always && run.code == 5))
      << run.code;
  EXPECT_LT(run.seconds, limits.max_seconds);
  EXPECT_LT(run.resident_bytes, limits.max_bytes);
  const bool is_foreign = file.string().find("foreign") != std::string::npos;
  EXPECT_TRUE(is_foreign || run.err.find("crashed (signal") == std::string::npos) << run.err;
  if (run.code == 1 || is_refused || run.code == 3) {
    expect_one_error(run.err, file.filename().string());
    // The frames of a data set are written one by one; its JSON, the last file, states that a sequence is complete.
    for (const auto& left : fs::recursive_directory_iterator(place / "images"))
      EXPECT_TRUE(command.name == "dataset" && left.path().extension() != ".json") << left.path();
  }
  empty_pictures();
}

/// One batch of hungry inputs with good ones between them.
void Appetite::expect_others_are_done(const Limits& limits, const std::vector<Input>& hungry) const {
  const fs::path folder = place / "images";
  std::ofstream manifest(place / "jobs.jsonl");
  const char* const good[] = {"teapot", "triangles", "sphere:triangles=1000"};
  std::size_t jobs = 0;
  const auto add_job = [&](nlohmann::json job, const std::string& input, const std::string& output) {
    job["input"] = input;
    job["output"] = (folder / (std::to_string(jobs++) + "-" + output)).string();
    manifest << job.dump() << "\n";
  };
  std::set<std::size_t> good_jobs;
  for (const Input& input : hungry) {
    add_job(input.options, path_of(input), input.output());
    good_jobs.insert(jobs);
    add_job({{"size", "40x30"}}, good[jobs / 2 % 3], "good.png");
  }
  manifest.close();
  Words words{"--manifest", "jobs.jsonl"};
  words.insert(words.end(), limits.words.begin(), limits.words.end());
  const double max_seconds = limits.max_seconds * static_cast<double>(hungry.size());
  const MeasuredRun run = run_measured(words, place, max_seconds);
  EXPECT_EQ(run.code, 5) << run.err;
  EXPECT_LT(run.seconds, max_seconds);
  EXPECT_LT(run.resident_bytes, limits.max_bytes);
  std::printf("a batch of %zu jobs: exit %d %.1f s %.0f MB\n", jobs, run.code, run.seconds,
              static_cast<double>(run.resident_bytes) / 1e6);

  std::ifstream lines(place / "out");
  std::size_t told = 0;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("{")) continue;
    const nlohmann::json j = parsed_json(line);
    const std::string status = j["status"];
    const bool is_good = good_jobs.contains(told++);
    EXPECT_TRUE(status == "done" || (status == "failed" && !is_good)) << line;
    const bool is_a_crash = line.find("crashed (signal") != std::string::npos;
    EXPECT_TRUE(!is_a_crash || (!is_good && is_read_by_assimp(hungry[(told - 1) / 2]))) << line;
  }
  EXPECT_EQ(told, jobs);
  for (const std::size_t i : good_jobs) EXPECT_TRUE(fs::exists(folder / (std::to_string(i) + "-good.png"))) << i;
  empty_pictures();
}

TEST_F(Appetite, OneOfEachKindStaysWithinTheLimitsAndHarmsNoOtherJobAndNoVerb) {
  std::vector<Input> files = one_of_each_kind();
  EXPECT_GE(files.size(), 25u);
  for (const Input& input : files) expect_within(quick_limits(), input);
  expect_others_are_done(quick_limits(), {files.begin(), files.begin() + 6});
  // Each verb has an input of its own, and the largest image.
  std::erase_if(files, [](const Input& input) { return !input.is_file; });
  for (std::size_t i = 0; i < model_commands().size(); ++i)
    expect_within(quick_limits(), model_commands()[i], path_of(files[i * files.size() / model_commands().size()]));
  const std::vector<fs::path> pictures = images();
  for (std::size_t i = 0; i < image_commands().size(); ++i) {
    expect_within(quick_limits(), image_commands()[i], pictures[i * pictures.size() / image_commands().size()]);
    expect_within(quick_limits(), image_commands()[i], place / "in/png-rgba-16000.png");
  }
}

// Those below take minutes: `./check --all` runs them.
TEST_F(Appetite, DISABLED_EveryInputStaysWithinTheLimits) {
  const std::vector<Input> inputs = all_inputs();
  EXPECT_GE(inputs.size(), 60u);
  for (const Input& input : inputs) expect_within(full_limits(), input);
}

TEST_F(Appetite, DISABLED_EveryInputStaysWithinTheLimitsOfEveryVerb) {
  for (const Input& input : all_inputs())
    for (const FileCommand& command : model_commands())
      if (input.is_file) expect_within(full_limits(), command, path_of(input));
  for (const fs::path& image : images())
    for (const FileCommand& command : image_commands()) expect_within(full_limits(), command, image);
}

TEST_F(Appetite, DISABLED_JobsBesideAllOfThemAreDone) { expect_others_are_done(full_limits(), all_inputs()); }

}  // namespace
}  // namespace zoneplate
