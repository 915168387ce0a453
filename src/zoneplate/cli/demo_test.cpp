// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/lessons/demo.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/lessons/picture.h"
#include "zoneplate/os/file.h"
#include "zoneplate/report/html_page_for_test.h"
#include "zoneplate/signal/filter/kernel.h"

namespace zoneplate::cli {
namespace {

using namespace lessons;

constexpr DemoSize small{64};

Rgba8Image drawn(const Demo& demo, const Settings& settings) {
  return compose(demo.make(small, settings).frames.at(0), small.style());
}

std::string message_of(const std::vector<std::string>& arguments) {
  try {
    run_demo(arguments);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Usage);
    return error.what();
  }
  return "no error";
}

class DemoFolder : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "zoneplate_demo_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    place = name;
  }
  void TearDown() override { std::filesystem::remove_all(place); }
  std::filesystem::path place;
};

/// Every lesson, drawn once by one thread into a folder.
class AllLessons : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    std::string name = (std::filesystem::temp_directory_path() / "zoneplate_lessons_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    place = name;
    testing::internal::CaptureStdout();
    with_threads(1, [] { run_demo(std::vector<std::string>{"all", "-o", place / "lessons", "--panel", "64"}); });
    said = testing::internal::GetCapturedStdout();
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(place); }
  static Rgba8Image written(const Demo& demo) {
    const std::string path = place / "lessons" / (std::string(demo.name) + ".png");
    return decode_png(FileBytes(path).bytes(), path).pixels;
  }

  static inline std::filesystem::path place;
  static inline std::string said;
};

TEST_F(AllLessons, AreWrittenAndSaid) {
  const std::string folder = place / "lessons";
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.insert(entry.path().filename());
  EXPECT_EQ(names, (std::set<std::string>{"antialiasing.png",
                                          "upscaling.png",
                                          "black-edge.png",
                                          "jaggies.png",
                                          "moire.png",
                                          "prefilter.png",
                                          "convolution-theorem.png",
                                          "sampling.png",
                                          "aliases.png",
                                          "exact-coverage.png",
                                          "wagon-wheel.png",
                                          "wagon-wheel.webp",
                                          "texture-filters.png",
                                          "texture-enlarging.png",
                                          "mip-levels.png",
                                          "normal-map-aliasing.png",
                                          "shading-frequency.png",
                                          "blinn-phong.png",
                                          "shadows.png",
                                          "procedural.png",
                                          "bump-displacement.png",
                                          "environment.png",
                                          "rasterization.png",
                                          "zbuffer.png",
                                          "interpolation.png",
                                          "transforms.png",
                                          "gamma.png",
                                          "sdf.png",
                                          "temporal.png",
                                          "ghosting.png",
                                          "checkerboard.png",
                                          "learned.png"}));
  for (const std::string& name : names) {
    const FileBytes file(folder + "/" + name);
    if (name.ends_with(".png")) {
      EXPECT_GT(decode_png(file.bytes(), name).pixels.width(), 190) << name;
    }
  }
  // The text holds what the image says: titles, captions, and tables.
  for (const char* words : {"Jaggies: with one",
                            "The same region by 24 antialiasing methods",
                            "The black edge: four",
                            "have the correct brightness",
                            "--aa msaa:n=8: ",
                            "Moiré: ",
                            "Filter before sampling",
                            "border",
                            "Sampling repeats",
                            "blackman-harris",
                            "+0.90",
                            "Shutter always open: ",
                            "Percentage closer",
                            "differ at 0 samples",
                            "42 samples are covered once, 7 twice",
                            "36 samples are covered once, 0 twice",
                            "reverse order, 0 pixels differ",
                            "Three channels: ",
                            "Split sum",
                            "A scene at rest: 4 frames",
                            "No test: "})
    EXPECT_NE(said.find(words), std::string::npos) << words;
}

TEST_F(DemoFolder, APageHasThePanelsOfTheLesson) {
  const std::string path = (place / "page.html").string();
  testing::internal::CaptureStdout();
  run_demo(std::vector<std::string>{"jaggies", "--html", path, "--panel", "64"});
  testing::internal::GetCapturedStdout();
  const FileBytes file(path);
  const std::string page(file.bytes().begin(), file.bytes().end());
  EXPECT_NE(page.find("<title>Jaggies: with one sample"), std::string::npos);
  EXPECT_NE(content_of_page(page).find("{\"name\":\"--aa msaa:n=8\",\"text\":\""), std::string::npos);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(place), std::filesystem::directory_iterator()), 1);

  // Of an animated lesson each panel has its frames, and a panel that does not move has one.
  Figure first{.title = "t",
               .rows = {{{Rgba8Image(2, 1, {1, 2, 3, 255}), "still"}, {Rgba8Image(2, 1), "moving\ntext"}}}};
  Figure second = first;
  second.rows[0][1].picture(0, 0).r = 9;
  const std::vector<NamedLesson> lessons{{"lesson", {.frames = {first, second}}}};
  const std::string film = page_of(lessons);
  EXPECT_NE(content_of_page(film).find("{\"name\":\"still\",\"text\":\"\",\"frames\":[0]}"), std::string::npos);
  EXPECT_NE(content_of_page(film).find("{\"name\":\"moving\",\"text\":\"text\",\"frames\":[1,2]}"), std::string::npos);
  EXPECT_EQ(film, page_of(lessons));
}

TEST_F(DemoFolder, ASlideHasItsSize) {
  const std::string path = (place / "s.png").string();
  testing::internal::CaptureStdout();
  run_demo(std::vector<std::string>{"rasterization", "-o", path, "--slide", "960x540"});
  testing::internal::GetCapturedStdout();
  const Rgba8Image image = decode_png(FileBytes(path).bytes(), path).pixels;
  EXPECT_EQ(image.width(), 960);
  EXPECT_EQ(image.height(), 540);
  EXPECT_EQ(message_of({"rasterization", "-o", path, "--slide", "100x50"}),
            "--slide: the lesson rasterization does not fit into 100 × 50 pixels");
}

const Demo& demo_of(std::string_view name) {
  const auto found = std::ranges::find(demos(), name, &Demo::name);
  EXPECT_NE(found, demos().end()) << name;
  return *found;
}

TEST(Demo, SaysWhatIsMissingOrUnknown) {
  EXPECT_EQ(message_of({}), "demo: give one lesson; `zoneplate demo -h` lists them");
  EXPECT_EQ(message_of({"jaggies", "moire"}), "demo: give one lesson; `zoneplate demo -h` lists them");
  EXPECT_EQ(message_of({"jagies", "-o", "x.png"}), "demo: no lesson jagies; did you mean jaggies?");
  EXPECT_EQ(message_of({"jaggies:n=2", "-o", "x.png"}), "lesson jaggies: unknown parameter 'n'; it has none");
  EXPECT_EQ(message_of({"sampling:rate=2", "-o", "x.png"}),
            "lesson sampling: rate is '2', expected a number of 1 decimals from 0.5 to 1.9");
  EXPECT_EQ(message_of({"jaggies"}), "no output: give -o OUT.png");
  EXPECT_EQ(message_of({"all"}), "no output: give -o FOLDER");
  EXPECT_EQ(message_of({"jaggies", "-o", "x.jpg"}), "--output: x.jpg is not a format for lessons (.png, .svg, .pdf)");
}

TEST_F(DemoFolder, FailsAtOnceWhereNothingCanBeWritten) {
  const std::string root = place.string() + "/";
  std::filesystem::create_directories(place / "lesson.png");
  std::filesystem::create_directories(place / "wheel.webp");
  std::filesystem::create_directories(place / "lessons/wagon-wheel.webp");
  save_bytes(root + "file", {});
  const auto refusal = [&](const std::string& lesson, const std::string& output) {
    try {
      // The last lesson is the slowest: at this size it takes minutes.
      run_demo(std::vector<std::string>{lesson, "-o", root + output, "--panel", "1024"});
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Output);
      return std::string(error.what()).substr(root.size());
    }
    return std::string("no error");
  };
  EXPECT_EQ(refusal("jaggies", "none/x.png"), "none/x.png: cannot be written: no directory " + root + "none");
  EXPECT_EQ(refusal("jaggies", "lesson.png"), "lesson.png: cannot be written: it is a directory");
  EXPECT_EQ(refusal("wagon-wheel", "wheel.png"), "wheel.webp: cannot be written: it is a directory");
  EXPECT_EQ(refusal("all", "file"), "file: cannot create the folder: File exists");
  EXPECT_EQ(refusal("all", "lessons"), "lessons/wagon-wheel.webp: cannot be written: it is a directory");
  const std::string longest(256, 'n');
  EXPECT_EQ(refusal("all", longest), longest + ": cannot create the folder: File name too long");
  EXPECT_EQ(refusal("jaggies", longest + ".png"), longest + ".png: cannot be written: File name too long");
}

TEST_F(AllLessons, AreTheSameForAnyNumberOfThreads) {
  for (const char* name : {"jaggies", "antialiasing", "black-edge", "moire", "prefilter", "convolution-theorem"}) {
    const Demo& demo = demo_of(name);
    with_threads(3, [&] { EXPECT_EQ(drawn(demo, Settings(demo.params)), written(demo)) << demo.name; });
  }
}

TEST_F(AllLessons, ChangeWithAParameter) {
  for (const Demo& demo : demos()) {
    if (demo.params.empty()) continue;
    const Param& first = demo.params[0];
    const std::string other = !first.names.empty()     ? std::string(first.names.back())
                              : !first.choices.empty() ? std::to_string(first.choices.back())
                                                       : fmt::format("{}", first.high);
    const Settings settings("lesson", demo.params, fmt::format("{}:{}={}", demo.name, first.name, other));
    EXPECT_NE(drawn(demo, settings), written(demo)) << demo.name;
  }
}

// The table has each kernel's measured aliasing close to its theory, and lanczos3 keeps its limits.
TEST(Demo, AliasesHaveEveryKernelBesideItsTheory) {
  const Lesson lesson = demo_of("aliases").make(small, Settings(demo_of("aliases").params));
  const Table& table = lesson.tables.at(0);
  EXPECT_EQ(table.head.size(), 9u);
  ASSERT_EQ(table.rows.size() + 1, kernels().size());  // lanczos3 is lanczos
  const auto value = [](std::string cell) {
    const std::string minus = "−";
    EXPECT_TRUE(cell.starts_with(minus)) << cell;
    return -std::stod(cell.substr(minus.size()));
  };
  int limited = 0;
  for (const auto& row : table.rows) {
    for (std::size_t i = 1; i < row.size(); i += 2) EXPECT_NEAR(value(row[i]), value(row[i + 1]), 2) << row[0];
    if (row[0] != "lanczos3, lanczos") continue;
    ++limited;
    for (const std::size_t all : {1u, 5u}) EXPECT_LE(value(row[all]), -15);
    for (const std::size_t far : {3u, 7u}) EXPECT_LE(value(row[far]), -40);
  }
  EXPECT_EQ(limited, 1);
}

TEST(DemoPicture, CropsStayInsideAndAreMarked) {
  Rgba8Image picture(40, 30);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) picture(x, y) = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 0, 255};
  const Rgba8Image crop = crop_of(picture, 39, 0, 8, 80);  // 10 pixels of the upper right corner
  ASSERT_EQ(crop.width(), 80);
  EXPECT_EQ(crop(0, 0), (Rgba8{30, 0, 0, 255}));
  EXPECT_EQ(crop(79, 79), (Rgba8{39, 9, 0, 255}));
  const Rgba8Image with_mark = marked(picture, 20, 15, 8, 80);
  EXPECT_EQ(with_mark(15, 10), picture(15, 10));
  EXPECT_NE(with_mark(14, 10), picture(14, 10));
  EXPECT_NE(with_mark(25, 20), picture(25, 20));
}

TEST(DemoPicture, WritesNumbers) {
  EXPECT_EQ(number(-12.34, 1), "−12.3");
  EXPECT_EQ(number(-0.001, 2), "0.00");
  EXPECT_EQ(number(3, 0), "3");
  EXPECT_EQ(counted(0), "0");
  EXPECT_EQ(counted(999), "999");
  EXPECT_EQ(counted(1234567), "1,234,567");
}

TEST(DemoText, IsTheFigureWrapped) {
  Lesson lesson;
  lesson.frames.push_back({.title = "Title", .rows = {{{{}, "Heading\nwords"}, {{}, ""}}}, .text = "last"});
  lesson.tables.push_back({{"a", "b"}, {{"x", "1"}}});
  EXPECT_EQ(text_of(lesson), "Title\n\n  Heading: words\n\na  b\nx  1\n\nlast\n");
  std::string words;
  for (int i = 0; i < 50; ++i) words += "word ";
  lesson.frames[0].text = words + "end";
  std::string text = text_of(lesson);
  for (std::size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1)
    EXPECT_LE(end - at, 100u);
}

}  // namespace
}  // namespace zoneplate::cli
