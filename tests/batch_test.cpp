// SPDX-License-Identifier: Apache-2.0
// Many images by one command: several inputs, manifests, shards, sequences. Runs the built program.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "zoneplate/base/paths_for_test.h"
#include "zoneplate/os/program_for_test.h"
#include "zoneplate/report/json_for_test.h"

namespace {

namespace fs = std::filesystem;

using zoneplate::text_of;

// Runs the program in an empty folder of its own, which is removed at the end.
class BatchRun : public zoneplate::ProgramTest {
 protected:
  // The exit code; stdout's lines are left in `lines`, stderr in `complaint`.
  int run(const std::string& arguments) {
    const std::string command = "cd '" + place.string() + "' && '" + zoneplate::program_file + "' " + arguments +
                                " >out.txt 2>err.txt </dev/null";
    const int status = std::system(command.c_str());
    lines.clear();
    std::istringstream out(text_of(place / "out.txt"));
    for (std::string line; std::getline(out, line);)
      if (line.starts_with("{")) lines.push_back(zoneplate::parsed_json(line));
    complaint = text_of(place / "err.txt");
    return WEXITSTATUS(status);
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(place / name) << text; }
  std::vector<std::string> pictures(const std::string& folder = ".") const {
    std::vector<std::string> out;
    for (const auto& entry : fs::directory_iterator(place / folder))
      if (entry.path().extension() == ".png") out.push_back(entry.path().filename().string());
    std::sort(out.begin(), out.end());
    return out;
  }

  std::vector<nlohmann::json> lines;
  std::string complaint;
};

TEST_F(BatchRun, SeveralInputsGiveALineEachAndFailuresExitFive) {
  EXPECT_EQ(run("teapot nothing.stl sphere:triangles=12 -o '{model}.png' --size 16x16"), 5);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0]["status"], "done");
  EXPECT_EQ(lines[1]["status"], "failed");
  EXPECT_NE(lines[1]["error"].get<std::string>().find("nothing.stl"), std::string::npos);
  EXPECT_EQ(lines[2]["output"], "sphere_triangles=12.png");
  EXPECT_NE(complaint.find("1 of 3 items failed"), std::string::npos);
  EXPECT_EQ(pictures(), (std::vector<std::string>{"sphere_triangles=12.png", "teapot.png"}));
  EXPECT_EQ(run("teapot triangles -o one.png"), 2);
}

TEST_F(BatchRun, PlaceholdersNameTheOutputsAndNoFileIsWrittenTwice) {
  write("shop.stl",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n");
  fs::create_directory(place / "old");
  fs::copy_file(place / "shop.stl", place / "old/shop.stl");
  EXPECT_EQ(run("shop.stl old/shop.stl -o '{model}.png' --size 8"), 2);
  EXPECT_NE(complaint.find("shop.stl and old/shop.stl would both be written to shop.png"), std::string::npos)
      << complaint;
  EXPECT_TRUE(pictures().empty());
  EXPECT_EQ(run("shop.stl old/shop.stl -o '{dir}/{model}_{ext}{index:2}.png' --size 8"), 0) << complaint;
  EXPECT_EQ(pictures(), (std::vector<std::string>{"shop_stl00.png"}));
  EXPECT_EQ(pictures("old"), (std::vector<std::string>{"shop_stl01.png"}));

  EXPECT_EQ(run("shop.stl -o thumbs/small/ --size 8"), 0) << complaint;  // one input is a batch too
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0]["output"], "thumbs/small/shop.png");
  EXPECT_EQ(pictures("thumbs/small"), (std::vector<std::string>{"shop.png"}));

  write("jobs.jsonl", R"({"input":"shop.stl","output":"{model}-a.png"})"
                      "\n"
                      R"({"input":"teapot","output":"shop-a.png"})"
                      "\n");
  EXPECT_EQ(run("--manifest jobs.jsonl --size 8"), 2);
  EXPECT_NE(complaint.find("jobs.jsonl: line 1 and jobs.jsonl: line 2 would both"), std::string::npos) << complaint;
}

TEST_F(BatchRun, ShardsOfAManifestMakeTheFilesOfOneRunAndGoOnWhereTheyWere) {
  std::string manifest;
  for (int i = 0; i < 7; ++i)
    manifest += R"({"input":"sphere:triangles=)" + std::to_string(12 * (i + 1) * (i + 1)) + R"(","output":"DIR/)" +
                std::to_string(i) + R"(.png","camera-azimuth-angle":)" + std::to_string(i * 10) +
                (i == 3 ? R"(,"no-background":true)" : "") + "}\n\n";
  for (const char* folder : {"whole", "parts"}) {
    fs::create_directory(place / folder);
    std::string text = manifest;
    for (std::size_t at = text.find("DIR"); at != text.npos; at = text.find("DIR")) text.replace(at, 3, folder);
    write(std::string(folder) + ".jsonl", text);
  }
  EXPECT_EQ(run("--manifest whole.jsonl --size 24x24"), 0) << complaint;
  EXPECT_EQ(lines.size(), 7u);
  for (const char* shard : {"0/3", "1/3", "2/3"})
    EXPECT_EQ(run(std::string("--manifest parts.jsonl --size 24x24 --shard ") + shard), 0) << complaint;
  ASSERT_EQ(pictures("whole").size(), 7u);
  EXPECT_EQ(pictures("whole"), pictures("parts"));
  for (const std::string& name : pictures("whole"))
    EXPECT_EQ(text_of(place / "whole" / name), text_of(place / "parts" / name)) << name;

  fs::remove(place / "parts" / "4.png");
  EXPECT_EQ(run("--manifest parts.jsonl --size 24x24 --skip-existing"), 0);
  ASSERT_EQ(lines.size(), 7u);
  for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(lines[i]["status"], i == 4 ? "done" : "skipped");
  EXPECT_EQ(text_of(place / "whole/4.png"), text_of(place / "parts/4.png"));
}

// The second item ends long before the first, and its large file waits in memory.
TEST_F(BatchRun, ItemsAtOnceGiveTheLinesAndFilesOfOneAtATime) {
  const std::string jobs =
      R"({"input":"sphere:triangles=300000","output":"DIR/a.png","size":"400x300"}
{"input":"teapot","output":"DIR/b.pfm","size":"900x700"}
{"input":"nothing.stl","output":"DIR/c.png"}
{"input":"checkerboard","output":"DIR/d.png"}
{"input":"checkerboard","output":"DIR/e.png","camera-azimuth-angle":40}
{"input":"teapot","output":"DIR/f.##.png","turntable":2}
{"input":"teapot","output":"DIR/g.png","siz":"8"}
{"input":"triangles","output":"DIR/h.png","max-seconds":60}
{"input":"triangles","output":"DIR/i.png","max-memory":"256M"}
)";
  std::vector<std::string> reports;
  for (const std::string folder : {"one", "two"}) {
    fs::create_directory(place / folder);
    std::string text = jobs;
    for (std::size_t at = text.find("DIR"); at != text.npos; at = text.find("DIR")) text.replace(at, 3, folder);
    write("jobs.jsonl", text);
    EXPECT_EQ(
        run("--manifest jobs.jsonl --size 64x48 --max-memory 512M -t " + std::string(folder == "one" ? "1" : "4")), 5)
        << complaint;
    std::string report = complaint;
    for (nlohmann::json& line : lines) {
      for (const char* name : {"output", "not_written", "stage_ms", "seconds", "threads", "peak_memory_bytes"})
        line.erase(name);
      report += line.dump() + '\n';
    }
    reports.push_back(report);
    EXPECT_EQ(lines.size(), 9u);
  }
  EXPECT_EQ(reports[0], reports[1]);
  int files = 0;
  for (const auto& entry : fs::directory_iterator(place / "one")) {
    EXPECT_EQ(text_of(entry.path()), text_of(place / "two" / entry.path().filename())) << entry.path();
    ++files;
  }
  EXPECT_EQ(files, 8);
}

TEST_F(BatchRun, AManifestsBadLinesAreNamed) {
  write("jobs.jsonl",
        "{\"input\":\"teapot\",\"output\":\"a.png\"}\n{]\n{\"output\":\"b.png\"}\n"
        "{\"input\":\"teapot\",\"output\":\"b.png\",\"siz\":\"8x8\"}\n"
        "{\"input\":\"tea\\u0000pot\",\"output\":\"b.png\"}\n"
        "{\"input\":\"teapot\",\"output\":\"b.png\",\"manifest\":\"jobs.jsonl\"}\n");
  EXPECT_EQ(run("--manifest jobs.jsonl --size 8x8"), 5);
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_EQ(lines[0]["status"], "done");
  EXPECT_NE(complaint.find("jobs.jsonl: line 2:"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find("jobs.jsonl: line 3: has no input"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find("jobs.jsonl: line 4: unknown option --siz; did you mean --size"), std::string::npos);
  EXPECT_NE(complaint.find("jobs.jsonl: line 5: input has a character of code 0"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find("jobs.jsonl: line 6: manifest is for all jobs together"), std::string::npos) << complaint;
}

TEST_F(BatchRun, TheShardIsReadFromTheScheduler) {
  write("jobs.jsonl",
        "{\"input\":\"teapot\",\"output\":\"out/0.png\"}\n{\"input\":\"teapot\",\"output\":\"out/1.png\"}\n");
  ::setenv("SLURM_ARRAY_TASK_ID", "1", 1), ::setenv("SLURM_ARRAY_TASK_COUNT", "1", 1);
  const int code = run("--manifest jobs.jsonl --size 8x8 --shard auto/2");
  const int without_count = run("--manifest jobs.jsonl --size 8x8 --shard auto");
  for (const char* name : {"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_COUNT"}) ::unsetenv(name);
  EXPECT_EQ(code, 0) << complaint;
  EXPECT_EQ(without_count, 2);
  EXPECT_NE(complaint.find("for example auto/10"), std::string::npos) << complaint;
  EXPECT_EQ(pictures("out"), (std::vector<std::string>{"1.png"}));
  EXPECT_EQ(run("--manifest jobs.jsonl --size 8x8 --shard 2/2"), 2);
}

TEST_F(BatchRun, TurntablesAreNumberedOrFilms) {
  EXPECT_EQ(run("teapot -o t.###.png --turntable 4 --size 32x24"), 0) << complaint;
  EXPECT_EQ(pictures(), (std::vector<std::string>{"t.000.png", "t.001.png", "t.002.png", "t.003.png"}));
  EXPECT_NE(text_of(place / "t.000.png"), text_of(place / "t.002.png"));
  EXPECT_EQ(run("teapot -o one.png --turntable 4 -s 2 -e 2 --size 32x24"), 0) << complaint;
  EXPECT_EQ(text_of(place / "t.002.png"), text_of(place / "one.png"));
  EXPECT_EQ(run("teapot -o t.png --turntable 4"), 2);
  EXPECT_EQ(run("teapot -o t.apng --turntable 3 --size 32x24"), 0) << complaint;
  const std::string film = text_of(place / "t.apng");
  EXPECT_NE(film.find("acTL"), std::string::npos);
  EXPECT_EQ(run("teapot -o t.webp --turntable 3 --size 32x24"), 0) << complaint;
  EXPECT_NE(text_of(place / "t.webp").find("ANIM"), std::string::npos);
}

// An untagged video is decoded by BT.601 or BT.709 depending on the player.
TEST_F(BatchRun, VideosAreTaggedAsBt709) {
  if (std::system("ffmpeg -version >/dev/null 2>&1 && ffprobe -version >/dev/null 2>&1") != 0)
    GTEST_SKIP() << "ffmpeg is not installed";
  for (const char* name : {"t.mp4", "t.mov", "t.mkv", "t.webm"}) {
    EXPECT_EQ(run(std::string("teapot --turntable 2 --size 64x48 --background '#f8d31c' -o ") + name), 0) << complaint;
    const std::string file = "'" + (place / name).string() + "'";
    const std::string probe = "ffprobe -v error -show_entries stream=color_space,color_range -of csv=p=0 " + file +
                              " >'" + (place / "tags.txt").string() + "'";
    ASSERT_EQ(std::system(probe.c_str()), 0);
    EXPECT_EQ(text_of(place / "tags.txt"), "tv,bt709\n") << name;
    const std::string decode = "ffmpeg -v error -i " + file +
                               " -vf scale=in_color_matrix=bt709,crop=1:1:0:0 -frames:v 1 "
                               "-f rawvideo -pix_fmt rgb24 -y '" +
                               (place / "pixel.rgb").string() + "'";
    ASSERT_EQ(std::system(decode.c_str()), 0);
    const std::string pixel = text_of(place / "pixel.rgb");
    ASSERT_EQ(pixel.size(), 3u);
    const int expected[] = {0xf8, 0xd3, 0x1c};
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(static_cast<unsigned char>(pixel[i]), expected[i], 4) << name;
  }
}

// A glTF of one triangle whose animation's last key is at `end` seconds.
std::string animated_triangle(const std::string& end) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
  "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
  "accessors":[{"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[0,0,0]},
  {"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[)" +
         end + R"(]},{"componentType":5126,"count":2,"type":"VEC3"}],
  "bufferViews":[{"buffer":0,"byteLength":8}],
  "buffers":[{"byteLength":8,"uri":"data:application/octet-stream;base64,AAAAAMrySXE="}],
  "animations":[{"samplers":[{"input":1,"output":2}],"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}]}]})";
}

TEST_F(BatchRun, AnItemFailsAloneWhateverItTakes) {
  write("long.gltf", animated_triangle("1e30"));
  const std::string long_name(300, 'x');
  write("jobs.jsonl",
        "{\"input\":\"teapot\",\"output\":\"a.png\"}\n"
        "{\"input\":\"teapot\",\"output\":\"" +
            long_name +
            ".####.png\",\"frames\":2,\"skip-existing\":true}\n"
            "{\"input\":\"sphere:triangles=50000000\",\"output\":\"b.png\",\"max-memory\":\"64M\"}\n"
            "{\"input\":\"teapot\",\"output\":\"c.png\",\"aa\":\"ssaa:n=16\",\"size\":\"4000x4000\",\"max-seconds\":0."
            "2}\n"
            "{\"input\":\"long.gltf\",\"output\":\"d.####.png\",\"frame-start\":0}\n"
            "{\"input\":\"teapot\",\"output\":\"jobs.jsonl/e.png\"}\n"
            "{\"input\":\"teapot\",\"output\":\"f.png\"}\n");
  EXPECT_EQ(run("--manifest jobs.jsonl --size 8x8 --aa none"), 5);
  ASSERT_EQ(lines.size(), 7u) << complaint;
  for (const std::size_t i : {std::size_t{0}, std::size_t{6}}) EXPECT_EQ(lines[i]["status"], "done") << i;
  const auto error = [&](std::size_t i) { return lines[i].value("error", ""); };
  EXPECT_NE(error(1).find("File name too long"), std::string::npos) << error(1);
  EXPECT_NE(error(2).find("sphere:triangles=50000000: "), std::string::npos) << error(2);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // whose allocators end the process by themselves
  EXPECT_NE(error(2).find("more memory than the limit of 64 MB (--max-memory)"), std::string::npos) << error(2);
#endif
  EXPECT_EQ(error(3), "teapot: takes longer than the limit of 0.2 s (--max-seconds)");
  EXPECT_NE(error(4).find("long.gltf: its animation ends at 1e+30 s, which is more than 100000 frames"),
            std::string::npos)
      << error(4);
  EXPECT_NE(error(5).find("jobs.jsonl: Not a directory"), std::string::npos) << error(5);
  EXPECT_EQ(pictures(), (std::vector<std::string>{"a.png", "f.png"}));
  EXPECT_EQ(run("long.gltf -o d.####.png --frame-start 0 --size 8x8"), 3) << complaint;
}

TEST_F(BatchRun, ASandboxedItemOpensTheLibraryThatItNeeds) {
  ASSERT_EQ(run("checkerboard -o board.exr --size 16x16"), 0) << complaint;
  write("quad.mtl", "newmtl a\nmap_Kd board.exr\n");
  write("quad.obj",
        "mtllib quad.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 "
        "4/4\n");
  EXPECT_EQ(run("quad.obj -o boxed.png --size 32x32"), 0) << complaint;
  EXPECT_EQ(complaint, "");
  EXPECT_EQ(run("quad.obj -o open.png --size 32x32 --no-sandbox"), 0) << complaint;
  EXPECT_EQ(text_of(place / "boxed.png"), text_of(place / "open.png"));
}

TEST_F(BatchRun, AContactSheetShowsEveryInputOrItsTrouble) {
  EXPECT_EQ(run("contact-sheet teapot nothing.obj triangles -o sheet.png --size 48x32"), 5) << complaint;
  EXPECT_EQ(pictures(), (std::vector<std::string>{"sheet.png"}));
  EXPECT_EQ(run("contact-sheet -o sheet.png"), 2);
}

}  // namespace
