// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/args.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>

#include "zoneplate/base/closest.h"
#include "zoneplate/base/error.h"
#include "zoneplate/cli/completions.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/man_page.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {

namespace {

// The names of an option in help, short forms first: "-o, --output FILE".
std::string shown(const Option& option) {
  std::vector<std::string> names = names_of(option);
  std::stable_sort(names.begin(), names.end(),
                   [](const auto& a, const auto& b) { return (a[1] != '-') > (b[1] != '-'); });
  return fmt::format("{}{}{}", fmt::join(names, ", "), option.value.empty() ? "" : " ", option.value);
}

// Breaks the text at spaces into lines of `width` columns; all lines but the first are indented.
std::string wrapped(const std::string& text, std::size_t width, std::size_t indent) {
  std::string out;
  std::size_t column = 0;
  for (const std::string& word : CLI::detail::split(text, ' ')) {
    if (column > 0 && column + 1 + word.size() > width) {
      out += '\n' + std::string(indent, ' ');
      column = 0;
    } else if (column > 0) {
      out += ' ';
      ++column;
    }
    out += word;
    column += word.size();
  }
  return out;
}

constexpr std::size_t help_width = 100, help_column = 34;

// Breaks the lines of each paragraph anew. Lines that begin with a space, as those of tables, stay as they are.
std::string reflowed(const std::string& text) {
  std::string out, paragraph;
  const auto end_paragraph = [&] {
    if (!paragraph.empty()) out += wrapped(paragraph, help_width, 0) + '\n';
    paragraph.clear();
  };
  for (const std::string& line : CLI::detail::split(text, '\n')) {
    if (!line.empty() && line[0] != ' ') {
      paragraph += (paragraph.empty() ? "" : " ") + line;
      continue;
    }
    end_paragraph();
    out += line + '\n';
  }
  end_paragraph();
  return out;
}

std::string help_line(const Option& option) {
  std::string left = "  " + shown(option);
  left += left.size() + 2 > help_column ? '\n' + std::string(help_column, ' ')
                                        : std::string(help_column - left.size(), ' ');
  return left + wrapped(option.meaning, help_width - help_column, help_column) + '\n';
}

std::string usage_line(const Syntax& syntax) {
  return fmt::format("Usage: {} {} {} [OPTIONS]\n\n{}.\n", syntax.program, syntax.verb, syntax.operands,
                     syntax.summary);
}

// A heading as one word: "materials-and-lights".
std::string word_of(std::string_view heading) {
  std::string word(heading);
  for (char& c : word) c = c == ' ' ? '-' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return word;
}

// Options of other programs, and what they are called here.
struct Synonym {
  std::string_view theirs, ours;
};
constexpr Synonym synonyms[] = {
    // F3D
    {"--hdri", "--hdri-file"},
    {"--samples", "--anti-aliasing"},
    {"--anti-aliasing-mode", "--anti-aliasing"},
    {"--ambient-occlusion-samples", "--ambient-occlusion"},
    {"--ssao", "--ambient-occlusion"},
    {"--tone", "--tone-mapping"},
    {"--bg-color", "--background-color"},
    {"--bg", "--background-color"},
    {"--camera-direction", "--camera-azimuth-angle"},
    {"--camera-zoom-factor", "--camera-view-angle"},
    {"--ortho", "--camera-orthographic"},
    {"--fov", "--camera-view-angle"},
    {"--azimuth", "--camera-azimuth-angle"},
    {"--elevation", "--camera-elevation-angle"},
    {"--camera-azimuth", "--camera-azimuth-angle"},
    {"--camera-elevation", "--camera-elevation-angle"},
    {"--texture-base-color", "--texture"},
    {"--texture-material", "--texture"},
    {"--base-color", "--color"},
    {"--opacity", "--color"},
    {"--model-color", "--color"},
    {"--hdri-ambient", "--hdri-file"},
    {"--skybox", "--hdri-file"},
    {"--hdri-skybox", "--background-color"},
    {"--blur-background", "--background-blur"},
    {"--point-sprites", "--point-size"},
    {"--show-edges", "--edges"},
    {"--wireframe", "--edges"},
    {"--edge-width", "--edges"},
    {"--no-render", "--dry-run"},
    {"--config", "--preset"},
    {"--raytracing-samples", "--anti-aliasing"},
    {"--animation-speed-factor", "--frame-rate"},
    {"--animation-name", "--animation-index"},
    // Blender
    {"--render-output", "--output"},
    {"--render-frame", "--frame-start"},
    {"--render-format", "--output-format"},
    {"--render-anim", "--frames"},
    {"--use-extension", "--output"},
    {"--fps", "--frame-rate"},
    {"--frame-step", "--frame-jump"},
    {"--view-transform", "--tone-mapping"},
    // OpenImageIO's idiff, pixelmatch, odiff
    {"--fail", "--threshold"},
    {"--failpercent", "--threshold"},
    {"--tolerance", "--threshold"},
    {"--diff", "--map"},
    {"--warn", "--threshold"},
    {"--warnpercent", "--threshold"},
    {"--abs", "--map"},
    {"--scale", "--map-gain"},
    // OpenImageIO's oiiotool
    {"--compression", "--exr-compression"},
    {"--tocolorspace", "--color-management"},
    {"--mulc", "--exposure"},
    {"--cut", "--crop"},
    // ImageMagick, and habits of many programs
    {"--out", "--output"},
    {"--width", "--resolution"},
    {"--height", "--resolution"},
    {"--geometry", "--resolution"},
    {"--resize", "--resolution"},
    {"--depth", "--bit-depth"},
    {"--density", "--resolution"},
    {"--colorspace", "--color-management"},
    {"--gravity", "--crop"},
    {"--define", "--jpeg-quality"},
    {"--small", "--png-compression"},
    {"--delay", "--frame-rate"},
    {"--montage", "--columns"},
    {"--tile", "--columns"},
    {"--transparent", "--no-background"},
    {"--alpha", "--no-background"},
    {"--jobs", "--threads"},
    {"--memory", "--max-memory"},
    {"--timeout", "--max-seconds"},
    {"--silent", "--quiet"},
};

// The options that may have been meant, best first: the same under another program's name, those that begin with the
// given text, or have it as a word, and the closest one by spelling.
std::vector<std::string> options_near(const std::string& given, const std::vector<std::string>& names) {
  constexpr std::size_t most = 3;
  const auto is_option = [&](std::string_view name) { return std::ranges::find(names, name) != names.end(); };
  for (const Synonym& synonym : synonyms)
    if (synonym.theirs == given && is_option(synonym.ours)) return {std::string(synonym.ours)};
  const std::vector<std::string_view> views(names.begin(), names.end());
  const std::string near(closest(given, views));
  std::vector<std::string> found;
  if (given.size() > 4) {
    std::ranges::copy_if(names, std::back_inserter(found), [&](const auto& name) { return name.starts_with(given); });
    const std::string word = given.substr(1);
    if (found.empty())
      std::ranges::copy_if(names, std::back_inserter(found), [&](const auto& name) {
        const std::size_t at = name.find(word, 2);
        return at != name.npos && (at + word.size() == name.size() || name[at + word.size()] == '-');
      });
  }
  if (found.empty() && !near.empty()) found.push_back(near);
  if (found.size() > most) found.clear();
  return found;
}

[[noreturn]] void refuse_unknown(const Syntax& syntax, const std::string& given) {
  std::vector<std::string> names{"--help"};
  for (const Option& option : syntax.options)
    for (const std::string& name : names_of(option))
      if (name.starts_with("--")) names.push_back(name);
  const std::string name = given.substr(0, given.find('='));
  const std::vector<std::string> near = options_near(name, names);
  throw Error(ErrorKind::Usage,
              near.empty()
                  ? fmt::format("unknown option {} ({} {} --help lists them)", name, syntax.program, syntax.verb)
                  : fmt::format("unknown option {}; did you mean {}?", name, fmt::join(near, " or ")));
}

void set(const Option& option, const std::string& text) {
  try {
    option.set(text);
  } catch (const Error& error) {
    throw Error(error.kind(), names_of(option).front() + ": " + error.what());
  }
}

[[noreturn]] void refuse_value(const Option& option) {
  throw Error(ErrorKind::Usage, names_of(option).front() + " takes no value");
}

std::string help_of_form(const Syntax& syntax, const std::string& form) {
  if (form == "true") return full_help(syntax);
  if (form == "man") return man_section(syntax);
  if (const std::optional<Shell> shell = shell_of(form)) return completions_of(syntax, *shell);
  return group_help(syntax, form);
}

std::string missing_value(const Option& option) { return names_of(option).front() + " needs a value: " + option.value; }

}  // namespace

bool parse(Syntax& syntax, std::span<const std::string> arguments) {
  CLI::App app;
  app.set_help_flag();
  app.allow_extras();
  const CLI::Option* short_help_switch = app.add_flag("-h");
  const CLI::Option* full_help_switch = app.add_flag("--help");
  app.add_option("operands", syntax.found_operands)->expected(-1);

  std::vector<const CLI::Option*> parsers;
  std::map<std::string, std::string> places;  // maps CLI11's name of an option to our option with its value
  for (const Option& option : syntax.options) {
    CLI::Option* parser = option.value.empty() ? app.add_flag(option.names) : app.add_option(option.names);
    if (!option.value.empty()) parser->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    places[parser->get_name()] = missing_value(option);
    parsers.push_back(parser);
  }

  // CLI11 expects the arguments in reverse order.
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::ArgumentMismatch& mismatch) {
    const std::string text = mismatch.what();
    const auto place = places.find(text.substr(0, text.find(':')));
    throw Error(ErrorKind::Usage, place == places.end() ? text : place->second);
  } catch (const CLI::ParseError& error) {
    throw Error(ErrorKind::Usage, error.what());
  }
  for (const std::string& extra : app.remaining())
    if (extra != "--") refuse_unknown(syntax, extra);
  if (short_help_switch->count() + full_help_switch->count() > 0) {
    print(full_help_switch->count() > 0 ? help_of_form(syntax, full_help_switch->results().back())
                                        : short_help(syntax));
    return false;
  }

  for (std::size_t i = 0; i < parsers.size(); ++i) {
    if (parsers[i]->count() == 0) continue;
    const Option& option = syntax.options[i];
    // In order: the last value counts, unless the option collects them.
    for (const std::string& text : parsers[i]->results()) {
      if (option.value.empty() && text != "true") refuse_value(option);
      set(option, option.value.empty() ? "" : text);
    }
  }
  return true;
}

void set_option(const Syntax& syntax, const std::string& name, const std::optional<std::string>& value) {
  const Option* const option = find_option(syntax.options, name);
  if (option == nullptr) refuse_unknown(syntax, "--" + name);
  if (option->value.empty() && value) refuse_value(*option);
  if (!option->value.empty() && !value) throw Error(ErrorKind::Usage, missing_value(*option));
  set(*option, value.value_or(""));
}

std::string short_help(const Syntax& syntax) {
  std::string text = usage_line(syntax) + '\n';
  for (const Option& option : syntax.options)
    if (option.is_basic) text += help_line(option);
  if (!syntax.examples.empty()) text += "\nExamples:\n" + syntax.examples;
  return text + fmt::format("\nAll options: {} {} --help\n", syntax.program, syntax.verb);
}

namespace {

/// In the order in which they appear.
std::vector<std::string_view> headings_of(const Syntax& syntax) {
  std::vector<std::string_view> headings;
  for (const Option& option : syntax.options)
    if (std::ranges::find(headings, option.group) == headings.end()) headings.push_back(option.group);
  return headings;
}

std::string lines_of(const Syntax& syntax, std::string_view heading) {
  std::string text = fmt::format("{}:\n", heading);
  for (const Option& option : syntax.options)
    if (option.group == heading) text += help_line(option);
  return text;
}

}  // namespace

std::string group_help(const Syntax& syntax, const std::string& heading) {
  const std::vector<std::string_view> headings = headings_of(syntax);
  std::vector<std::string> words;
  for (const std::string_view each : headings) words.push_back(word_of(each));
  const std::string_view chosen =
      headings[parse_choice(word_of(heading), std::vector<std::string_view>(words.begin(), words.end()))];
  return lines_of(syntax, chosen);
}

std::string full_help(const Syntax& syntax) {
  std::string text = usage_line(syntax);
  const std::vector<std::string_view> headings = headings_of(syntax);
  for (const std::string_view heading : headings) text += '\n' + lines_of(syntax, heading);
  const std::string one_group =
      headings.size() > 1 ? "; --help=GROUP: one group of it, as --help=" + word_of(syntax.options.front().group) : "";
  text += "\nOther:\n" + help_line({.names = "-h", .meaning = "Short help with examples"}) +
          help_line({.names = "--help", .meaning = "This text" + one_group});
  if (!syntax.examples.empty()) text += "\nExamples:\n" + syntax.examples;
  if (!syntax.notes.empty()) text += '\n' + reflowed(syntax.notes);
  return text;
}

}  // namespace zoneplate::cli
