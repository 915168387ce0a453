// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/confined.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "zoneplate/base/error.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/sandbox.h"
#include "zoneplate/process/packed_plots.h"

namespace zoneplate::cli {
namespace {

namespace fs = std::filesystem;
using Bytes = std::vector<std::uint8_t>;

class Confined : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "zoneplate_confined_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    place = name;
    std::ofstream(place / "in") << "in";
    std::ofstream(place / "other") << "other";
  }
  void TearDown() override { fs::remove_all(place); }
  std::string at(const std::string& name) const { return (place / name).string(); }
  std::string text(const std::string& name) const {
    const FileBytes file(at(name));
    return {file.bytes().begin(), file.bytes().end()};
  }

  ConfinedRun small_run() const {
    ConfinedRun run{.name = at("in"), .limits = {}, .readable = {at("in")}, .outputs = {at("out")}};
    run.limits.load.memory = std::uint64_t{64} << 20;
    return run;
  }
  /// The error of a run without the place, after its kind.
  std::string refusal(const ConfinedRun& run, const std::function<void(Delivery&)>& work) const {
    try {
      run_confined(run, work);
      return "";
    } catch (const Error& error) {
      std::string message = std::to_string(static_cast<int>(error.kind())) + ' ' + error.what();
      for (std::size_t i; (i = message.find(place.string() + "/")) != std::string::npos;)
        message.erase(i, place.string().size() + 1);
      return message;
    }
  }
  fs::path place;
};

TEST_F(Confined, PrintsAndSavesInOrderAndReturnsTheResult) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const Bytes result = run_confined(small_run(), [&](Delivery& out) {
    out.print("first\n");
    out.save(at("out"), "file");
    out.print("second\n");
    out.print_report("aside\n", true);
    out.warn("a warning\x1b[1m");
    out.set_result({1, 2});
  });
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "first\nsecond\n");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "aside\nzoneplate: warning: a warning?[1m\n");
  EXPECT_EQ(result, (Bytes{1, 2}));
  EXPECT_EQ(text("out"), "file");
}

TEST_F(Confined, SavesAllFilesOrNoneUnlessEachIsAResult) {
  ConfinedRun run = small_run();
  run.outputs.push_back(at("out2"));
  const auto save_both = [&](Delivery& out) { out.save(at("out"), "one"), out.save(at("out2"), "two"); };
  const auto fail = [&](Delivery& out) {
    save_both(out);
    throw Error(ErrorKind::Failed, "late");
  };
  EXPECT_EQ(refusal(run, fail), std::to_string(static_cast<int>(ErrorKind::Failed)) + " late");
  EXPECT_FALSE(fs::exists(at("out")) || fs::exists(at("out2")));
  EXPECT_EQ(refusal(run, save_both), "");
  EXPECT_EQ(text("out") + text("out2"), "onetwo");
  fs::remove(at("out")), fs::remove(at("out2"));
  run.are_results = true;
  EXPECT_NE(refusal(run, fail), "");
  EXPECT_EQ(text("out") + text("out2"), "onetwo");
  EXPECT_THROW(run_confined(small_run(),
                            [&](Delivery& out) {
                              out.save(at("out"), "differs");
                              throw Difference("the images differ");
                            }),
               Difference);
  EXPECT_EQ(text("out"), "differs");
}

TEST_F(Confined, WarnsOfADamagedImageUnlessItsLimitsAreStrict) {
  ConfinedRun run = small_run();
  const auto read = [&](const std::string& flaw) {
    return refusal(run, [&](Delivery& out) { out.warn_of_flaw(flaw); });
  };
  testing::internal::CaptureStderr();
  EXPECT_EQ(read("a.jpg: cut") + read(""), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "zoneplate: warning: a.jpg: cut\n");
  run.limits.load.is_strict = true;
  EXPECT_EQ(read("a.jpg: cut"), "2 a.jpg: cut");
  EXPECT_EQ(read(""), "");
}

TEST_F(Confined, EndsAsTheWorkEnds) {
  EXPECT_THROW(run_confined(small_run(), [](Delivery&) { throw Difference("differs"); }), Difference);
  EXPECT_THROW(run_confined(small_run(), [](Delivery&) { throw PartialFailure("1 of 2"); }), PartialFailure);
  EXPECT_EQ(refusal(small_run(), [](Delivery&) { throw Error(ErrorKind::Usage, "wrong"); }), "1 wrong");
  EXPECT_EQ(refusal(small_run(), [](Delivery&) { throw Error(ErrorKind::Failed, "bad"); }), "0 bad");
}

TEST_F(Confined, SavesNoFileButItsOutputs) {
  ConfinedRun run = small_run();
  const auto work = [&](Delivery& out) { out.save(at("other"), "overwritten"); };
  EXPECT_EQ(refusal(run, work), "0 in: its process sent a file that is not expected");
  EXPECT_EQ(text("other"), "other");
  std::string seen;
  run.take = [&](const std::string& name, const Bytes& bytes) {
    seen += fs::path(name).filename().string(), seen += std::to_string(bytes.size());
  };
  EXPECT_EQ(refusal(run, work), "");
  EXPECT_EQ(seen, "other11");
}

TEST_F(Confined, ReadsNoFileButThoseNamed) {
  if (!sandbox_lacks().files.empty() || !sandbox_lacks().filter.empty()) GTEST_SKIP() << "no Landlock";
  const auto reading = [&](const std::string& name) {
    return refusal(small_run(), [&](Delivery& out) { out.read(name, [&] { FileBytes file(at(name)); }); });
  };
  EXPECT_EQ(reading("in"), "");
  EXPECT_EQ(reading("other"), "2 other: cannot be read: Permission denied");
  ConfinedRun free = small_run();
  free.limits.is_sandboxed = false;
  EXPECT_EQ(refusal(free, [&](Delivery&) { FileBytes file(at("other")); }), "");
}

TEST_F(Confined, MakesNoOtherSystemCall) {
  if (!sandbox_lacks().filter.empty()) GTEST_SKIP() << "no seccomp";
  const std::string ended = "0 in: its process made a system call that it has no right to, and was ended";
  EXPECT_EQ(refusal(small_run(), [](Delivery&) { ::socket(AF_INET, SOCK_STREAM, 0); }), ended);
  EXPECT_EQ(refusal(small_run(), [&](Delivery&) { std::ofstream(at("written")) << "x"; }), ended);
  EXPECT_EQ(refusal(small_run(), [](Delivery&) { ::execl("/bin/true", "true", nullptr); }), ended);
  EXPECT_FALSE(fs::exists(at("written")));
}

TEST_F(Confined, KeepsItsLimitsAndNamesTheInput) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // whose allocators end the process by themselves
  const auto take_memory = [](Delivery&) { std::vector<char> much(std::size_t{100} << 20, 'x'); };
  EXPECT_EQ(refusal(small_run(), take_memory),
            "0 in: working on it needs more memory than the limit of 64 MB (--max-memory)");
  EXPECT_EQ(refusal(small_run(), [&](Delivery& out) { out.read("second", [&] { take_memory(out); }); }),
            "2 second: reading it needs more memory than the limit of 64 MB (--max-memory)");
#endif
  ConfinedRun run = small_run();
  run.limits.load.seconds = 0.01;
  EXPECT_EQ(refusal(run, [](Delivery& out) { out.read("third", [] { ::sleep(20); }); }),
            "2 third: takes longer to load than the limit of 0.01 s (--max-import-seconds)");
  run = small_run();
  run.limits.seconds = 0.01;
  EXPECT_EQ(refusal(run, [](Delivery&) { ::sleep(20); }),
            "0 in: takes longer than the limit of 0.01 s (--max-seconds)");
}

TEST(PackedPlots, ComeBackAsTheyWere) {
  Curve curve{"name", {{1, 2}, {3, 4}}, Curve::Mark::Stems, Curve::grey};
  curve.labels = {"a", ""};
  const Plot plot{.title = "title", .x = {"x", 0, 1, true}, .y = {"y"}, .curves = {curve}};
  const PlotsToDraw back = unpack_plots(pack_plots({{plot, plot}, 2, {300, 200}}));
  ASSERT_EQ(back.plots.size(), 2u);
  EXPECT_EQ(back.columns, 2);
  EXPECT_EQ(back.size.width, 300);
  const Plot& second = back.plots[1];
  EXPECT_EQ(second.title, "title");
  EXPECT_TRUE(second.x.is_logarithmic && !second.y.is_logarithmic);
  ASSERT_EQ(second.curves.size(), 1u);
  EXPECT_EQ(second.curves[0].points, curve.points);
  EXPECT_EQ(second.curves[0].labels, curve.labels);
  EXPECT_EQ(second.curves[0].color, Curve::grey);

  const Figure figure{
      .title = "figure", .rows = {{{Rgba8Image(2, 1, {1, 2, 3, 4}), "caption"}, {{}, "", plot}}}, .text = "text"};
  const PlotsToDraw of_figure = unpack_plots(pack_plots({.plots = {}, .size = {}, .figure = figure}));
  ASSERT_TRUE(of_figure.figure.has_value());
  EXPECT_EQ(of_figure.figure->rows[0][0].picture, figure.rows[0][0].picture);
  EXPECT_EQ(of_figure.figure->rows[0][1].plot->title, "title");
}

TEST(PackedPlots, RefuseWhatIsNotValid) {
  const auto is_refused = [](const PlotsToDraw& plots) {
    try {
      unpack_plots(pack_plots(plots));
      return false;
    } catch (const Error&) {
      return true;
    }
  };
  const Plot plot{.title = "t", .x = {}, .y = {}, .curves = {{"c", {{1, 2}}}}};
  EXPECT_FALSE(is_refused({{plot}, 1, {}}));
  EXPECT_TRUE(is_refused({{}, 1, {}}));
  EXPECT_TRUE(is_refused({{plot}, 0, {}}));
  EXPECT_TRUE(is_refused({{plot}, 1, {100000, 1}}));
  Plot colored = plot;
  colored.curves[0].color = -7;
  EXPECT_TRUE(is_refused({{colored}, 1, {}}));
  Plot labelled = plot;
  labelled.curves[0].points = {{1, 2}, {3, 4}}, labelled.curves[0].labels = {"one"};
  EXPECT_TRUE(is_refused({{labelled}, 1, {}}));
  Bytes cut = pack_plots({{plot}, 1, {}});
  cut.pop_back();
  EXPECT_THROW(unpack_plots(cut), Error);
}

}  // namespace
}  // namespace zoneplate::cli
