// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/config/config.h"

#include <gtest/gtest.h>

#include "zoneplate/base/error.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

struct ConfigSettings {
  int size = 0;
  bool is_clear = false;
  Syntax syntax;

  ConfigSettings() {
    syntax.verb = "render";
    syntax.options = {{"--resolution,--size", "N", "Size", "Image", true,
                       [this](const std::string& text) { size = parse_whole(text, 1, 1000); }},
                      {"--no-background", "", "Clear", "Image", true, [this](const std::string&) { is_clear = true; }},
                      {"--preset", "NAME", "Preset", "Image", true, [](const std::string&) {}}};
  }
  ConfigSettings(const ConfigSettings&) = delete;
  ConfigSettings& operator=(const ConfigSettings&) = delete;
};

constexpr const char* text =
    "# sizes\n"
    "size = 512\r\n"
    "\n"
    "[thumbnail]\n"
    "  resolution=64\n"
    "  --no-background\n"
    "[large]\n"
    "size = 900";

TEST(Config, AppliesWhatPrecedesThePresetsAndThenOneOfThem) {
  const Config config = parse_config(text, "config");
  EXPECT_EQ(config.presets, (std::vector<std::string>{"thumbnail", "large"}));
  ConfigSettings usual, small;
  apply_config(config, "", usual.syntax);
  EXPECT_EQ(usual.size, 512);
  EXPECT_FALSE(usual.is_clear);
  apply_config(config, "thumbnail", small.syntax);
  EXPECT_EQ(small.size, 64);
  EXPECT_TRUE(small.is_clear);
}

std::string refusal(const std::string& content, const std::string& preset = "") {
  try {
    ConfigSettings settings;
    apply_config(parse_config(content, "config"), preset, settings.syntax);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Usage);
    return error.what();
  }
  return "no error";
}

TEST(Config, ErrorsNameFileAndLine) {
  EXPECT_EQ(refusal("\nsiez = 3"), "config: line 2: unknown option --siez; did you mean --size?");
  EXPECT_EQ(refusal("size = 3000"), "config: line 1: --resolution: '3000' is not a whole number from 1 to 1000");
  EXPECT_EQ(refusal("size"), "config: line 1: --resolution needs a value: N");
  EXPECT_EQ(refusal("no-background = yes"), "config: line 1: --no-background takes no value");
  EXPECT_EQ(refusal("[a\n"), "config: line 1: expected a preset, as [thumbnail]");
  EXPECT_EQ(refusal("[a]\n[a]\n"), "config: line 2: a second preset a");
  EXPECT_EQ(refusal("= 4"), "config: line 1: expected an option, as size = 512");
  EXPECT_EQ(refusal("preset = a"), "config: line 1: preset is for the command line alone");
}

TEST(Config, NamesThePresetsThatThereAre) {
  EXPECT_EQ(refusal(text, "thumbnial"), "--preset: there is no preset thumbnial in config; did you mean thumbnail?");
  EXPECT_EQ(refusal(text, "xyz"), "--preset: there is no preset xyz in config; there are thumbnail, large");
  EXPECT_EQ(refusal("", "a"),
            "--preset: there is no preset a in config; a preset is a line [NAME] and the options after it");
}

}  // namespace
}  // namespace zoneplate::cli
