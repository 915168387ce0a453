// SPDX-License-Identifier: Apache-2.0
// Broken files of every format, each with its verdict: the command refuses it with one line that names the file and the
// place, or draws what can be drawn and warns; at once, in little memory, and without leaving anything half written.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "verbs_for_test.h"
#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/base/shared_files_for_test.h"
#include "zoneplate/codec/jpeg_encode.h"
#include "zoneplate/codec/png.h"

namespace {

namespace fs = std::filesystem;

/// How much longer the program may take than without a sanitizer.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int slower = 20;
#else
constexpr int slower = 1;
#endif

struct RunResult {
  int code = -1;
  std::string err;
  double seconds = 0;
  long megabytes = 0;
};

RunResult run(std::vector<std::string> words, const fs::path& err) {
  std::string program = zoneplate::program_file;
  std::vector<char*> arguments{program.data()};
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(::open("/dev/null", O_WRONLY), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    ::execv(zoneplate::program_file, arguments.data());
    ::_exit(127);
  }
  int status = 0;
  rusage usage{};
  while (::wait4(child, &status, WNOHANG, &usage) == 0) {
    if (seconds() > 20 * slower) ::kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  std::stringstream text;
  text << std::ifstream(err).rdbuf();
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text.str(), seconds(),
          usage.ru_maxrss / 1024};
}

using Bytes = std::string;

/// A file and what the command must say of it.
struct Case {
  std::string name;
  Bytes bytes;
  int code = 3;       ///< 3: refused; 0: drawn
  std::string words;  ///< part of the error, or of the warning; empty: nothing may be said
};

Bytes replaced(Bytes text, std::string_view what, std::string_view by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, Bytes::npos) << what;
  return at == Bytes::npos ? text : text.replace(at, what.size(), by);
}

Bytes little_endian(std::uint32_t word) {
  Bytes out;
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<char>(word >> (8 * i) & 0xff));
  return out;
}

template <class T>
Bytes bytes_of(const T& container) {
  return {container.begin(), container.end()};
}

const Bytes obj_box =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    "f 1 2 3 4\n";

std::vector<Case> obj_cases() {
  return {{"whole.obj", obj_box, 0, ""},
          {"empty.obj", "", 3, "holds no faces, lines or points"},
          {"comments.obj", "# nothing\n", 3, "holds no faces, lines or points"},
          {"no-vertices.obj", "f -4 -3 -2", 3,
           "line 1: face with the corner '-4' (0 vertices) is dropped; nothing is left"},
          {"index-past-end.obj", obj_box + "f 1 2 9\n", 0, "line 6: face with the corner '9' (4 vertices) is dropped"},
          {"index-zero.obj", obj_box + "f 0 1 2\n", 0, "line 6: face with the corner '0' (4 vertices) is dropped"},
          {"index-before-begin.obj", obj_box + "f -1 -2 -5\n", 0,
           "line 6: face with the corner '-5' (4 vertices) is dropped"},
          {"huge-index.obj", obj_box + "f 1 2 99999999999999999999\n", 0,
           "line 6: face with the corner '99999999999999999999' (4 vertices) is dropped"},
          {"few-corners.obj", "v 0 0 0\nv 1 0 0\nf 1\nf 1 2\n", 3,
           "line 3: face has too few corners and is dropped (and 1 more); nothing is left"},
          {"few-corners-and-more.obj", obj_box + "f 1\nf 1 2\n", 0,
           "line 6: face has too few corners and is dropped (and 1 more)"},
          {"not-finite.obj", "v nan 0 0\nv inf 0 0\nv 0 -inf 0\n" + obj_box + "f 4 5 6\nf 1 2 3\n", 0,
           "2 faces, lines or points have a vertex that is not finite"},
          {"no-number.obj", "v 0 zero 0\n" + obj_box, 3, "line 1: vertex: 'zero' is not a number"},
          {"no-library.obj", "mtllib gone.mtl\nusemtl red\n" + obj_box, 0, "material library gone.mtl: not found"},
          {"binary.obj", Bytes("\0\1\2\3", 4), 3, "holds no faces, lines or points"}};
}

std::vector<Case> stl_cases() {
  const Bytes facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  const Bytes header(80, ' '), triangle(50, '\0');
  return {{"whole.stl", "solid a\n" + facet + "endsolid a\n", 0, ""},
          {"empty.stl", "", 3, "neither ASCII STL nor binary STL: 0 bytes"},
          {"no-triangles.stl", "solid Empty\nendsolid Empty", 3, "holds no triangles"},
          {"cut.stl", ("solid a\n" + facet).substr(0, 60), 3, "line 5: '' is not a number"},
          {"no-number.stl", "solid a\n" + replaced(facet, "vertex 1 0 0", "vertex one 0 0") + "endsolid\n", 3,
           "line 5: 'one' is not a number"},
          {"claims-more.stl", header + little_endian(1000000) + triangle, 0,
           "its header states 1000000 triangles, the file has 1, which are drawn"},
          {"claims-2^32.stl", header + little_endian(0xffffffffu) + triangle, 0,
           "its header states 4294967295 triangles, the file has 1, which are drawn"},
          {"cut-off.stl", header + little_endian(2) + triangle + triangle.substr(1), 3,
           "or cut off: its header states 2 triangles, the file has 1"},
          {"claims-none.stl", header + little_endian(0), 3, "holds no triangles"}};
}

std::vector<Case> ply_cases() {
  const Bytes whole =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  return {{"whole.ply", whole, 0, ""},
          {"empty.ply", "", 3, "does not begin with 'ply'"},
          {"no-end.ply", whole.substr(0, 60), 3, "line 5: the header has no end_header"},
          {"not-text.ply", replaced(whole, "element vertex 3", Bytes("element\0 vertex 3", 17)), 3,
           "line 3: the header is not text"},
          {"unknown-format.ply", replaced(whole, "ascii", "utf-16"), 3, "line 2: format 'utf-16'"},
          {"unknown-type.ply", replaced(whole, "property float y", "property quad y"), 3,
           "line 5: property: 'quad' is not a type"},
          {"list-vertices.ply", replaced(whole, "property float x", "property list uchar float x"), 3,
           "element vertex: has no x, y and z"},
          {"index-past-end.ply", replaced(whole, "3 0 1 2", "3 0 1 3"), 3, "face 0 uses vertex 3, there are 3"},
          {"negative-index.ply", replaced(whole, "3 0 1 2", "3 0 1 -1"), 3, "face 0 uses vertex -1, there are 3"},
          {"claims-more.ply", replaced(whole, "vertex 3", "vertex 4000000000"), 3, "element vertex: 4000000000 rows"},
          {"negative-count.ply", replaced(whole, "vertex 3", "vertex -3"), 3,
           "line 3: element vertex: '-3' is not a number of elements"},
          {"cut.ply", whole.substr(0, whole.size() - 12), 3, "element vertex: 3 rows of"},
          {"not-finite.ply", replaced(whole, "1 0 0", "nan 0 0"), 3,
           "1 primitives have a vertex that is not finite and are dropped; nothing is left"}};
}

// One triangle in 42 bytes.
const Bytes gltf_whole =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
    R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"accessors":[)"
    R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
    R"({"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],"bufferViews":[)"
    R"({"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],"buffers":[{"byteLength":42,"uri":)"
    R"("data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"}]})";

Case damaged_gltf(const std::string& name, std::string_view what, std::string_view by, int code,
                  const std::string& words) {
  return {name + ".gltf", replaced(gltf_whole, what, by), code, words};
}

std::vector<Case> gltf_cases() {
  return {
      {"whole.gltf", gltf_whole, 0, ""},
      {"empty.gltf", "", 3, "not JSON"},
      {"cut.gltf", gltf_whole.substr(0, 200), 3, "not JSON"},
      {"deep.gltf", Bytes(100000, '['), 3, "JSON nested deeper than 64"},
      {"no-scene.gltf", R"({"asset":{"version":"2.0"},"scene":0})", 3, "scene is 0, expected an index below 0"},
      {"nothing.gltf", R"({"asset":{"version":"2.0"}})", 0, "nothing in the scene can be drawn"},
      damaged_gltf("version", "2.0", "1.0", 3, "glTF 1.0: "),
      damaged_gltf("needs-extension", R"("scene":0,)", R"("scene":0,"extensionsRequired":["EXT_none"],)", 3,
                   "requires the extension 'EXT_none'"),
      damaged_gltf("scene-wrong-type", R"("scene":0)", R"("scene":"hello")", 3, "scene is a string, expected a number"),
      damaged_gltf("primitives-no-array", R"([{"attributes":{"POSITION":0},"indices":1}])", R"({"a":[0]})", 3,
                   "mesh 0: primitives is an object, expected an array"),
      damaged_gltf("recursive-nodes", R"([{"mesh":0}],"meshes)", R"([{"mesh":0,"children":[0]}],"meshes)", 3,
                   "node 0: is reached twice"),
      damaged_gltf("no-node", R"("nodes":[0])", R"("nodes":[7])", 3, "scene 0: nodes holds 7"),
      damaged_gltf("no-mesh", R"({"mesh":0})", R"({"mesh":1})", 3, "node 0: mesh is 1, expected an index below 1"),
      damaged_gltf("no-accessor", R"("POSITION":0)", R"("POSITION":9)", 3,
                   "mesh 0 primitive 0: POSITION is 9, expected an index below 2"),
      damaged_gltf("no-buffer-view", R"("bufferView":0)", R"("bufferView":1000000)", 3,
                   "bufferView is 1000000, expected an index below 2"),
      damaged_gltf("no-buffer", R"("buffer":0,"byteLength":36)", R"("buffer":5,"byteLength":36)", 3,
                   "bufferView 0: buffer is 5, expected an index below 1"),
      damaged_gltf("view-past-end", R"("byteOffset":36)", R"("byteOffset":37)", 3,
                   "indices (accessor 1): it holds 5 bytes, expected 6"),
      damaged_gltf("accessor-past-end", R"("count":3,"type":"VEC3")", R"("count":4,"type":"VEC3")", 3,
                   "it holds 36 bytes, expected 48 (4 elements)"),
      damaged_gltf("count-1e300", R"("count":3,"type":"VEC3")", R"("count":1e300,"type":"VEC3")", 3, "count is 1e+300"),
      damaged_gltf("count-2^53", R"("count":3,"type":"VEC3")", R"("count":9007199254740992,"type":"VEC3")", 3,
                   "(9007199254740992 elements)"),
      damaged_gltf("negative-length", R"("byteLength":36)", R"("byteLength":-36)", 3,
                   "bufferView 0: byteLength is -36"),
      damaged_gltf("buffer-too-long", R"("byteLength":42)", R"("byteLength":43)", 3,
                   "buffer 0: holds 42 bytes, expected 43"),
      damaged_gltf("no-base64", "AAAAAAAAAAAAAAAAAACAPwAA", "AA*AAAAAAAAAAAAAAACAPwAA", 3,
                   "buffer 0: its data: URI is not base64"),
      damaged_gltf("no-file", R"("data:application/octet-stream;base64,)", R"("gone.bin?)", 3, "gone.bin"),
      damaged_gltf("component-type", "5123", "5999", 3, "componentType is 5999"),
      damaged_gltf("index-type", "5123", "5126", 3, "it holds 6 bytes, expected 12 (3 elements)"),
      damaged_gltf("position-type", "VEC3", "VEC2", 3, "type is VEC2, expected VEC3"),
      damaged_gltf("index-past-end", "AAABAAIA", "AAABAAMA", 3, "index 2 is 3, but POSITION has 3 elements"),
      damaged_gltf("not-finite", "AACAPwAA", "AACAfwAA", 0, "mesh 0 primitive 0: vertices that are not finite"),
      {"no-file-of-image.gltf",
       replaced(replaced(gltf_whole, R"("indices":1)", R"("indices":1,"material":0)"), R"("scene":0,)",
                R"("scene":0,"images":[{"uri":"gone.png"}],"textures":[{"source":0}],"materials":[)"
                R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],)"),
       0, "gone.png: cannot be read"}};
}

std::vector<Case> glb_cases() {
  Bytes json = gltf_whole;
  json.append((4 - json.size() % 4) % 4, ' ');
  const auto size = static_cast<std::uint32_t>(json.size());
  const auto glb = [&](std::uint32_t version, std::uint32_t length, std::uint32_t chunk, const Bytes& rest) {
    return "glTF" + little_endian(version) + little_endian(length) + little_endian(chunk) + "JSON" + json + rest;
  };
  const Bytes no_bytes = little_endian(0) + Bytes("BIN\0", 4);
  return {
      {"whole.glb", glb(2, 20 + size, size, ""), 0, ""},
      {"empty-chunk.glb", glb(2, 28 + size, size, no_bytes), 0, ""},
      {"empty.glb", "", 3, "not JSON"},
      {"header-alone.glb", "glTF" + little_endian(2) + little_endian(12), 3, "GLB of 12 bytes, expected at least 20"},
      {"version-1.glb", glb(1, 20 + size, size, ""), 3, "glTF 1.0: "},
      {"longer-than-file.glb", glb(2, 200 + size, size, ""), 3, "the file has 536"},
      {"chunk-past-end.glb", glb(2, 20 + size, size + 40, ""), 3,
       "GLB chunk at byte 12 states 556 bytes, but 516 are left"},
      {"chunk-2^32.glb", glb(2, 20 + size, 0xfffffff0u, ""), 3, "GLB chunk at byte 12 states 4294967280 bytes"},
      {"cut.glb", glb(2, 20 + size, size, "").substr(0, 100), 3, "the file has 100"}};
}

std::vector<Case> image_cases() {
  using namespace zoneplate;
  Rgba8Image picture(24, 20, Rgba8{0, 0, 0, 255});
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 24; ++x) picture(x, y).r = static_cast<std::uint8_t>(x * y % 251);
  const Bytes png = bytes_of(encode_png(picture)), jpeg = bytes_of(encode_jpeg(picture));
  const std::size_t data = png.find("IDAT");
  const auto changed = [](Bytes bytes, std::size_t at) {
    bytes.at(at) = static_cast<char>(bytes[at] ^ 0x11);
    return bytes;
  };
  const Bytes hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
  return {{"whole.png", png, 0, ""},
          {"empty.png", "", 3, "is no known image"},
          {"signature-alone.png", png.substr(0, 8), 3, "PNG: the file is truncated"},
          {"line-ends.png", replaced(png, "\r\n", "\n"), 3, "not a PNG file"},
          {"header-checksum.png", changed(png, 30), 3, "PNG: IHDR: CRC error"},
          {"damaged-data.png", changed(png, data + 9), 3, "PNG: IDAT"},
          {"data-checksum.png", changed(png, png.size() - 14), 3, "PNG: IDAT: CRC error"},
          {"no-data.png", png.substr(0, 33) + png.substr(png.size() - 12), 3, "PNG: IEND: out of place"},
          {"cut.png", png.substr(0, png.size() - 40), 3, "PNG: the file is truncated"},
          {"whole.jpg", jpeg, 0, ""},
          {"cut.jpg", jpeg.substr(0, jpeg.size() - 60), 0, "JPEG: Premature end"},
          {"header-alone.jpg", jpeg.substr(0, 20), 3, "JPEG: JPEG datastream contains no image"},
          {"bad-resolution.hdr", hdr + "-Y 4 +Z 4\n" + Bytes(64, 'a'), 3, "HDR: the header is wrong"},
          {"huge-resolution.hdr", hdr + "-Y 2000000000 +X 2000000000\n", 3, "at most 268435456 are allowed"},
          {"cut.hdr", hdr + "-Y 4 +X 4\nabcd", 3, "HDR: the file ends early"},
          {"another-type.hdr", "P6\n4 4\n255\n", 3, "is no known image"}};
}

/// How the command is asked to read a file of this name; nothing for what only belongs to another file.
std::vector<std::string> command_for(const fs::path& file) {
  const std::string extension = file.extension().string();
  std::vector<std::string> words;
  for (const char* model : {".gltf", ".glb", ".obj", ".ply", ".stl"})
    if (extension == model) words = {"render", "--size", "64x64"};
  for (const char* image : {".png", ".jpg", ".hdr"})
    if (extension == image) words = {"signal", "spectrum"};
  if (words.empty()) return words;
  words.push_back(file.string());
  words.push_back("-o");
  return words;
}

class InvalidFiles : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "zoneplate_invalid_XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder = name;
    fs::create_directory(folder / "out");
  }
  void TearDown() override { fs::remove_all(folder); }

  // Judges the command's answer; what it wrote is removed.
  void judge(const fs::path& file, int code, const std::string& words) const {
    std::vector<std::string> command = command_for(file);
    const fs::path out = folder / "out" / "image.png";
    command.push_back(out.string());
    const RunResult r = run(command, folder / "err");
    const std::string about = file.string() + ": " + r.err;
    EXPECT_EQ(r.code, code) << about;
    EXPECT_EQ(r.code == 0, fs::exists(out)) << about;
    EXPECT_TRUE(r.err.starts_with(code == 3       ? "zoneplate: error: "
                                  : words.empty() ? ""
                                                  : "zoneplate: warning: "))
        << about;
    EXPECT_NE(r.err.find(words), std::string::npos) << about << " lacks: " << words;
    if (words.empty()) {
      EXPECT_TRUE(r.err.empty()) << about;
    } else {
      EXPECT_NE(r.err.find(file.filename().string()), std::string::npos) << about;
    }
    if (r.code == 3) {
      EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << about;
    }
    EXPECT_LT(r.seconds, 5 * slower) << about;
    EXPECT_LT(r.megabytes, 1024) << about;
    fs::remove(out);
    EXPECT_TRUE(fs::is_empty(folder / "out")) << about;
  }
  /// Gives the file to every verb that reads its kind: each refuses or takes it as the first one does.
  void judge_by_every_verb(const fs::path& file, int code) const {
    const bool is_image = command_for(file)[0] == "signal";
    for (const zoneplate::FileCommand& command : is_image ? zoneplate::image_commands() : zoneplate::model_commands()) {
      const fs::path out = folder / "out" / "image.png";
      std::vector<std::string> words = command.with(file.string(), out.string());
      words.insert(words.end(), {"--max-memory", "200M", "--max-import-seconds", std::to_string(2 * slower),
                                 "--max-seconds", std::to_string(10 * slower)});
      const RunResult r = run(words, folder / "err");
      const std::string about = command.name + ' ' + file.string() + ": " + r.err;
      const int refused = command.writes_always ? 5 : 3;
      EXPECT_TRUE(r.code == (code == 3 ? refused : 0) || (code == 0 && is_image && r.code == 3)) << r.code << about;
      std::size_t errors = 0;
      for (std::size_t at = 0; (at = r.err.find("zoneplate: error: ", at)) != std::string::npos; ++at) ++errors;
      EXPECT_EQ(errors, r.code == 0 ? 0u : command.writes_always ? 2u : 1u) << about;  // one of the sheet itself
      EXPECT_EQ(r.err.find("crashed"), std::string::npos) << about;
      EXPECT_LT(r.seconds, 15 * slower) << about;
      EXPECT_EQ(fs::exists(out), command.name != "info" && r.code != 3) << about;
      fs::remove_all(out);
      EXPECT_TRUE(fs::is_empty(folder / "out")) << about;
    }
  }
  void judge(const std::vector<Case>& cases) const {
    for (const Case& c : cases) {
      const fs::path file = folder / c.name;
      std::ofstream(file, std::ios::binary) << c.bytes;
      judge(file, c.code, c.words);
      judge_by_every_verb(file, c.code);
      fs::remove(file);
    }
  }
  fs::path folder;
};

TEST_F(InvalidFiles, Obj) { judge(obj_cases()); }
TEST_F(InvalidFiles, Stl) { judge(stl_cases()); }
TEST_F(InvalidFiles, Ply) { judge(ply_cases()); }
TEST_F(InvalidFiles, Gltf) { judge(gltf_cases()); }
TEST_F(InvalidFiles, Glb) { judge(glb_cases()); }
TEST_F(InvalidFiles, Images) { judge(image_cases()); }

// Files of others that are invalid, where they lie beside the sources. One of them is sound: its last chunk is empty.
class SharedInvalidFiles : public InvalidFiles, public testing::WithParamInterface<std::string> {};
TEST_P(SharedInvalidFiles, AreRefusedOrDrawnWithAWarning) {
  const fs::path file = GetParam();
  const std::string name = file.filename().string();
  if (name == "zero-sized-bin-chunk-issue-440.glb") return judge(file, 0, "");
  const bool is_drawn = name == "test-nan.obj" || name == "malformed.obj" || name == "BoxWithInfinites.glb" ||
                        name.starts_with("invalid-buffer") || name == "invalid-primitive-indices.gltf";
  judge(file, is_drawn ? 0 : 3, is_drawn ? "warning: " : "error: ");
}
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SharedInvalidFiles);
INSTANTIATE_TEST_SUITE_P(Files, SharedInvalidFiles,
                         testing::ValuesIn(zoneplate::shared_files_ending(
                             "data/invalid", {".gltf", ".glb", ".obj", ".ply", ".stl", ".png", ".jpg", ".hdr"})));

}  // namespace
