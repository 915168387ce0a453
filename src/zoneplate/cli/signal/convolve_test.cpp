// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/signal/signal.h"
#include "zoneplate/cli/signal/signal_for_test.h"
#include "zoneplate/imaging/signal/kernel.h"
#include "zoneplate/imaging/signal/load.h"

namespace zoneplate::cli {
namespace {

using SignalConvolve = SignalVerb;
using Numbers = std::vector<double>;

TEST_F(SignalConvolve, TheRowOfTheCourse) {
  const Words words{"--values", "1 3 5 3 7 1 3 8 6 4", "--kernel", "1/4 1/2 1/4"};
  const auto row = json(run_signal_convolve, words);
  EXPECT_EQ(row["kernel"].get<Numbers>(), (Numbers{0.25, 0.5, 0.25}));
  // By hand: (1 + 2·3 + 5) / 4 = 3, ...; the border is repeated.
  EXPECT_EQ(row["result"].get<Numbers>(), (Numbers{1.5, 3, 4, 4.5, 4.5, 3, 3.75, 6.25, 6, 4.5}));
  Words zero = words;
  zero.insert(zero.end(), {"--border", "zero", "--via", "both"});
  const auto padded = json(run_signal_convolve, zero);
  EXPECT_EQ(padded["result"][0], 1.25);
  EXPECT_EQ(padded["result"][9], 3.5);
  EXPECT_LT(padded["difference"].get<double>(), 1e-6);
  EXPECT_TRUE(contains(out(run_signal_convolve, words), "result      1.5       3"));
}

TEST_F(SignalConvolve, AKernelIsTurnedRoundNotSlidAlong) {
  const auto row = json(run_signal_convolve, {"--values", "0 0 1 0 0", "--kernel", "1 2 3", "--via", "frequency"});
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_NEAR(row["result"][i].get<double>(), static_cast<double>(i % 4), 1e-6) << i;
}

TEST_F(SignalConvolve, BothWaysAgreeForEveryBorderAndTheBareProductOnlyForWrap) {
  for (const char* border : {"clamp", "reflect", "wrap", "zero"}) {
    const auto found = json(run_signal_convolve,
                            {"bricks:size=48", "--kernel", "gaussian:sigma=2", "--via", "both", "--border", border});
    EXPECT_LT(found["difference"]["greatest"].get<double>(), 1e-5 * found["range"].get<double>()) << border;
    if (border == std::string("wrap")) {
      EXPECT_FALSE(found.contains("difference_of_bare_product"));
      continue;
    }
    // It differs only near the border: within 2σ·3 = 6 pixels.
    const auto& bare = found["difference_of_bare_product"];
    EXPECT_GT(bare["greatest"].get<double>(), 0.01) << border;
    const int x = bare["x"], y = bare["y"];
    EXPECT_TRUE(x < 6 || x >= 42 || y < 6 || y >= 42) << x << ' ' << y;
  }
}

TEST_F(SignalConvolve, WritesThePicture) {
  save("identity.txt", "# a kernel that changes nothing\n0 0 0\n0 1 0  # here\n0 0 0\n");
  out(run_signal_convolve, {"bricks:size=32", "--kernel", at("identity.txt"), "-o", at("same.png")});
  out(run_signal_convolve, {"bricks:size=32", "--kernel", "1", "-o", at("one.png")});
  EXPECT_EQ(picture("same.png"), picture("one.png"));
  // Sobel's kernel sums to 0: the result is differences, around mid-grey.
  out(run_signal_convolve, {"edge:size=32,angle=0", "--kernel", "-1 0 1", "-o", at("edges.png")});
  const Rgba8Image edges = picture("edges.png");
  EXPECT_EQ(edges(5, 5).r, 128);
  EXPECT_EQ(edges(16, 5).r, 32);  // from 0.05 to 0.8: ½ - 0.75 / 2
  EXPECT_EQ(edges(15, 5).r, 32);
}

TEST_F(SignalConvolve, WritesValuesByTheEndingOfTheOutput) {
  // Sobel's differences are -0.75 and 0.75: an image is clamped around mid-grey, values are signed.
  const Words words{"edge:size=32,angle=0", "--kernel", "-2 0 2", "-o"};
  for (const char* name : {"edges.pfm", "edges.exr"}) {
    Words all = words;
    all.push_back(at(name));
    out(run_signal_convolve, all);
    const LinearImage values = load_signal(at(name), false);
    EXPECT_EQ(values.width(), 32) << name;
    EXPECT_NEAR(values(16, 5).r, -1.5, 1e-6) << name;
    EXPECT_EQ(values(5, 5).r, 0) << name;
  }
  Words figure = words;
  figure.insert(figure.end(), {at("edges.pfm"), "--side-by-side"});
  EXPECT_TRUE(contains(refusal(run_signal_convolve, figure), "ends in .png"));
  EXPECT_TRUE(contains(refusal(run_signal_convolve, {"noise", "-o", at("a.gif")}), "ends in .png or .pfm or .exr"));
}

TEST_F(SignalConvolve, BeyondTheBorderZeroIsBlackAndNotTransparent) {
  save_bytes(at("white.png"), encode_png(Rgba8Image(8, 8, {255, 255, 255, 255})));
  for (const char* via : {"space", "frequency"}) {
    out(run_signal_convolve,
        {at("white.png"), "--kernel", "box:width=3", "--border", "zero", "--codes", "--via", via, "-o", at("z.png")});
    EXPECT_EQ(picture("z.png")(0, 4), (Rgba8{170, 170, 170, 255})) << via;  // two thirds
    EXPECT_EQ(picture("z.png")(4, 4), (Rgba8{255, 255, 255, 255})) << via;
  }
}

TEST_F(SignalConvolve, TheHelpNamesEveryParameterOfTheGaussian) {
  EXPECT_TRUE(contains(out(run_signal_convolve, {"--help"}), "gaussian:sigma=,extent="));
}

TEST_F(SignalConvolve, ShowsKernelsAndSpectraSideBySide) {
  out(run_signal_convolve, {"bricks:size=64", "--kernel", "box:width=5", "--side-by-side", "-o", at("f.png")});
  EXPECT_GT(picture("f.png").width(), 3 * 512);
}

TEST_F(SignalConvolve, NumbersAreReadOrRefused) {
  const KernelChoice kernel = parse_kernel_choice("-1 0 1; -2, 0, 2; -.5 1/4 +1e1");
  EXPECT_EQ(kernel.weights.width(), 3);
  EXPECT_EQ(kernel.weights.height(), 3);
  EXPECT_EQ(kernel.weights(1, 2), 0.25f);
  EXPECT_EQ(kernel.sum(), 9.75);
  EXPECT_FALSE(kernel.is_separable());
  EXPECT_EQ(parse_kernel_choice("box:width=3").weights(0, 0), static_cast<float>(1.0 / 9));
  EXPECT_TRUE(contains(refusal(run_signal_convolve, {"noise", "--kernel", "1 2; 3"}), "row 2 has 1 numbers"));
  EXPECT_TRUE(contains(refusal(run_signal_convolve, {"noise", "--kernel", "1/0"}), "divides by zero"));
  EXPECT_TRUE(contains(refusal(run_signal_convolve, {"noise", "--kernel", "blob"}), "unknown kernel 'blob'"));
  EXPECT_TRUE(contains(refusal(run_signal_convolve, {"noise", "--values", "1 2"}), "not both"));
  EXPECT_TRUE(contains(refusal(run_signal_convolve, {"--values", "1 2; 3 4"}), "one row"));
  EXPECT_TRUE(contains(refusal(run_signal_convolve, {"--values", "1 2", "--kernel", "1 2; 3 4"}), "one row"));
  EXPECT_TRUE(contains(refusal(run_signal_convolve, {"--values", " "}), "no numbers"));
  save("bad.txt", "1 2 x\n");
  EXPECT_TRUE(contains(refusal(run_signal_convolve, {"noise", "--kernel", at("bad.txt")}, ErrorKind::Input),
                       "'x' is not a number"));
}

}  // namespace
}  // namespace zoneplate::cli
