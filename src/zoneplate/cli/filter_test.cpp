// SPDX-License-Identifier: Apache-2.0
// Tests of the verb that run the built program.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/codec/exr/exr_encode.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/metrics/backdrop.h"
#include "zoneplate/metrics/file/picture_file.h"
#include "zoneplate/metrics/psnr.h"
#include "zoneplate/os/file.h"
#include "zoneplate/render/renderer.h"
#include "zoneplate/scene/builtin/builtin.h"
#include "zoneplate/upscale/upscaler.h"

namespace zoneplate::cli {
namespace {

namespace fs = std::filesystem;

class FilterVerb : public testing::Test {
 protected:
  FilterVerb() : folder_(fs::temp_directory_path() / ("zoneplate_filter_test_" + std::to_string(::getpid()))) {
    fs::create_directories(folder_);
  }
  ~FilterVerb() override { fs::remove_all(folder_); }

  /// Runs the program in the folder; returns its exit code and stores its output.
  int run(const std::string& arguments) {
    const std::string command = "cd '" + folder_.string() + "' && '" + program_file + "' " + arguments + " 2>&1";
    std::FILE* pipe = ::popen(command.c_str(), "r");
    std::array<char, 4096> part{};
    output_.clear();
    while (const std::size_t n = std::fread(part.data(), 1, part.size(), pipe)) output_.append(part.data(), n);
    return WEXITSTATUS(::pclose(pipe));
  }
  PngImage png(const std::string& name) const {
    const FileBytes file((folder_ / name).string());
    return decode_png(file.bytes(), name);
  }
  void save(const std::string& name, const std::vector<std::uint8_t>& bytes) const {
    save_bytes((folder_ / name).string(), bytes);
  }
  const fs::path& folder() const { return folder_; }
  bool exists(const std::string& name) const { return fs::exists(folder_ / name); }

  std::string output_;

 private:
  fs::path folder_;
};

TEST_F(FilterVerb, AnImageIsFilteredAsARenderingIs) {
  ASSERT_EQ(run("teapot -o plain.png --size 96x72 --aa none"), 0) << output_;
  for (const std::string method : {"fxaa", "smaa", "smaa:mix=codes", "mlaa", "cmaa2", "dlaa", "ddaa"}) {
    ASSERT_EQ(run("teapot -o rendered.png --size 96x72 --aa " + method), 0) << output_;
    ASSERT_EQ(run("filter plain.png -o filtered.png --aa " + method), 0) << output_;
    EXPECT_EQ(png("filtered.png").pixels, png("rendered.png").pixels) << method;
    EXPECT_NE(png("filtered.png").pixels, png("plain.png").pixels) << method;
  }
}

// Half floats of the EXR file are within one code of the renderer's own light.
TEST_F(FilterVerb, ShowsSceneLinearImages) {
  ASSERT_EQ(run("teapot -o light.exr --size 96x72"), 0) << output_;
  for (const std::string curve : {"none", "aces", "neutral", "agx", "filmic"}) {
    const std::string options = " --tone-mapping " + curve + " --exposure 0.5 --background '#405060'";
    ASSERT_EQ(run("teapot -o rendered.png --size 96x72" + options), 0) << output_;
    ASSERT_EQ(run("filter light.exr -o shown.png" + options), 0) << output_;
    const Rgba8Image shown = png("shown.png").pixels, rendered = png("rendered.png").pixels;
    int greatest = 0;
    for (std::size_t i = 0; i < shown.values().size(); ++i)
      greatest = std::max({greatest, std::abs(shown.values()[i].r - rendered.values()[i].r),
                           std::abs(shown.values()[i].g - rendered.values()[i].g),
                           std::abs(shown.values()[i].b - rendered.values()[i].b)});
    EXPECT_LE(greatest, 1) << curve;
  }
  ASSERT_EQ(run("filter light.exr -o smooth.png --aa smaa --exposure auto --bit-depth 16"), 0) << output_;
  EXPECT_EQ(run("filter rendered.png -o a.png --tone-mapping agx"), 2);
  EXPECT_NE(output_.find("is a display-referred image"), std::string::npos) << output_;
  EXPECT_EQ(run("filter light.exr -o a.exr --tone-mapping agx"), 2);
  EXPECT_NE(output_.find("write a .png"), std::string::npos) << output_;
}

TEST_F(FilterVerb, UnchangedPixelsKeepSixteenBits) {
  Rgba16Image flat(8, 8, Rgba16{30001, 2, 65535, 65535});
  save("flat.png", encode_png(flat));
  ASSERT_EQ(run("filter flat.png -o out.png --aa smaa --bit-depth 16"), 0) << output_;
  EXPECT_EQ(png("out.png").pixels16, flat);
}

TEST_F(FilterVerb, SequencesAndFoldersAreWrittenToAFolder) {
  ASSERT_EQ(run("teapot -o a.####.png --size 48x36 --turntable 3 --aa none"), 0) << output_;
  ASSERT_EQ(run("filter a.####.png -o sequence --aa fxaa"), 0) << output_;
  ASSERT_EQ(run("filter . -o folder/ --aa fxaa"), 0) << output_;
  for (const char* name : {"a.0000.png", "a.0001.png", "a.0002.png"}) {
    EXPECT_EQ(png(std::string("sequence/") + name).pixels, png(std::string("folder/") + name).pixels);
    EXPECT_NE(png(std::string("sequence/") + name).pixels, png(name).pixels);
  }
}

TEST_F(FilterVerb, ProgressIsOneLinePerImage) {
  ASSERT_EQ(run("teapot -o a.png --size 48x36 --aa none"), 0) << output_;
  fs::create_directories(folder() / "shots");
  for (const char* const name : {"shots/1.png", "shots/2.png"}) fs::copy_file(folder() / "a.png", folder() / name);
  ASSERT_EQ(run("filter shots -o out --aa fxaa --progress json"), 0);
  EXPECT_EQ(output_, "{\"stage\":\"shots/1.png\",\"done\":0.0}\n{\"stage\":\"shots/2.png\",\"done\":0.5}\n");
}

TEST_F(FilterVerb, WhatCannotBeFilteredIsRefused) {
  ASSERT_EQ(run("triangles -o a.png --size 16x16"), 0) << output_;
  ASSERT_EQ(run("triangles -o a.exr --size 16x16"), 0) << output_;
  EXPECT_EQ(run("filter a.png -o b.png --aa msaa"), 2);
  EXPECT_EQ(output_,
            "zoneplate: error: --anti-aliasing: msaa needs a scene, expected a filter of images: fxaa, smaa, "
            "smaa-exact, mlaa, "
            "cmaa2, dlaa, ddaa, learned-smaa, taa, history-guided\n");
  for (const char* method : {"smaa:edges=depth", "smaa:mode=s2x", "analytic:order=display", "none"})
    EXPECT_EQ(run(std::string("filter a.png -o b.png --aa ") + method), 2) << method;
  EXPECT_EQ(run("filter a.png -o b.png"), 2);
  EXPECT_EQ(run("filter a.png --aa smaa"), 2);
  ASSERT_EQ(run("triangles -o a.webp --size 16x16"), 0) << output_;
  EXPECT_EQ(run("filter . -o all --aa smaa"), 2);  // a.png and a.webp
  EXPECT_NE(output_.find("would both be written to all/a.png"), std::string::npos) << output_;
  EXPECT_EQ(run("filter a.exr -o b.png --upscale fsr1"), 2);
  EXPECT_EQ(output_, "zoneplate: error: a.exr: is a scene-linear image, and b.png is not: write an .exr or a .pfm\n");
  EXPECT_EQ(run("filter a.png -o b.exr --aa smaa"), 2);
  EXPECT_EQ(run("filter a.png -o b.webp --aa smaa --bit-depth 16"), 2);
  EXPECT_EQ(run("filter none.png -o b.webp --aa smaa --bit-depth 16"), 2);  // an error before the input is read
  EXPECT_EQ(run("filter none.png -o b.png --aa smaa"), 3);
  EXPECT_FALSE(exists("b.png"));
  // The error of the model reader names the verb for images.
  EXPECT_EQ(run("a.png -o b.png --aa smaa"), 3);
  EXPECT_NE(output_.find("zoneplate filter"), std::string::npos) << output_;
}

TEST_F(FilterVerb, UpscalesImages) {
  ASSERT_EQ(run("wires -o small.png --size 48x36 --aa smaa"), 0) << output_;
  ASSERT_EQ(run("wires -o rendered.png --size 96x72 --aa smaa --upscale lanczos --render-scale performance"), 0)
      << output_;
  ASSERT_EQ(run("filter small.png -o large.png --upscale fsr1 --size 96x72 --bit-depth 16"), 0) << output_;
  EXPECT_EQ(png("large.png").pixels.width(), 96);
  EXPECT_EQ(png("large.png").pixels.height(), 72);
  ASSERT_EQ(run("filter small.png -o default.png --aa fxaa --upscale nis"), 0) << output_;
  EXPECT_EQ(png("default.png").pixels.width(), 72);
  EXPECT_EQ(run("filter small.png -o x.png --upscale fsr1 --size 40x40"), 2);
  EXPECT_NE(output_.find("upscalers only enlarge"), std::string::npos) << output_;
  EXPECT_EQ(run("filter small.png -o x.png --upscale nis --size 200x40"), 2);
  EXPECT_EQ(run("filter small.png -o x.png --size 96x72 --aa smaa"), 2);
  EXPECT_NE(output_.find("--size requires --upscale"), std::string::npos) << output_;
  EXPECT_EQ(run("wires -o x.png --render-scale 2"), 2);
  EXPECT_EQ(run("wires -o x.exr --upscale fsr1"), 2);
}

TEST_F(FilterVerb, EveryUpscalerRenders) {
  for (const Upscaler& upscaler : upscale::upscalers()) {
    const std::string name(upscaler.name);
    ASSERT_EQ(run("wires -o " + name + ".png --size 48x36 --upscale " + name), 0) << output_;
    EXPECT_EQ(png(name + ".png").pixels.width(), 48) << name;
  }
}

TEST_F(FilterVerb, UpscalesSceneLinearImages) {
  ASSERT_EQ(run("wires -o small.exr --size 48x36 --aa msaa:n=4"), 0) << output_;
  ASSERT_EQ(run("filter small.exr -o large.exr --upscale fsr1:scale=2"), 0) << output_;
  ASSERT_EQ(run("wires -o direct.exr --size 96x72 --aa msaa:n=4"), 0) << output_;
  ASSERT_EQ(run("metrics direct.exr large.exr --metric psnr --threshold 20"), 0) << output_;
  EXPECT_EQ(run("filter small.exr -o large.png --upscale fsr1"), 2);
  EXPECT_NE(output_.find("write an .exr or a .pfm"), std::string::npos) << output_;
  ASSERT_EQ(run("filter small.exr -o both.exr --aa smaa --upscale fsr1:scale=2"), 0) << output_;
  EXPECT_EQ(run("metrics direct.exr both.exr --metric psnr --threshold 20"), 0) << output_;
}

/// Records the frames of a method as files of another renderer: half floats, depth and motion as floats.
class Recorder : public Resolver {
 public:
  Recorder(std::unique_ptr<Resolver> method, fs::path folder)
      : method_(std::move(method)), folder_(std::move(folder)) {}

  bool has_history() const override { return method_->has_history(); }
  Request request(const FrameContext& context) override {
    index_ = context.index;
    Request request = method_->request(context);
    const SamplePosition s = request.samples[0];
    samples_ += fmt::format("{} {}\n", s.x / 256.0 - 0.5, s.y / 256.0 - 0.5);
    save_bytes((folder_ / "jitter.txt").string(), std::vector<std::uint8_t>(samples_.begin(), samples_.end()));
    return request;
  }
  LinearImage resolve(Frame& frame) override {
    const int width = frame.color.width(), height = frame.color.height();
    const auto path = [&](const char* pass) { return (folder_ / fmt::format("{}.{:04}.exr", pass, index_)).string(); };
    save_bytes(path("color"), encode_exr(width, height, rgba_channels(frame.color)));
    save_bytes(path("depth"),
               encode_exr(width, height, {{"R", ExrType::Float, frame.depth.values().data(), nullptr, 1}}));
    // Another engine's convention: the way back to the last frame, in units of the image, y up.
    std::vector<float2> back;
    for (const float2 m : frame.motion.values())
      back.push_back({-m.x / static_cast<float>(width), m.y / static_cast<float>(height)});
    save_bytes(path("motion"), encode_exr(width, height,
                                          {{"R", ExrType::Float, &back[0].x, nullptr, 2},
                                           {"G", ExrType::Float, &back[0].y, nullptr, 2}}));
    return method_->resolve(frame);
  }

 private:
  std::unique_ptr<Resolver> method_;
  fs::path folder_;
  std::string samples_;
  int index_ = 0;
};

// Half floats of the input and the output round by 2⁻¹¹ each; tests of locks and depth may decide otherwise.
struct TemporalUpscaler {
  const char* name;
  double min_psnr;
};
class FilterUpscaler : public FilterVerb, public ::testing::WithParamInterface<TemporalUpscaler> {};

TEST_P(FilterUpscaler, TreatsFramesOfAnotherRendererAsOwnOnes) {
  const auto [name, min_psnr] = GetParam();
  Scene scene = *make_builtin_scene("teapot");
  const Box box = scene.bounds();
  Renderer renderer(PreparedScene(std::move(scene)),
                    std::make_unique<Recorder>(upscale::make_method(fmt::format("{}:scale=2", name)), folder()));
  RenderSettings settings{.form = ImageForm::Linear};
  settings.options.width = 96, settings.options.height = 72;
  std::vector<LinearImage> direct;
  for (int i = 0; i < 6; ++i) {
    const Camera camera = fit_camera(box, 96.0f / 72, {.azimuth = 0.5f + 0.01f * static_cast<float>(i)});
    direct.push_back(renderer.render(camera, settings).linear);
  }
  ASSERT_EQ(run(fmt::format("filter color.####.exr --depth depth.####.exr --motion motion.####.exr --motion-scale "
                            "-48,36 --jitter jitter.txt --fov 30 --background black --upscale {} --size 96x72 -o out",
                            name)),
            0)
      << output_;
  for (int i = 0; i < 6; ++i) {
    const LinearImage found = metrics::load_picture((folder() / fmt::format("out/color.{:04}.exr", i)).string()).linear;
    ASSERT_EQ(found.width(), 96);
    const auto psnr =
        metrics::peak_signal_to_noise(metrics::make_picture(LinearImage(direct[static_cast<std::size_t>(i)])),
                                      metrics::make_picture(LinearImage(found)));
    EXPECT_GT(psnr, min_psnr) << i;
  }
}
INSTANTIATE_TEST_SUITE_P(All, FilterUpscaler,
                         ::testing::Values(TemporalUpscaler{"fsr2", 70}, TemporalUpscaler{"taau", 70},
                                           TemporalUpscaler{"sgsr2", 70}, TemporalUpscaler{"fsr3", 70},
                                           TemporalUpscaler{"learned", 60}),
                         [](const auto& one) { return std::string(one.param.name); });

TEST_F(FilterVerb, TemporalMethodsFilterTheFramesOfRender) {
  const std::string raw = "taa:rest=test,blend=fixed,alpha=1,rectify=none,reject=none";  // one jittered sample
  const std::string film = " --frames 6 --size 96x72 --aa ";
  ASSERT_EQ(run("teleport -o raw.####.exr --aov depth,motion,object-id" + film + raw), 0) << output_;
  ASSERT_EQ(run("teleport -o direct.####.exr" + film + "taa"), 0) << output_;
  ASSERT_EQ(run("filter raw.####.exr --aa taa -o out"), 0) << output_;
  // Colours are rounded to half floats before the history, not only after it.
  EXPECT_EQ(run("metrics direct.0000.exr out/raw.0000.exr --metric mae --threshold 0"), 0) << output_;
  EXPECT_EQ(run("metrics direct.####.exr out/raw.####.exr --metric psnr --threshold 80"), 0) << output_;
}

// A disc on transparency that hides another colour.
TEST_F(FilterVerb, FormatsWithoutAlphaNeedABackground) {
  Rgba8Image disc(40, 30, Rgba8{0, 255, 0, 0});
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x)
      if ((x - 20) * (x - 20) + (y - 15) * (y - 15) < 120) disc(x, y) = {220, 30, 40, 255};
  save("disc.png", encode_png(disc));
  for (const char* name : {"out.jpg", "out.jpeg"}) {
    EXPECT_EQ(run(std::string("filter disc.png --aa smaa -o ") + name), 2);
    EXPECT_EQ(output_, std::string("zoneplate: error: ") + name +
                           ": the image is not opaque, and JPEG has no alpha: write a .png or a .webp, or give it a "
                           "background\n");
    EXPECT_FALSE(exists(name));
  }
  ASSERT_EQ(run("filter disc.png --aa smaa --background '#0000ff' -o out.jpg"), 0) << output_;
  ASSERT_EQ(run("filter disc.png --aa smaa --background '#0000ff' -o out.png"), 0) << output_;
  const Rgba8Image laid = png("out.png").pixels;
  EXPECT_EQ(laid(0, 0), (Rgba8{0, 0, 255, 255}));
  EXPECT_EQ(laid(20, 15), (Rgba8{220, 30, 40, 255}));
  const metrics::Picture jpeg = metrics::load_picture((folder() / "out.jpg").string());
  EXPECT_NEAR(jpeg.display(1, 1).b, 1, 0.02f);
  EXPECT_NEAR(jpeg.display(1, 1).g, 0, 0.02f);
  ASSERT_EQ(run("teapot -o pot.exr --size 24x18"), 0) << output_;
  EXPECT_EQ(run("filter pot.exr --upscale bilinear -o pot.pfm"), 2) << output_;
  EXPECT_EQ(run("filter pot.exr --upscale bilinear --background white -o pot.pfm"), 0) << output_;
}

// Methods of opaque images refuse frames with alpha without a background, and else make those of opaque frames.
TEST_F(FilterVerb, TemporalMethodsKeepAlphaOrRefuseIt) {
  const std::string frames = "teapot --turntable 90 --frames 2 --size 48x36 --aa none --aov depth,motion ";
  ASSERT_EQ(run(frames + "-o clear.####.exr"), 0) << output_;
  ASSERT_EQ(run(frames + "--background '#204060' -o laid.####.exr"), 0) << output_;
  for (const char* method :
       {"--upscale fsr2", "--upscale fsr3", "--upscale sgsr2", "--upscale taau", "--upscale learned"}) {
    const std::string name = std::string(method).substr(10);
    EXPECT_EQ(run(std::string("filter clear.####.exr -o out ") + method), 2) << method;
    EXPECT_NE(
        output_.find("clear.0000.exr: " + name + " makes opaque images, and this one is not: give a --background"),
        std::string::npos)
        << output_;
    ASSERT_EQ(run(std::string("filter clear.####.exr -o a --background '#204060' ") + method), 0) << output_;
    ASSERT_EQ(run(std::string("filter laid.####.exr -o b ") + method), 0) << output_;
    EXPECT_EQ(run("metrics b/laid.0001.exr a/clear.0001.exr --metric psnr --threshold 60"), 0) << output_;
  }
  for (const char* method : {"taa", "history-guided"}) {
    ASSERT_EQ(run(std::string("filter clear.####.exr -o kept --aa ") + method), 0) << output_;
    EXPECT_TRUE(metrics::has_alpha(metrics::load_picture((folder() / "kept/clear.0001.exr").string())));
  }
}

TEST_F(FilterVerb, SequencesThatDoNotFitAreRefused) {
  ASSERT_EQ(run("teleport -o raw.####.exr --frames 2 --size 32x24 --aa none --aov depth,motion"), 0) << output_;
  ASSERT_EQ(run("teleport -o bare.####.exr --frames 2 --size 32x24 --aa none"), 0) << output_;
  ASSERT_EQ(run("teleport -o large.####.exr --frames 2 --size 48x36 --aa none --aov depth,motion"), 0) << output_;
  const auto message = [&](const std::string& arguments, int code) {
    EXPECT_EQ(run("filter " + arguments), code) << output_;
    EXPECT_FALSE(exists("out/raw.0000.exr"));
    return output_;
  };
  EXPECT_NE(message("bare.####.exr --aa taa -o out", 3).find("bare.0000.exr: has no channel of depth: give --depth"),
            std::string::npos);
  EXPECT_NE(output_.find("--upscale learned-still"), std::string::npos);
  EXPECT_NE(message("raw.####.exr --depth large.####.exr --aa taa -o out", 3)
                .find("large.0000.exr: has 48x36 pixels, expected 32x24 as ./raw.0000.exr"),
            std::string::npos)
      << output_;
  EXPECT_NE(message("raw.####.exr --depth raw.0000.exr --aa taa -o out", 3).find("has 1 frames, expected 2"),
            std::string::npos)
      << output_;
  save("short.txt", {'0', ' ', '0', '\n'});
  EXPECT_NE(message("raw.####.exr --jitter short.txt --aa taa -o out", 3).find("short.txt: has 1 samples, expected 2"),
            std::string::npos)
      << output_;
  save("wrong.txt", {'0', ' ', '2', '\n'});
  EXPECT_NE(message("raw.####.exr --jitter wrong.txt --aa taa -o out", 3).find("wrong.txt:1: is '0 2', expected"),
            std::string::npos)
      << output_;
  EXPECT_NE(message("raw.####.exr --motion raw.####.exr --aa smaa -o out", 2).find("methods with history"),
            std::string::npos)
      << output_;
  EXPECT_NE(message("raw.####.exr --upscale oracle-taau -o out", 2)
                .find("--upscale: oracle-taau needs a scene, expected one of bilinear, bicubic, lanczos, fsr1, nis, "
                      "sgsr1, learned-still, learned-table-still, fsr2, fsr3, sgsr2, taau, learned, learned-table"),
            std::string::npos)
      << output_;
  EXPECT_NE(message("raw.####.exr --aa taa --upscale fsr2 -o out", 2).find("antialiases itself"), std::string::npos)
      << output_;
}

}  // namespace
}  // namespace zoneplate::cli
