// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/args.h"

#include <gtest/gtest.h>

#include "zoneplate/base/error.h"

namespace zoneplate::cli {
namespace {

using Words = std::vector<std::string>;

// A verb with two options, and their values.
struct Toy {
  std::string size = "none";
  bool is_loud = false;
  Syntax syntax{
      .verb = "toy", .summary = "Play", .operands = "IN", .examples = "  zoneplate toy x\n", .notes = "Notes.\n"};

  Toy() {
    syntax.options = {{"--size,-s,--extent", "N", "How large", "Form", true,
                       [this](auto& text) {
                         if (text == "bad") throw Error(ErrorKind::Usage, "'bad' is not a size");
                         size = text;
                       }},
                      {"--loud", "", "Noise", "Sound", false, [this](auto&) { is_loud = true; }}};
  }
  std::string refusal(const Words& words) {
    try {
      parse(syntax, words);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Usage);
      return error.what();
    }
    return "no error";
  }
};

TEST(Parse, TakesEveryFormInAnyOrder) {
  for (const Words& words :
       {Words{"--size", "3", "--loud", "in"}, Words{"in", "--loud", "--size=3"}, Words{"--loud", "in", "-s", "3"},
        Words{"-s3", "in", "--loud"}, Words{"--extent=3", "--loud", "--", "in"},
        Words{"--size=1", "in", "--size=2", "--loud", "-s", "3"}}) {
    Toy toy;
    EXPECT_TRUE(parse(toy.syntax, words));
    EXPECT_EQ(toy.size, "3");
    EXPECT_TRUE(toy.is_loud);
    EXPECT_EQ(toy.syntax.found_operands, Words{"in"});
  }
}

TEST(Parse, TakesValuesThatLookLikeOptions) {
  for (const char* value : {"-1,2,3", "+Y", "-", "-Z", "a=b"}) {
    Toy toy;
    EXPECT_TRUE(parse(toy.syntax, Words{"--size", value, "in"}));
    EXPECT_EQ(toy.size, value);
    Toy other;
    EXPECT_TRUE(parse(other.syntax, Words{std::string("--size=") + value}));
    EXPECT_EQ(other.size, value);
  }
}

TEST(Parse, KeepsOperandsAfterTwoDashesAndALoneDash) {
  Toy toy;
  EXPECT_TRUE(parse(toy.syntax, Words{"-", "--", "--loud"}));
  EXPECT_EQ(toy.syntax.found_operands, (Words{"-", "--loud"}));
  EXPECT_FALSE(toy.is_loud);
}

TEST(Parse, NamesWhatIsWrong) {
  EXPECT_EQ(Toy().refusal({"--sise", "3"}), "unknown option --sise; did you mean --size?");
  EXPECT_EQ(Toy().refusal({"--sise=3"}), "unknown option --sise; did you mean --size?");
  EXPECT_EQ(Toy().refusal({"--frobnicate"}), "unknown option --frobnicate (zoneplate toy --help lists them)");
  EXPECT_EQ(Toy().refusal({"-x"}), "unknown option -x (zoneplate toy --help lists them)");
  EXPECT_EQ(Toy().refusal({"in", "--size"}), "--size needs a value: N");
  EXPECT_EQ(Toy().refusal({"in", "-s"}), "--size needs a value: N");
  EXPECT_EQ(Toy().refusal({"--size=bad"}), "--size: 'bad' is not a size");
  EXPECT_EQ(Toy().refusal({"--loud=3"}), "--loud takes no value");
}

TEST(Help, ShortHasTheBasicOptionsAndExamplesFullHasAll) {
  const Toy toy;
  EXPECT_EQ(short_help(toy.syntax),
            "Usage: zoneplate toy IN [OPTIONS]\n\nPlay.\n\n"
            "  -s, --size, --extent N          How large\n"
            "\nExamples:\n  zoneplate toy x\n\nAll options: zoneplate toy --help\n");
  EXPECT_EQ(full_help(toy.syntax),
            "Usage: zoneplate toy IN [OPTIONS]\n\nPlay.\n\n"
            "Form:\n  -s, --size, --extent N          How large\n\n"
            "Sound:\n  --loud                          Noise\n\n"
            "Other:\n  -h                              Short help with examples\n"
            "  --help                          This text; --help=GROUP: one group of it, as --help=form\n"
            "\nExamples:\n  zoneplate toy x\n\nNotes.\n");
}

TEST(Help, BreaksLongMeanings) {
  Toy toy;
  toy.syntax.options[1].meaning = std::string(60, 'a') + ' ' + std::string(20, 'b');
  EXPECT_NE(full_help(toy.syntax).find("a\n                                  bbb"), std::string::npos);
}

TEST(Help, GathersEachGroup) {
  Toy toy;
  toy.syntax.options.push_back({"--small", "", "Not large", "Form", false, [](auto&) {}});
  EXPECT_NE(full_help(toy.syntax).find("How large\n  --small"), std::string::npos) << full_help(toy.syntax);
}

TEST(Help, ShowsOneGroup) {
  const Toy toy;
  EXPECT_EQ(group_help(toy.syntax, "Sound"), "Sound:\n  --loud                          Noise\n");
  EXPECT_THROW(group_help(toy.syntax, "noise"), Error);
}

TEST(Help, FillsParagraphsAndKeepsIndentedLines) {
  Toy toy;
  const std::string word(60, 'a');
  toy.syntax.notes = word + "\n" + "b " + word + "\n  " + word + ' ' + word + "\n\nend\n";
  EXPECT_TRUE(full_help(toy.syntax).ends_with('\n' + word + " b\n" + word + "\n  " + word + ' ' + word + "\n\nend\n"));
}

}  // namespace
}  // namespace zoneplate::cli
