// SPDX-License-Identifier: Apache-2.0
// The command as its users meet it: streams, exit codes, files, signals. Runs the built program.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/os/program_for_test.h"
#include "zoneplate/report/json_for_test.h"

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

using zoneplate::text_of;

struct Result {
  int code = -1;
  std::string out, err;
};

// Runs the program in an empty folder of its own, which is removed at the end.
class Cli : public zoneplate::ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    fs::create_directory(place / "work");
  }

  // Starts the program with stdout to `out` (a path) and stderr to a file.
  pid_t start(Words words, const std::string& out, const Words& environment = {}) const {
    const std::string err = (place / "stderr").string(), work = (place / "work").string();
    words.insert(words.begin(), zoneplate::program_file);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const pid_t child = ::fork();
    if (child != 0) return child;
    for (const std::string& setting : environment) ::putenv(const_cast<char*>(setting.c_str()));
    ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    if (::chdir(work.c_str()) == 0) ::execv(zoneplate::program_file, arguments.data());
    ::_exit(127);
  }

  Result finish(pid_t child) const {
    int status = 0;
    ::waitpid(child, &status, 0);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
    return {code, text_of(place / "stdout"), text_of(place / "stderr")};
  }

  Result run(const Words& words, const Words& environment = {}) const {
    return finish(start(words, (place / "stdout").string(), environment));
  }

  // The names of the files that the program left in its folder.
  Words files() const {
    Words names;
    for (const auto& entry : fs::directory_iterator(place / "work")) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }
};

bool is_png(const std::string& bytes) { return bytes.starts_with("\x89PNG\r\n\x1a\n") && bytes.size() > 100; }

const Words small = {"triangles", "--size", "32,24", "--progress", "none"};

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST_F(Cli, WithoutArgumentsPrintsAShortHelp) {
  const Result result = run({});
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.out.find("Usage: zoneplate"), std::string::npos);
  EXPECT_NE(result.out.find("-o teapot.png"), std::string::npos);
  EXPECT_LT(std::count(result.out.begin(), result.out.end(), '\n'), 30);
  EXPECT_EQ(result.err, "");
}

TEST_F(Cli, HelpGoesToStdout) {
  for (const Words& words : {Words{"-h"}, Words{"--help"}, Words{"help"}, Words{"render", "-h"},
                             Words{"render", "--help"}, Words{"help", "info"}, Words{"list", "--help"}}) {
    const Result result = run(words);
    EXPECT_EQ(result.code, 0);
    EXPECT_NE(result.out.find("Usage: zoneplate"), std::string::npos);
    EXPECT_EQ(result.err, "");
  }
}

TEST_F(Cli, VersionTellsInstructionSetAndCompiler) {
  const Result result = run({"--version"});
  EXPECT_EQ(result.code, 0);
  EXPECT_TRUE(result.out.starts_with("zoneplate 0.")) << result.out;
  EXPECT_NE(result.out.find(")\n"), std::string::npos);
  // The commit, the licence and what it is linked with, as bug reports and security notices refer to them.
  EXPECT_NE(result.out.find("\ncommit "), std::string::npos);
  EXPECT_NE(result.out.find("\nlicence Apache-2.0\n"), std::string::npos);
  EXPECT_NE(result.out.find("\nUses Jimenez's MLAA. Copyright (C) 2010 "),
            std::string::npos);  // as its licence demands
  for (const char* library : {"libpng ", "zlib ", "libjpeg-turbo ", "libwebp ", "FreeType ", "Draco ", "libseccomp ",
                              "expat ", "fmt ", "Highway ", "JSON for Modern C++ ", "CLI11 "}) {
    const std::size_t at = result.out.find(library);
    ASSERT_NE(at, std::string::npos) << library;
    const char digit = result.out[at + std::string_view(library).size()];
    EXPECT_TRUE(digit >= '0' && digit <= '9') << library << digit;
  }
}

TEST_F(Cli, WritesAPictureAndNothingElse) {
  const Result result = run(with(small, {"-o", "a.png"}));
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(files(), Words{"a.png"});
  EXPECT_TRUE(is_png(text_of(place / "work/a.png")));
}

TEST_F(Cli, APictureOfNothingIsWarnedAbout) {
  const Result result =
      run(with(small, {"-o", "a.png", "--camera-position", "0,0,9", "--camera-focal-point", "0,0,99"}));
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err, "zoneplate: warning: triangles: nothing of it is in view; see the camera options\n");
}

TEST_F(Cli, TheSameCallGivesTheSameBytesOnStdout) {
  ASSERT_EQ(run(with(small, {"-o", "a.png"})).code, 0);
  const Result result = run(with(small, {"-o", "-"}));
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(result.out, text_of(place / "work/a.png"));
}

TEST_F(Cli, OptionsStandAnywhere) {
  ASSERT_EQ(run(with(small, {"-o", "a.png"})).code, 0);
  ASSERT_EQ(run({"--resolution=32x24", "-o", "b.png", "--progress=none", "--", "triangles"}).code, 0);
  EXPECT_EQ(text_of(place / "work/a.png"), text_of(place / "work/b.png"));
}

TEST_F(Cli, JsonIsOneLineThatTellsWhatWasDone) {
  const Result result = run(with(small, {"-o", "a.png", "--json", "--aov", "depth,object-id", "-t", "2"}));
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 1);
  const auto json = zoneplate::parsed_json(result.out);
  EXPECT_EQ(json["output"], "a.png");
  EXPECT_EQ(json["width"], 32);
  EXPECT_EQ(json["height"], 24);
  EXPECT_EQ(json["method"], "msaa:n=8,alpha=samples");
  EXPECT_EQ(json["triangles"], 2);
  EXPECT_EQ(json["format"], "zoneplate-render");
  EXPECT_EQ(json["version"], 2);
  EXPECT_EQ(json["data_passes"]["depth"], "a.depth.png");
  EXPECT_GT(json["stage_ms"]["total"], 0);
  EXPECT_GT(json["peak_memory_bytes"], 1000000);
  EXPECT_EQ(json["warnings"].size(), 0u);
  EXPECT_EQ(files(), (Words{"a.depth.png", "a.object-id.png", "a.png"}));
}

TEST_F(Cli, JsonMakesWayForAPictureOnStdout) {
  const Result result = run(with(small, {"-o", "-", "--json"}));
  EXPECT_TRUE(is_png(result.out));
  EXPECT_EQ(zoneplate::parsed_json(result.err)["output"], "-");
}

TEST_F(Cli, ProgressIsForTerminalsUnlessAskedFor) {
  const Result result = run({"triangles", "--size", "32,24", "-o", "a.png", "--progress", "json"});
  std::istringstream lines(result.err);
  std::string line;
  int count = 0;
  while (std::getline(lines, line)) {
    ++count;
    EXPECT_TRUE(zoneplate::parsed_json(line).contains("stage"));
  }
  EXPECT_GE(count, 3);
  EXPECT_EQ(run({"triangles", "--size", "32,24", "-o", "a.png"}).err, "");
}

TEST_F(Cli, ListAndInfoSpeakTextAndJson) {
  EXPECT_NE(run({"list"}).out.find("msaa"), std::string::npos);
  EXPECT_EQ(run({"list", "scenes"}).out.find("msaa"), std::string::npos);
  const auto list = zoneplate::parsed_json(run({"list", "--json"}).out);
  EXPECT_EQ(list["format"], "zoneplate-list");
  EXPECT_EQ(list["methods"][0]["name"], "none");
  EXPECT_GE(list["scenes"].size(), 6u);
  EXPECT_EQ(list["formats"]["models"][0]["extension"], ".gltf");

  EXPECT_NE(run({"info", "triangles"}).out.find("2 drawn"), std::string::npos);
  const auto info = zoneplate::parsed_json(run({"info", "triangles", "--json"}).out);
  EXPECT_EQ(info["triangles"], 2);
  EXPECT_EQ(info["vertices"], 6);
  EXPECT_EQ(info["cameras"].size(), 1u);
}

// One error line, nothing on stdout, no file.
struct Refusal {
  int code;
  Words words;
  std::string message;
};

TEST_F(Cli, ErrorsAreOneLineWithTheDocumentedCode) {
  { std::ofstream(place / "work/bad.gltf") << "{"; }
  { std::ofstream(place / "work/text.xyz") << "x"; }
  fs::create_directory(place / "work/folder.png");
  const Words before = files();
  const Refusal refusals[] = {
      {2, {"triangles", "--outptu", "a.png"}, "unknown option --outptu; did you mean --output?"},
      {2, {"rendr", "triangles", "-o", "a.png"}, "rendr: no such verb; did you mean render?"},
      {2, {"triangles"}, "no output: give -o OUT.png, or -o - for stdout"},
      {2, {"-o", "a.png"}, "no input: give a model or a built-in scene"},
      {2,
       {"triangles", "teapot", "-o", "a.png"},
       "several inputs require a folder as output, as pictures/, or {model} in its name, as pictures/{model}.png"},
      {2, {"triangles", "a.png"}, "no output: did you mean -o a.png?"},
      {2, {"triangles", "-o", "{nodel}.png"}, "--output: there is no placeholder {nodel}; did you mean {model}?"},
      {2,
       {"triangles", "-o", "a.jpg", "--no-background"},
       "a.jpg: the image is not opaque, and JPEG has no alpha: write a .png or a .webp, or give it a background"},
      {2, {"triangles", "-o", "a.png", "--out", "a.png"}, "unknown option --out; did you mean --output?"},
      {2,
       {"triangles", "-o", "a.png", "--camera-ortho"},
       "unknown option --camera-ortho; did you mean --camera-orthographic?"},
      {2,
       {"triangles", "-o", "a.png", "--elevation", "3"},
       "unknown option --elevation; did you mean --camera-elevation-angle?"},
      {2,
       {"triangles", "-o", "a.png", "-j", "2"},
       "--frame-jump requires a sequence: --frames, --frame-start, --frame-end or --turntable"},
      {2,
       {"triangles", "-o", "a.png", "--quality", "80"},
       "--quality: '80' is not one of fast, default, best; did you mean --jpeg-quality 80 or --webp-quality 80?"},
      {2,
       {"triangles", "-o", "a.png", "--jpeg-quality", "80"},
       "--jpeg-quality is for .jpg; --webp-quality is for .webp, and --png-compression for .png"},
      {2, {"triangles", "-o", "a.png", "--webp-quality", "80"}, "--webp-quality is for .webp"},
      {2, {"triangles", "-o", "a.jpg", "--png-compression", "small"}, "--png-compression is for .png"},
      {2,
       {"triangles", "-o", "a.exr", "--tone-mapping", "aces"},
       "--tone-mapping: .exr and .pfm contain linear light, before tone mapping"},
      {2,
       {"triangles", "-o", "a.png", "--frame-rate", "30"},
       "--frame-rate requires a sequence: --frames, --frame-start, --frame-end or --turntable"},
      {2, {"triangles", "-o", "a.png", "--shutter-samples", "3"}, "--shutter-samples requires --shutter"},
      {2,
       {"triangles", "-o", "a.png", "--preset", "x", "--no-config"},
       "--preset requires the configuration, which --no-config ignores"},
      {2,
       {"triangles", "-o", "a.png", "--texture-base-color", "a"},
       "unknown option --texture-base-color; did you mean --texture?"},
      {2,
       {"render", "--help=camra"},
       "'camra' is not one of image, input, sequences, batches, camera, materials-and-lights, teaching, running; did "
       "you mean camera?"},
      {2, {"completions", "csh"}, "'csh' is not one of bash, zsh, fish; did you mean zsh?"},
      {2,
       {"triangles", "-o", "a.xyz"},
       "--output: a.xyz is not a format that can be written (images: .png, .jpg, .webp, .avif, .jxl, .exr, .pfm, "
       ".rgba; videos: "
       ".apng, .webp, .gif, .mp4, .mov, .mkv, .webm)"},
      {2,
       {"triangles", "-o", "-", "--aov", "depth"},
       "--aov writes files next to OUT, which cannot be -; an .exr contains the passes"},
      {2,
       {"triangles", "-o", "a.png", "--aov", "error"},
       "triangles: --aov error: msaa:n=8,alpha=samples has no estimate of its error; converged and analytic have"},
      {2,
       {"triangles", "-o", "a.exr", "--aa", "fxaa"},
       "--anti-aliasing: fxaa works after tone mapping, and .exr is scene-linear: write a .png, or use "
       "a method such as msaa or ssaa"},
      {2,
       {"triangles", "-o", "-", "--output-format", "pfm", "--aa", "msaa:resolve=display"},
       "--anti-aliasing: msaa:resolve=display works after tone mapping, and .pfm is scene-linear: write "
       "a .png, or use a method such as msaa or ssaa"},
      {2,
       {"triangles", "-o", "a.png", "--size", "99999x1"},
       "--resolution: 99999x1 is too large: a side has at most 16384 pixels"},
      {2,
       {"triangles", "-o", "a.png", "--crop", "799,0,2,1"},
       "--crop: the rectangle is not inside the image of 800x600"},
      {2,
       {"triangles", "-o", "a.png", "--camera-index", "7"},
       "triangles: --camera-index: the scene has cameras 0 to 0, not 7"},
      {1,
       {"triangles", "-o", "a.png", "--size", "16384,16384", "--max-memory", "1G"},
       "triangles: an image of 16384x16384 needs 11 GB of memory, --max-memory allows 1 GB"},
      {2,
       {"list", "method"},
       "'method' is not one of methods, scenes, formats, texture-filters, upscalers; did you mean methods?"},
      {2, {"info"}, "info takes one input: a model or a built-in scene"},
      {3, {"triangels", "-o", "a.png"}, "triangels: no such file or scene; did you mean triangles?"},
      {3,
       {"text.xyz", "-o", "a.png"},
       "text.xyz: not a format that can be read (.gltf, .glb, .vrm, .obj, .ply, .stl, .3mf, .amf and others, see "
       "zoneplate list formats)"},
      {3, {"missing.xyz", "-o", "a.png"}, "missing.xyz: no such file, and no built-in scene of that name"},
      {4, {"triangles", "-o", "folder.png"}, "folder.png: is a directory; write into it with a / at its end"},
      {4, {"triangles", "-o", "missing/a.png"}, "missing/a.png: cannot be written: no directory missing"},
  };
  for (const Refusal& refusal : refusals) {
    const Result result = run(refusal.words);
    EXPECT_EQ(result.code, refusal.code) << refusal.message;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "zoneplate: error: " + refusal.message + "\n");
    EXPECT_EQ(files(), before);
  }
}

TEST_F(Cli, InputsThatCannotBeReadGive3AndTheirName) {
  { std::ofstream(place / "work/bad.gltf") << "{"; }
  { std::ofstream(place / "work/bad.obj") << "f 1 2 3\n"; }
  fs::create_directory(place / "work/folder.glb");
  const Words before = files();
  for (const std::string name : {"missing.glb", "bad.gltf", "bad.obj", "folder.glb"}) {
    const Result result = run({name, "-o", "a.png"});
    EXPECT_EQ(result.code, 3) << name;
    EXPECT_TRUE(result.err.starts_with("zoneplate: error: " + name + ": ")) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(files(), before);
  }
}

TEST_F(Cli, AFullOrClosedStdoutGives4) {
  const Result full = finish(start(with(small, {"-o", "-"}), "/dev/full"));
  EXPECT_EQ(full.code, 4);
  EXPECT_TRUE(full.err.starts_with("zoneplate: error: ")) << full.err;
  EXPECT_EQ(finish(start({"list"}, "/dev/full")).code, 4);
}

TEST_F(Cli, ControlCharactersDoNotReachTheTerminal) {
  const Result result = run({"a\x1b[2J\nb.glb", "-o", "a.png"});
  EXPECT_EQ(result.code, 3);
  EXPECT_EQ(result.err.find('\x1b'), std::string::npos);
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1);
}

TEST_F(Cli, ColoursFollowTheEnvironment) {
  const Words wrong = {"triangles"};
  EXPECT_EQ(run(wrong).err.find('\x1b'), std::string::npos);
  EXPECT_NE(run(wrong, {"CLICOLOR_FORCE=1"}).err.find("\x1b[1;31merror\x1b[0m"), std::string::npos);
  EXPECT_EQ(run(wrong, {"CLICOLOR_FORCE=0"}).err.find('\x1b'), std::string::npos);
  EXPECT_EQ(run(wrong, {"NO_COLOR=1"}).err.find('\x1b'), std::string::npos);
}

TEST_F(Cli, SignalsLeaveNoFile) {
  for (const int signal : {SIGINT, SIGTERM}) {
    fs::remove(place / "stderr");  // what the last run said must not be taken for this one's
    const pid_t child = start({"sphere:triangles=100000", "--size", "2048,2048", "--aa", "ssaa:n=16", "-o", "a.png",
                               "--progress", "json", "-t", "1"},
                              (place / "stdout").string());
    // It is in the middle of the image when its progress says so, and for seconds after.
    for (int i = 0; i < 2000 && text_of(place / "stderr").find("render") == std::string::npos; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ::kill(child, signal);
    EXPECT_EQ(finish(child).code, 128 + signal);
    EXPECT_EQ(files(), Words{});
  }
}

}  // namespace
