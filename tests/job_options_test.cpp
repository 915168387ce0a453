// SPDX-License-Identifier: Apache-2.0
// The table of options (job/options.h): each row acts, and gives the bytes of the command by the interface for C.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "option_rows_for_test.h"
#include "zoneplate/os/program_for_test.h"
#include "zoneplate/zoneplate.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

/// The names of the rows of the table.
std::set<std::string> table() {
  std::set<std::string> out;
  zoneplate_option option{.size = sizeof option};
  for (std::size_t i = 0; zoneplate_job_option(i, &option) == ZONEPLATE_OK; ++i) out.insert(option.name);
  return out;
}

struct FreeHandle {
  void operator()(zoneplate_job* job) const { zoneplate_job_free(job); }
  void operator()(zoneplate_scene* scene) const { zoneplate_scene_free(scene); }
  void operator()(zoneplate_image* image) const { zoneplate_image_free(image); }
  void operator()(zoneplate_frames* frames) const { zoneplate_frames_free(frames); }
};
template <class Handle>
using Owned = std::unique_ptr<Handle, FreeHandle>;

Owned<zoneplate_job> job_of(const std::vector<OptionText>& options) {
  zoneplate_job* job = nullptr;
  EXPECT_EQ(zoneplate_job_new(&job), ZONEPLATE_OK);
  for (const auto& [name, value] : options)
    EXPECT_EQ(zoneplate_job_set(job, name.c_str(), value.empty() ? nullptr : value.c_str()), ZONEPLATE_OK)
        << zoneplate_error_text();
  return Owned<zoneplate_job>(job);
}

Owned<zoneplate_scene> load(const Owned<zoneplate_job>& job, const std::string& name) {
  zoneplate_scene* scene = nullptr;
  EXPECT_EQ(zoneplate_job_load(job.get(), name.c_str(), &scene), ZONEPLATE_OK) << zoneplate_error_text();
  return Owned<zoneplate_scene>(scene);
}

class JobOptions : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    fs::copy(fs::path(source_root) / "tests/options", place, fs::copy_options::recursive);
    before_ = fs::current_path();
    fs::current_path(place);
  }
  void TearDown() override {
    fs::current_path(before_);
    ProgramTest::TearDown();
  }

  /// The files of a folder by their names.
  std::map<std::string, std::string> files(const std::string& folder) const {
    std::map<std::string, std::string> out;
    for (const auto& entry : fs::directory_iterator(place / folder))
      out[entry.path().filename()] = text_of(entry.path());
    return out;
  }
  void empty(const std::string& folder) const {
    fs::remove_all(place / folder);
    fs::create_directory(place / folder);
  }
  std::map<std::string, std::string> by_command(const OptionRow& row, const std::vector<OptionText>& options) const {
    empty("command");
    std::string text = fmt::format("render {} -o 'command/{}' -q", row.model, row.output);
    for (const auto& [name, value] : options)
      text += value.empty() ? fmt::format(" --{}", name) : fmt::format(" '--{}={}'", name, value);
    const ProgramAnswer answer = run(text);
    EXPECT_EQ(answer.code, 0) << text << '\n' << answer.out;
    return files("command");
  }
  std::map<std::string, std::string> by_c(const OptionRow& row, const std::vector<OptionText>& options) const {
    empty("c");
    const Owned<zoneplate_job> job = job_of(options);
    const Owned<zoneplate_scene> scene = load(job, row.model);
    EXPECT_EQ(zoneplate_job_save(job.get(), scene.get(), ("c/" + row.output).c_str()), ZONEPLATE_OK)
        << zoneplate_error_text();
    return files("c");
  }

 private:
  fs::path before_;
};

std::vector<OptionText> options_of(const OptionRow& row, bool has_option) {
  std::vector<OptionText> out = row.others;
  if (has_option) out.push_back(row.option);
  if (row.option.first != "resolution" || !has_option) out.insert(out.begin(), {"resolution", "48,40"});
  return out;
}

TEST_F(JobOptions, EachRowHasACase) {
  std::set<std::string> cases;
  for (const OptionRow& row : option_rows()) EXPECT_TRUE(cases.insert(row.option.first).second) << row.option.first;
  EXPECT_EQ(cases, table());
  EXPECT_GT(cases.size(), 70u);
}

TEST_F(JobOptions, EachRowActsWithTheSameBytesByTheCommandAndC) {
  std::map<std::string, decltype(by_command(OptionRow(), {}))> plain;  // without the option; many rows share it
  for (const OptionRow& row : option_rows()) {
    SCOPED_TRACE(row.option.first);
    const auto expected = by_command(row, options_of(row, true));
    EXPECT_FALSE(expected.empty());
    EXPECT_TRUE(by_c(row, options_of(row, true)) == expected);
    std::string key = row.model + '|' + row.output;
    for (const auto& [name, value] : options_of(row, false)) key += '|' + name + '=' + value;
    const auto [found, is_new] = plain.try_emplace(key);
    if (is_new) found->second = by_command(row, options_of(row, false));
    EXPECT_EQ(found->second != expected, row.changes_bytes);
  }
}

TEST_F(JobOptions, ImagesInMemoryHaveThePixelsOfFiles) {
  const Owned<zoneplate_job> job =
      job_of({{"resolution", "48,40"}, {"hdri-file", "sky.hdr"}, {"exposure", "auto"}, {"aov", "depth"}});
  const Owned<zoneplate_scene> scene = load(job, "teapot");
  zoneplate_image *image = nullptr, *bytes = nullptr;
  ASSERT_EQ(zoneplate_job_render(job.get(), scene.get(), nullptr, ZONEPLATE_SRGB8, &image), ZONEPLATE_OK)
      << zoneplate_error_text();
  const Owned<zoneplate_image> owned(image);
  EXPECT_EQ(zoneplate_image_count(image), 2u);
  ASSERT_EQ(zoneplate_image_encode(image, "png", &bytes), ZONEPLATE_OK);
  const Owned<zoneplate_image> encoded(bytes);
  zoneplate_array array{};
  ASSERT_EQ(zoneplate_image_array(bytes, "bytes", &array), ZONEPLATE_OK);
  EXPECT_EQ(zoneplate_job_save(job.get(), scene.get(), "a.png"), ZONEPLATE_OK) << zoneplate_error_text();
  EXPECT_TRUE(text_of("a.png") ==
              std::string(static_cast<const char*>(array.data), static_cast<std::size_t>(array.shape[0])));
  EXPECT_TRUE(exists("a.depth.png"));
}

TEST_F(JobOptions, LightInMemoryMayHaveAlpha) {
  const Owned<zoneplate_job> job = job_of({{"resolution", "48,40"}, {"no-background", ""}});
  const Owned<zoneplate_scene> scene = load(job, "teapot");
  zoneplate_image* image = nullptr;
  ASSERT_EQ(zoneplate_job_render(job.get(), scene.get(), nullptr, ZONEPLATE_LINEAR, &image), ZONEPLATE_OK)
      << zoneplate_error_text();
  const Owned<zoneplate_image> owned(image);
  zoneplate_array array{};
  ASSERT_EQ(zoneplate_image_array(image, zoneplate_image_name(image, 0), &array), ZONEPLATE_OK);
  EXPECT_EQ(static_cast<const float*>(array.data)[3], 0);
}

TEST_F(JobOptions, FramesHaveThePixelsOfFiles) {
  for (const auto& [model, options] :
       {std::pair{"teapot", std::vector<OptionText>{{"resolution", "48,40"}, {"turntable", "3"}}},
        {"model.gltf", {{"resolution", "48,40"}, {"frames", "2"}, {"frame-rate", "3"}, {"frame-start", "1"}}}}) {
    SCOPED_TRACE(model);
    const Owned<zoneplate_job> job = job_of(options);
    const Owned<zoneplate_scene> scene = load(job, model);
    ASSERT_EQ(zoneplate_job_save(job.get(), scene.get(), "f.#.png"), ZONEPLATE_OK) << zoneplate_error_text();
    zoneplate_frames* begun = nullptr;
    ASSERT_EQ(zoneplate_job_frames(job.get(), scene.get(), ZONEPLATE_SRGB8, &begun), ZONEPLATE_OK)
        << zoneplate_error_text();
    const Owned<zoneplate_frames> frames(begun);
    std::size_t count = 0;
    for (zoneplate_image* image = nullptr;; ++count) {
      std::int32_t number = -1;
      ASSERT_EQ(zoneplate_frames_next(begun, &number, &image), ZONEPLATE_OK) << zoneplate_error_text();
      if (image == nullptr) break;
      const Owned<zoneplate_image> owned(image);
      ASSERT_EQ(zoneplate_image_save(image, "frame.png"), ZONEPLATE_OK);
      EXPECT_TRUE(text_of("frame.png") == text_of(fmt::format("f.{}.png", number))) << number;
    }
    EXPECT_EQ(count, zoneplate_frames_count(begun));
    EXPECT_EQ(count, model[0] == 't' ? 3u : 2u);
  }
}

TEST_F(JobOptions, ASceneThatIsLoadedTakesOptionsOfMaterials) {
  const Owned<zoneplate_job> plain = job_of({{"resolution", "48,40"}}),
                             red = job_of({{"resolution", "48,40"}, {"color", "red"}});
  const Owned<zoneplate_scene> scene = load(plain, "cube.stl");
  for (const auto& [job, name] : {std::pair{&plain, "plain"}, {&red, "red"}, {&plain, "again"}})
    ASSERT_EQ(zoneplate_job_save(job->get(), scene.get(), fmt::format("{}.png", name).c_str()), ZONEPLATE_OK)
        << zoneplate_error_text();
  EXPECT_TRUE(text_of("plain.png") == text_of("again.png"));
  EXPECT_FALSE(text_of("plain.png") == text_of("red.png"));
  ASSERT_EQ(run("render cube.stl -o command.png --size 48,40 --color red -q").code, 0);
  EXPECT_TRUE(text_of("red.png") == text_of("command.png"));
}

TEST_F(JobOptions, ErrorsNameRows) {
  const Owned<zoneplate_job> job = job_of({{"resolution", "16,16"}});
  const auto refused = [&](const char* name, const char* value) {
    EXPECT_EQ(zoneplate_job_set(job.get(), name, value), ZONEPLATE_USAGE) << name;
    return std::string(zoneplate_error_text());
  };
  EXPECT_EQ(refused("shadow", "hard"), "shadow: there is no such option; did you mean shadows?");
  EXPECT_TRUE(refused("shadows", "hrad").starts_with("shadows: "));
  EXPECT_EQ(refused("shadows", nullptr), "shadows: needs a value: METHOD");
  EXPECT_EQ(refused("no-cull", "1"), "no-cull: takes no value");
  EXPECT_TRUE(refused("output", "a.png").starts_with("output: there is no such option"));
  EXPECT_EQ(zoneplate_job_set(job.get(), "frame-jump", "2"), ZONEPLATE_OK);
  const Owned<zoneplate_scene> scene = load(job, "teapot");
  zoneplate_image* image = nullptr;
  EXPECT_EQ(zoneplate_job_render(job.get(), scene.get(), nullptr, ZONEPLATE_SRGB8, &image), ZONEPLATE_USAGE);
  EXPECT_EQ(std::string(zoneplate_error_text()),
            "frame-jump requires a sequence: frames, frame-start, frame-end or turntable");
  EXPECT_EQ(image, nullptr);
}

}  // namespace
}  // namespace zoneplate
