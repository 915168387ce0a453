// SPDX-License-Identifier: Apache-2.0
// Tests of the verb that run the built program, and of the functions that it measures with.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <thread>

#include "zoneplate/antialias/methods.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/evaluate/compare/pictures.h"
#include "zoneplate/evaluate/compare/report.h"
#include "zoneplate/formats/gltf/maker_for_test.h"
#include "zoneplate/metrics/metrics.h"
#include "zoneplate/os/file.h"
#include "zoneplate/os/program_for_test.h"
#include "zoneplate/report/html_page_for_test.h"
#include "zoneplate/report/json_for_test.h"

namespace zoneplate {
namespace {

namespace fs = std::filesystem;

class CompareVerb : public ProgramTest {
 protected:
  std::string text_of(const std::string& name) const { return zoneplate::text_of(place / name); }
};

const metrics::Metric* metric_named(std::string_view name) {
  return metrics::choose_metric(metrics::metrics(), name).metric;
}

constexpr const char* small = " --size 64x48 --turns 1 --reference ssaa:n=4 ";

TEST_F(CompareVerb, WritesEverythingThatItsJsonNames) {
  const ProgramAnswer answer =
      run(std::string("compare triangles cyclic --aa none,ssaa:n=2,ssaa:pattern=halton,samples=8 -o out") + small);
  ASSERT_EQ(answer.code, 0) << answer.out;
  EXPECT_EQ(answer.out, text_of("out/compare.txt"));
  const auto json = parsed_json(text_of("out/compare.json"));
  EXPECT_EQ(json["format"], "zoneplate-compare");
  EXPECT_EQ(json["version"], report_version);
  ASSERT_EQ(json["scenes"].size(), 2u);
  std::size_t files = 5;  // cost.svg, compare.txt, compare.md, compare.csv, compare.json
  for (const auto& scene : json["scenes"]) {
    for (const auto& name : {scene["reference"]["image"], scene["crops"], scene["plot"]}) {
      EXPECT_TRUE(fs::exists(place / "out" / std::string(name))) << name;
      ++files;
    }
    ASSERT_EQ(scene["methods"].size(), 3u);
    for (const auto& method : scene["methods"]) {
      for (const char* file : {"image", "error_map", "worst_regions_image"}) {
        EXPECT_TRUE(fs::exists(place / "out" / std::string(method[file]))) << method[file];
        ++files;
      }
      EXPECT_GT(method["metrics"]["psnr"]["value"], 10);
      EXPECT_GT(method["frame_ms"], 0);
      EXPECT_GT(method["shaded_samples"], 100);
      EXPECT_GE(method["worst_regions"].size(), 1u);
    }
    // More samples have less error, and the costs are those of the methods.
    EXPECT_GT(scene["methods"][0]["metrics"]["flip"]["value"], scene["methods"][1]["metrics"]["flip"]["value"]);
    EXPECT_GT(scene["methods"][0]["metrics"]["edge_error"]["value"],
              scene["methods"][1]["metrics"]["edge_error"]["value"]);
    const double four = scene["methods"][1]["shaded_samples"], eight = scene["methods"][2]["shaded_samples"];
    EXPECT_NEAR(eight / four, 2, 0.1);
  }
  std::size_t found = 0;
  for (const auto& entry : fs::recursive_directory_iterator(place / "out")) found += entry.is_regular_file();
  EXPECT_EQ(found, files);
  const std::string csv = text_of("out/compare.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
  EXPECT_TRUE(contains(csv, "triangles,,\"ssaa:pattern=halton,samples=8\","));
  // The most accurate method is the first, and on the Pareto front.
  const std::string table = text_of("out/compare.md");
  EXPECT_TRUE(
      table.starts_with("| method | mean FLIP ×1000 | triangles | cyclic | PSNR dB | SSIM | edges % | near axis % | "
                        "diagonal % | samples/px | MB | ms |\n|---|"));
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 5);
  EXPECT_TRUE(contains(table, "|---|---|\n| **`ssaa:")) << table;
  EXPECT_LT(table.find("`ssaa:pattern=halton,samples=8`"), table.find("`none`"));
}

// Points, lights and the background are those of `render`, and its options act: a cloud of three points, a file whose
// lights are dimmed, and the scene that is defined on black.
TEST_F(CompareVerb, DrawsThePixelsOfRender) {
  std::ofstream(place / "cloud.ply") << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                                        "property float z\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
  std::ofstream(place / "bright.gltf") << bright_gltf();
  const std::pair<const char*, const char*> cases[] = {{"triangles", ""},
                                                       {"bright.gltf", ""},
                                                       {"bright.gltf", " --light-intensity 1"},
                                                       {"cloud.ply", ""},
                                                       {"cloud.ply", " --point-size 9"},
                                                       {"cloud.ply", " --exposure auto"}};
  std::vector<Rgba8Image> images;
  for (const auto& [scene, options] : cases) {
    const std::string name = std::string(scene) + options;
    ASSERT_EQ(run(std::string("compare ") + scene + " --aa none -o out --force" + small + options).code, 0) << name;
    ASSERT_EQ(run(std::string("render ") + scene + " --aa none -o own.png --size 64x48" + options).code, 0) << name;
    const std::string folder = fs::path(scene).stem().string();
    const auto pixels = [&](const std::string& file) {
      return decode_png(FileBytes((place / file).string()).bytes(), file).pixels;
    };
    images.push_back(pixels("own.png"));
    EXPECT_EQ(pixels("out/" + folder + "/none.png"), images.back()) << name;
  }
  EXPECT_NE(images[1], images[2]);
  EXPECT_NE(images[3], images[4]);
}

TEST_F(CompareVerb, ThePageHasTheImagesAndNeedsNoFolder) {
  const ProgramAnswer answer = run(std::string("compare triangles cyclic --aa none,fxaa --html page.html") + small);
  ASSERT_EQ(answer.code, 0) << answer.out;
  EXPECT_TRUE(contains(answer.out, "triangles, 64x48, against ssaa:n=4"));
  EXPECT_EQ(std::distance(fs::directory_iterator(place), fs::directory_iterator()), 1);
  const std::string page = text_of("page.html");
  EXPECT_TRUE(contains(page, "<title>2 scenes: 2 methods compared with ssaa:n=4</title>"));
  const std::string content = content_of_page(page);
  EXPECT_FALSE(contains(page, place.string()) || contains(content, place.string()));
  const auto count = [](const std::string& text, const std::string& part) {
    int found = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  EXPECT_EQ(count(page, "class=\"picture\" data-values=\"codes\""), 2 * 3);
  EXPECT_EQ(count(page, "class=\"picture\" data-values=\"errors\""), 2 * 2);
  EXPECT_EQ(count(content, "\"is_reference\":true"), 2);
  EXPECT_EQ(run("compare cyclic --aa none --html none/page.html").code, 4);

  ASSERT_EQ(run(std::string("compare passing-fence --aa none,taa --frames 3 --html film.html") + small).code, 0);
  const std::string film = text_of("film.html"), frames = content_of_page(film);
  EXPECT_EQ(count(film, "class=\"picture\" data-values=\"codes\""), 3 * 3);
  EXPECT_EQ(count(film, "class=\"picture\" data-values=\"errors\""), 2 * 3);
  EXPECT_TRUE(contains(frames, "\"frames\":[3,4,5],\"errors\":[6,7,8]")) << frames;
  EXPECT_TRUE(contains(frames, "\"fps\":24.0,\"frame\":2"));
}

TEST_F(CompareVerb, JudgesAsTheMetricsVerbDoes) {
  ASSERT_EQ(run(std::string("compare cyclic --aa fxaa -o out") + small).code, 0);
  const auto json = parsed_json(text_of("out/compare.json"));
  const auto own = parsed_json(
      run("metrics out/cyclic/reference.png out/cyclic/fxaa.png --metric psnr,flip,edge_error --json --threshold "
          "psnr=1,flip=1,edge_error=1")
          .out);
  for (const char* name : {"psnr", "flip", "edge_error"})
    EXPECT_EQ(json["scenes"][0]["methods"][0]["metrics"][name]["value"], own["metrics"][name]["value"]) << name;
  // An image can be a reference too; compared with itself a method has no error.
  const ProgramAnswer again =
      run("compare cyclic --aa fxaa --size 64x48 --reference out/cyclic/fxaa.png -o self --json");
  ASSERT_EQ(again.code, 0) << again.out;
  EXPECT_EQ(parsed_json(again.out)["scenes"][0]["methods"][0]["metrics"]["flip"]["value"], 0);
}

// The whole difference of two methods is in a region, here by a mask of it.
TEST_F(CompareVerb, DoesNotMeasureIgnoredRegions) {
  Rgba8Image mask(64, 48, {255, 255, 255, 255});
  mask(0, 0) = {0, 0, 0, 255};  // the background
  save_bytes((place / "mask.png").string(), encode_png(mask));
  for (const std::string regions : {"--ignore mask.png", "--ignore 1,0,63,48 --ignore 0,1,1,47"}) {
    const ProgramAnswer answer =
        run("compare cyclic --aa none --metric mae,flip -o out --html page.html --force --json " + regions + small);
    ASSERT_EQ(answer.code, 0) << answer.out;
    const auto json = parsed_json(answer.out);
    EXPECT_EQ(json["scenes"][0]["methods"][0]["metrics"]["mae"]["value"], 0);
    EXPECT_EQ(json["scenes"][0]["methods"][0]["worst_regions"][0]["error"], 0);
    EXPECT_EQ(json["scenes"][0]["ignored"][0], regions.starts_with("--ignore mask") ? "mask.png" : "1,0,63,48");
    EXPECT_TRUE(contains(text_of("out/compare.txt"), "\nignored: "));
    EXPECT_TRUE(contains(content_of_page(text_of("page.html")), " Ignored: "));
  }
}

TEST_F(CompareVerb, MeasuresWhereSurfacesWereHidden) {
  const ProgramAnswer answer =
      run("compare disocclusion --aa none,ssaa:n=4 --frames 3 --size 64x48 --reference ssaa:n=4 --metric disocclusion "
          "-o out --json");
  ASSERT_EQ(answer.code, 0) << answer.out;
  const auto json = parsed_json(answer.out);
  const auto value = [&](int method) {
    return json["scenes"][0]["methods"][static_cast<std::size_t>(method)]["metrics"]["disocclusion"]["value"]
        .get<double>();
  };
  EXPECT_GT(value(0), 0.05);
  EXPECT_EQ(value(1), 0);
}

TEST_F(CompareVerb, TimesOfStagesAreThoseOfTheTurnThatCounts) {
  const ProgramAnswer answer =
      run("compare teapot --aa none,fxaa,ssaa:n=4,resolve=display --size 320x240 --turns 4 -o out"
          " --reference ssaa:n=2 --json");
  ASSERT_EQ(answer.code, 0) << answer.out;
  const auto json = parsed_json(answer.out);
  const auto& scene = json["scenes"][0];
  EXPECT_EQ(scene["turns"], 4);
  EXPECT_GT(scene["reference"]["cpu_ms"], 0);
  for (const auto& method : scene["methods"]) {
    double sum = 0;
    for (const auto& stage : method["stage_ms"]) sum += stage.get<double>();
    EXPECT_LE(sum, method["frame_ms"].get<double>()) << method["method"];
  }
  const auto stage = [&](std::size_t method, const char* name) {
    return scene["methods"][method]["stage_ms"][name].get<double>();
  };
  EXPECT_EQ(stage(0, "filter"), 0);  // the tiles produce the image directly
  EXPECT_GT(stage(1, "filter"), 0.05);
  EXPECT_GT(stage(1, "display"), 0);
  EXPECT_GT(stage(2, "resolve"), 0);
  // The title of a run with one scene contains the scene, and the cost of the reference follows its name.
  EXPECT_TRUE(contains(text_of("out/cost.svg"), "teapot: FLIP ×1000 against cost"));
  EXPECT_TRUE(contains(text_of("out/compare.txt"), "against ssaa:n=2 ("));
  EXPECT_TRUE(contains(text_of("out/compare.txt"), " shaded samples per pixel)\n"));
}

TEST(Report, NamesMethodsThatGotFewerTurns) {
  SceneTrials scene{.scene = "s", .ranking = metric_named("flip"), .turns = 3};
  for (const char* method : {"quick", "slow", "slower"})
    scene.trials.push_back({.method = method, .pixels = 1, .frame_ms = {1, 2, 3}, .processor_ms = {1, 2, 3}});
  EXPECT_FALSE(contains(report_text({scene}), "fewer than"));
  scene.trials[1].frame_ms.pop_back();
  scene.trials[2].frame_ms.resize(1);
  EXPECT_TRUE(contains(report_text({scene}), "Slow methods with fewer than 3 turns: slow (2), slower (1)\n"));
}

TEST_F(CompareVerb, RefusesBeforeItWorksAndLeavesNothing) {
  const auto expect = [&](const std::string& arguments, int code, std::string_view words) {
    const ProgramAnswer answer = run("compare " + arguments);
    EXPECT_EQ(answer.code, code) << arguments;
    EXPECT_TRUE(contains(answer.out, words)) << answer.out;
  };
  expect("-o out", 2, "no scene");
  expect("triangles", 2, "no output: give -o DIR");
  expect("triangles --aa nome -o out", 2, "did you mean 'none'?");
  expect("triangles --aa msaa:n=3 -o out", 2, "2, 4, 8 or 16");
  expect("triangles --reference mssa -o out", 2, "did you mean 'msaa'?");
  expect("triangles --reference exact.png -o out", 3, "exact.png: no such file");
  expect("triangles --metric flop -o out", 2, "unknown metric 'flop'; did you mean 'flip'?");
  expect("triangles --aa none -o none/out", 4, "no directory");
  // Invalid names are reported first: these scenes would take minutes to render.
  const std::string slow = "city --turns 100 --aa ssaa:n=16 -o out --size 4096x4096 ";
  expect(slow + "missing.glb", 3, "missing.glb");
  expect(slow + "sphere:triangels=9", 2, "scene sphere: unknown parameter 'triangels'");
  expect(slow + "sphere:triangles=many", 2, "scene sphere: triangles is 'many'");
  save_bytes((place / "small.png").string(), encode_png(Rgba8Image(16, 16)));
  expect("triangles --aa none -o out --size 64x48 --reference small.png", 3, "has 16x16 pixels, the images have 64x48");
  expect("triangles cyclic --aa none -o out --reference small.png", 2, "one image is a reference for one scene");
  fs::create_directory(place / "there");
  expect("triangles --aa none -o there", 4, "is there already");
  expect("triangles --aa none -o there --force", 4, "is not the output of a comparison");
  std::size_t names = 0;
  for (const auto& entry : fs::directory_iterator(place)) names += !entry.path().empty();
  EXPECT_EQ(names, 2u);  // small.png and there
}

TEST_F(CompareVerb, RefusesNamesThatNoFolderCanHave) {
  const std::string slow =
      "compare city --turns 100 --aa ssaa:n=16 --size 4096x4096 -o ";  // an error before minutes of work
  save_bytes((place / "file").string(), {});
  ProgramAnswer answer = run(slow + "file");
  EXPECT_EQ(answer.code, 4);
  EXPECT_EQ(answer.out, "zoneplate: error: file: is there already; give another folder or remove it\n");
  answer = run(slow + "file/out");
  EXPECT_EQ(answer.code, 4);
  EXPECT_EQ(answer.out, "zoneplate: error: file/out: file is not a directory\n");
  answer = run(slow + std::string(256, 'n'));
  EXPECT_EQ(answer.code, 4);
  EXPECT_EQ(answer.out, "zoneplate: error: " + std::string(256, 'n') + ": cannot be made: File name too long\n");
}

TEST_F(CompareVerb, LeavesWhatIsNotItsOwn) {
  fs::create_directory(place / ".out.tmp");
  save_bytes((place / ".out.tmp/notes.txt").string(), std::vector<std::uint8_t>{'p'});
  const std::string one = std::string("compare triangles --aa none -o out") + small;
  ASSERT_EQ(run(one).code, 0);
  EXPECT_EQ(text_of(".out.tmp/notes.txt"), "p");
  // Of several simultaneous runs one creates the complete folder; the others report that it exists.
  fs::remove_all(place / "out");
  std::vector<std::thread> runs;
  std::array<ProgramAnswer, 4> answers;
  for (ProgramAnswer& answer : answers) runs.emplace_back([&] { answer = run(one); });
  for (std::thread& thread : runs) thread.join();
  int made = 0;
  for (const ProgramAnswer& answer : answers) {
    made += answer.code == 0;
    EXPECT_TRUE(answer.code == 0 || (answer.code == 4 && contains(answer.out, "out: is there already"))) << answer.out;
  }
  EXPECT_EQ(made, 1);
  EXPECT_TRUE(fs::exists(place / "out/compare.json"));
  EXPECT_TRUE(fs::exists(place / "out/triangles/none.png"));
  EXPECT_EQ(std::distance(fs::directory_iterator(place), fs::directory_iterator()), 2);  // out and .out.tmp
}

TEST_F(CompareVerb, ForceReplacesTheFilesOfAnEarlierComparisonAlone) {
  const std::string one = std::string("compare triangles --aa none -o out --force") + small;
  ASSERT_EQ(run(one).code, 0);
  ASSERT_EQ(run(std::string("compare cyclic --aa msaa:n=4 -o out --force") + small).code, 0);
  EXPECT_TRUE(fs::exists(place / "out/cyclic/msaa-n-4.png"));
  EXPECT_FALSE(fs::exists(place / "out/triangles"));
  // An error before minutes of work; nothing changes.
  const std::string slow = "compare city --turns 100 --aa ssaa:n=16 --size 4096x4096 --force -o ";
  const auto put = [&](const std::string& name) {
    fs::create_directories((place / name).parent_path());
    save_bytes((place / name).string(), std::vector<std::uint8_t>{'p'});
  };
  for (const std::string& name : {std::string("thesis.tex"), std::string("mine/x"), std::string("cyclic/notes.txt")}) {
    put("out/" + name);
    const ProgramAnswer answer = run(slow + "out");
    EXPECT_EQ(answer.code, 4);
    EXPECT_TRUE(contains(answer.out, "out: is not replaced, because it has " + name.substr(0, name.find("/x"))))
        << answer.out;
    EXPECT_EQ(text_of("out/" + name), "p");
    fs::remove_all(place / "out/mine"), fs::remove(place / "out" / name);
  }
  put("proj/thesis.tex");
  for (const char* report : {"{}", "", "{\"format\":\"zoneplate-dataset\"}", "[1]"}) {
    save_bytes((place / "proj/compare.json").string(), std::vector<std::uint8_t>(report, report + std::strlen(report)));
    const ProgramAnswer answer = run(slow + "proj");
    EXPECT_EQ(answer.code, 4);
    EXPECT_TRUE(contains(answer.out, "proj: is there already, and is not the output of a comparison")) << answer.out;
  }
  EXPECT_EQ(text_of("proj/thesis.tex"), "p");
  EXPECT_EQ(run(one).code, 0);
}

// If a surface's texture has no mip levels, exact edges are not sufficient: the default reference also samples
// surfaces.
TEST_F(CompareVerb, TheDefaultReferenceIsRightInsideOfSurfacesToo) {
  const ProgramAnswer answer =
      run("compare tiles --aa analytic,converged:samples=64 --turns 1 --size 64x48 -o out --json");
  ASSERT_EQ(answer.code, 0) << answer.out;
  const auto scene = parsed_json(answer.out)["scenes"][0];
  EXPECT_EQ(scene["reference"]["source"], "converged:samples=256");
  EXPECT_LT(scene["methods"][0]["metrics"]["psnr"]["value"], 30);
  EXPECT_GT(scene["methods"][1]["metrics"]["psnr"]["value"], 38);
  // Its estimate is not below its error, which is less than that of a quarter of its samples.
  const double estimated = scene["reference"]["estimated_error"];
  EXPECT_GT(estimated, 1e-4);
  EXPECT_LT(estimated, 0.02);
  EXPECT_TRUE(contains(text_of("out/compare.txt"), ", estimated error "));
}

TEST(WorstPlaces, AreFoundInOrderAndDoNotOverlap) {
  Plane<float> error(100, 80);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x) error(10 + x, 20 + y) = 0.5f, error(60 + x, 50 + y) = 0.75f;
  const std::vector<Place> worst = worst_places(error, 3);
  ASSERT_EQ(worst.size(), 3u);
  EXPECT_EQ((std::array{worst[0].x, worst[0].y, worst[1].x, worst[1].y}), (std::array{60, 50, 10, 20}));
  EXPECT_NEAR(worst[0].error, 0.75, 1e-9);
  EXPECT_NEAR(worst[1].error, 0.5, 1e-9);
  EXPECT_LT(worst[2].error, 0.01);
  EXPECT_TRUE(worst_places(Plane<float>(20, 100), 3).empty());
}

TEST(ParetoFront, HoldsWhatNothingBeats) {
  const metrics::Metric* const flip = metric_named("flip");
  const auto trial = [&](double ms, double error) {
    Trial t{.processor_ms = {ms + 1, ms}};
    t.results.push_back({.metric = flip, .value = error});
    return t;
  };
  std::vector<Trial> trials = {trial(1, 9), trial(2, 5), trial(3, 6), trial(4, 5), trial(5, 1), trial(5, 2)};
  mark_front(trials, *flip);
  std::vector<bool> front;
  for (const Trial& t : trials) front.push_back(t.is_on_front);
  EXPECT_EQ(front, (std::vector<bool>{true, true, false, false, true, false}));
}

// Of a metric whose greater values are better, the greatest rank first, and a method without a value last.
TEST(Ranking, IsThatOfTheFirstMetric) {
  const metrics::Metric* const psnr = metric_named("psnr");
  SceneTrials scene{.scene = "s", .ranking = psnr};
  const auto add = [&](const char* method, double ms, std::optional<double> value) {
    scene.trials.push_back({.method = method, .pixels = 1, .frame_ms = {ms}, .processor_ms = {ms}});
    if (value) scene.trials.back().results.push_back({.metric = psnr, .value = *value});
  };
  add("none", 1, 30), add("best", 9, 50), add("unmeasured", 0.5, std::nullopt), add("slow", 8, 40), add("good", 3, 42);
  mark_front(scene.trials, *psnr);
  std::string order;
  for (const Trial* t : ranked(scene)) order += t->method + (t->is_on_front ? "* " : " ");
  EXPECT_EQ(order, "best* good* slow none* unmeasured ");
  EXPECT_TRUE(contains(report_text({scene}), "no other method has less CPU time and a better psnr"));
  const Plot plot = cost_plot(scene);
  EXPECT_FALSE(plot.y.is_logarithmic);
  EXPECT_EQ(plot.y.label, "PSNR dB");
  EXPECT_EQ(plot.curves[1].labels_are, Curve::Beside::LeftAbove);
  EXPECT_EQ(plot.curves[0].points.size() + plot.curves[1].points.size(), 4u);  // without the unmeasured one
}

// A still image by a method with history is made of many frames: its figures are those of one.
TEST_F(CompareVerb, CountsTheCostOfAFrame) {
  const ProgramAnswer still =
      run("compare wires --aa none,taa:frames=8,taa:frames=16 --metric psnr,flip -o out --json" + std::string(small));
  ASSERT_EQ(still.code, 0) << still.out;
  const auto report = parsed_json(still.out);
  EXPECT_EQ(report["ranked_by"], "psnr");
  const auto& methods = report["scenes"][0]["methods"];
  const int frames[] = {1, 8, 16};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(methods[i]["frames"], frames[i]);
    EXPECT_NEAR(methods[i]["shaded_samples_per_pixel"].get<double>(),
                methods[0]["shaded_samples_per_pixel"].get<double>(), 0.1);
  }
  const std::string text = text_of("out/compare.txt");
  EXPECT_TRUE(contains(text, "  MB  frames\n") || contains(text, " MB  frames\n")) << text;
  // The first metric of the command ranks every output.
  EXPECT_TRUE(contains(text, " PSNR dB  FLIP ×1000 ")) << text;
  EXPECT_TRUE(text_of("out/compare.csv").starts_with("scene,class,method,psnr,flip,frame_ms,"));
  EXPECT_TRUE(text_of("out/compare.md").starts_with("| method | mean PSNR dB | wires | FLIP ×1000 | samples/px |"));
  EXPECT_TRUE(contains(text_of("out/cost.svg"), "PSNR dB"));
  // Sequences are ranked by JOD unless the command names metrics.
  const ProgramAnswer film = run("compare passing-fence --aa none,taa --frames 3 -o film --json" + std::string(small));
  ASSERT_EQ(film.code, 0) << film.out;
  const auto sequence = parsed_json(film.out);
  EXPECT_EQ(sequence["ranked_by"], "cvvdp_video");
  for (const auto& method : sequence["scenes"][0]["methods"]) {
    for (const char* name : {"cvvdp_video", "psnr", "tpsnr", "flicker", "flip"})
      EXPECT_TRUE(method["metrics"][name]["value"].is_number()) << name;
    EXPECT_LT(method["shaded_samples_per_pixel"], 3);
  }
  EXPECT_TRUE(text_of("film/compare.csv").starts_with("scene,class,method,cvvdp_video,psnr,tpsnr,flicker,flip,"));
}

TEST(CostPlot, NamesMethodsOfLikeErrorAndOtherCost) {
  const metrics::Metric* const flip = metric_named("flip");
  SceneTrials scene{.scene = "s", .ranking = flip};
  const auto add = [&](const char* method, double ms, double error) {
    scene.trials.push_back({.method = method, .pixels = 1, .frame_ms = {ms}, .processor_ms = {ms}});
    scene.trials.back().results.push_back({.metric = flip, .value = error});
  };
  add("fxaa", 4, 0.0100), add("none", 6, 0.0098), add("close", 6.1, 0.0097), add("msaa", 9, 0.0050);
  mark_front(scene.trials, *flip);
  const Plot plot = cost_plot(scene);
  EXPECT_EQ(plot.title, "s: FLIP ×1000 against cost");
  EXPECT_EQ(plot.curves[1].labels, (std::vector<std::string>{"fxaa", "none", "", "msaa"}));
}

TEST(Report, SpecsMakeFileNames) {
  EXPECT_EQ(file_name_of("msaa"), "msaa");
  EXPECT_EQ(file_name_of("ssaa:pattern=halton,samples=64"), "ssaa-pattern-halton-samples-64");
  EXPECT_EQ(file_name_of("../a b/..."), "a-b-...");
  EXPECT_EQ(file_name_of(std::string(300, 'x')).size(), 100u);
}

TEST(Methods, VariantsAreMethodsToo) {
  for (const Method& m : antialias::methods())
    for (const std::string_view v : m.variants)
      EXPECT_NO_THROW(make_resolver(antialias::methods(), std::string(m.name) + ":" + std::string(v))) << m.name;
}

}  // namespace
}  // namespace zoneplate
