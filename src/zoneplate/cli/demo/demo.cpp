// zoneplate demo: one lesson about aliasing a command, each a picture that explains itself.
#include "zoneplate/cli/demo/demo.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <filesystem>

#include "zoneplate/base/closest.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/parallel.h"
#include "zoneplate/cli/args.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/output_paths.h"
#include "zoneplate/cli/values.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/codec/apng.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/codec/webp.h"
#include "zoneplate/os/file.h"

namespace zoneplate::cli {
namespace {

struct DemoArgs {
  std::string output;
  DemoSize size;
  int threads = 0;
};

std::string list_of_lessons() {
  std::string text = "Lessons:\n";
  for (const Demo& demo : demos()) text += fmt::format("  {:<22}{}\n", demo.name, demo.summary);
  return text + fmt::format("  {:<22}{}\n", "all", "every one of them, into a folder");
}

Syntax demo_syntax(DemoArgs& args) {
  return {.verb = "demo",
          .summary = "A lesson about aliasing: one picture that shows the artifact, its cure and what was measured",
          .operands = "LESSON -o OUT.png",
          .examples =
              "  zoneplate demo jaggies -o jaggies.png\n"
              "  zoneplate demo wagon-wheel -o wheel.png        writes wheel.webp too: both are animations\n"
              "  zoneplate demo all -o lessons                  the folder is made\n"
              "\n" +
              list_of_lessons(),
          .notes =
              "Every number in a picture is computed when the picture is made, and what the picture says is\n"
              "printed as text too. The scenes are made in code, so that the same command gives the same bytes\n"
              "everywhere.\n",
          .options = {
              {"--output,-o", "OUT", "The picture, a .png file; of `all`, a folder", "Lesson", true,
               [&args](const std::string& text) { args.output = text; }},
              {"--panel", "PX", "Side of one picture of the lesson, 64 to 1024; default 360", "Lesson", true,
               [&args](const std::string& text) { args.size.panel = parse_whole(text, 64, 1024); }},
              {"--threads,-t", "N", "Threads at most; 0, the default: as many as affinity and CPU quota allow",
               "Running", false, [&args](const std::string& text) { args.threads = parse_whole(text, 0, 1024); }},
          }};
}

std::span<const Demo> chosen(const std::string& name) {
  if (name == "all") return demos();
  std::vector<std::string_view> names{"all"};
  for (const Demo& demo : demos()) {
    names.push_back(demo.name);
    if (demo.name == name) return {&demo, 1};
  }
  const std::string_view near = closest(name, names);
  throw Error(ErrorKind::Usage, near.empty() ? fmt::format("demo: no lesson {}; `zoneplate demo -h` lists them", name)
                                             : fmt::format("demo: no lesson {}; did you mean {}?", name, near));
}

void save_lesson(const Lesson& lesson, const DemoSize& size, const std::vector<std::string>& files) {
  Animation animation{.frames = {}, .seconds = lesson.seconds, .per = lesson.per};
  for (const Figure& figure : lesson.frames) animation.frames.push_back(compose(figure, size.style()));
  assert((files.size() == 2) == (animation.frames.size() > 1));
  if (files.size() == 1)
    return save_bytes(
        files[0], encode_png(animation.frames.at(0), {.has_alpha = false, .is_small = true, .may_be_indexed = true}));
  const auto apng = encode_apng(animation), webp = encode_webp(animation);
  save_bytes(files[0], apng);
  save_bytes(files[1], webp);
}

/// Words in lines of a terminal, each indented.
std::string paragraph(std::string_view words, std::string_view indent) {
  constexpr std::size_t columns = 100;
  std::string text;
  std::size_t column = 0;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find_first_of(" \n"), words.size());
    const std::string_view word = words.substr(0, end);
    if (column > 0 && column + 1 + word.size() > columns) text += '\n', column = 0;
    const std::string_view before = column == 0 ? indent : " ";
    text.append(before).append(word);
    column += before.size() + word.size();
    if (end < words.size() && words[end] == '\n') text += '\n', column = 0;
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return text + '\n';
}

/// The files that a lesson is written into: a picture, or an animation in both formats.
std::vector<std::string> files_of(const Demo& demo, const std::string& path) {
  if (!demo.is_animated) return {path};
  return {path, std::filesystem::path(path).replace_extension(".webp").string()};
}

void make_folder(const std::string& path) {
  std::error_code trouble, ignored;
  std::filesystem::create_directory(path, trouble);
  if (!std::filesystem::is_directory(path, ignored))
    throw Error(ErrorKind::Output, fmt::format("{}: the folder cannot be made: {}", path, trouble.message()));
}

void check_output(const std::string& lesson, const std::string& output) {
  if (output.empty())
    throw Error(ErrorKind::Usage, lesson == "all" ? "no output: give -o FOLDER" : "no output: give -o OUT.png");
  if (lesson != "all" && !output.ends_with(".png") && !output.ends_with(".PNG"))
    throw Error(ErrorKind::Usage,
                fmt::format("--output: {} is not a format that a lesson is written in (.png)", output));
}

}  // namespace

FigureStyle DemoSize::style() const { return {.text_px = std::max(8, panel / 20), .gap_px = std::max(6, panel / 15)}; }

std::string text_of(const Lesson& lesson) {
  const Figure& figure = lesson.frames.at(0);
  std::string text = paragraph(figure.title, "") + '\n';
  for (const auto& row : figure.rows)
    for (const Panel& panel : row) {
      if (panel.caption.empty()) continue;
      std::string caption = panel.caption;
      const std::size_t end = caption.find('\n');
      if (end != std::string::npos) caption.replace(end, 1, ": ");
      text += paragraph(caption, "  ");
    }
  for (const Table& table : lesson.tables) text += '\n' + table_text(table);
  if (!figure.text.empty()) text += '\n' + paragraph(figure.text, "");
  return text;
}

void run_demo(std::span<const std::string> arguments) {
  DemoArgs args;
  Syntax syntax = demo_syntax(args);
  if (!parse(syntax, arguments)) return;
  if (syntax.found_operands.size() != 1)
    throw Error(ErrorKind::Usage, "demo: give one lesson; `zoneplate demo -h` lists them");
  const std::string& name = syntax.found_operands.front();
  const std::span<const Demo> lessons = chosen(name);
  check_output(name, args.output);
  if (name == "all") make_folder(args.output);
  const auto path_of = [&](const Demo& demo) {
    return name == "all" ? fmt::format("{}/{}.png", args.output, demo.name) : args.output;
  };
  for (const Demo& demo : lessons)
    for (const std::string& file : files_of(demo, path_of(demo))) check_savable(file);
  with_threads(args.threads, [&] {
    for (const Demo& demo : lessons) {
      const Lesson lesson = demo.make(args.size);
      save_lesson(lesson, args.size, files_of(demo, path_of(demo)));
      print((&demo == &lessons[0] ? "" : "\n\n") + text_of(lesson));
    }
  });
}

}  // namespace zoneplate::cli
