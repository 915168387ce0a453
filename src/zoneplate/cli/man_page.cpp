// SPDX-License-Identifier: Apache-2.0
// zoneplate man: the manual page, from the tables of options of all verbs.
#include "zoneplate/cli/man_page.h"

#include <fmt/format.h>

#include "zoneplate/base/error.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/version.h"

namespace zoneplate::cli {
namespace {

std::string upper_case(std::string text) {
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

// Lines as they are, without filling.
std::string verbatim(const std::string& text) {
  return ".nf\n" + roff(text) + (text.ends_with('\n') ? "" : "\n") + ".fi\n";
}

std::string item(const Option& option) {
  std::string names;
  for (const std::string& name : names_of(option))
    names += (names.empty() ? "" : ", ") + ("\\fB" + roff(name) + "\\fR");
  const std::string value = option.value.empty() ? "" : " \\fI" + roff(option.value) + "\\fR";
  return fmt::format(".TP\n{}{}\n{}.\n", names, value, roff(option.meaning));
}

}  // namespace

std::string roff(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool is_first = out.empty() || out.back() == '\n';
    if (is_first && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out;
}

std::string man_section(const Syntax& syntax) {
  std::string text =
      fmt::format(".SH \"{}\"\n.B zoneplate {}\n{} [OPTIONS]\n.PP\n{}.\n", upper_case("zoneplate " + syntax.verb),
                  roff(syntax.verb), roff(syntax.operands), roff(syntax.summary));
  std::string group;
  for (const Option& option : syntax.options) {
    if (option.group != group) text += fmt::format(".SS {}\n", roff(group = option.group));
    text += item(option);
  }
  if (!syntax.examples.empty()) text += ".SS Examples\n" + verbatim(syntax.examples);
  if (!syntax.notes.empty()) text += ".SS Notes\n" + verbatim(syntax.notes);
  return text;
}

void run_man(std::span<const std::string> arguments) {
  Syntax syntax{.verb = "man",
                .summary = "Print the manual page, made from the same tables as the help",
                .operands = "",
                .examples = "  zoneplate man | man -l -\n"};
  if (!parse(syntax, arguments)) return;
  if (!syntax.found_operands.empty()) throw Error(ErrorKind::Usage, "man takes no arguments");
  std::string text = fmt::format(
      ".TH ZONEPLATE 1 \"\" \"Zoneplate {}\" \"User Commands\"\n"
      ".SH NAME\nzoneplate \\- render 3D models to antialiased images, on the CPU\n"
      ".SH SYNOPSIS\n.B zoneplate\n[\\fIVERB\\fR] \\fIARGUMENTS\\fR\n"
      ".SH DESCRIPTION\nWithout a verb, the arguments are those of \\fBzoneplate render\\fR.\n",
      version);
  for (const Verb& verb : all_verbs())
    text += fmt::format(".TP\n\\fB{}\\fR\n{}\n", roff(std::string(verb.name)), roff(std::string(verb.summary)));
  print(text);
  const std::string form = "--help=man";
  for (const Verb& verb : all_verbs()) {
    if (verb.subcommands == nullptr) verb.run({&form, 1});
    if (verb.subcommands != nullptr)
      for (const Verb& each : verb.subcommands()) each.run({&form, 1});
  }
  print(
      ".SH EXIT STATUS\n.TP\n0\nsuccess\n.TP\n1\nrendering failed, or a comparison found a difference\n"
      ".TP\n2\nwrong usage\n.TP\n3\ninput missing, corrupt or unsupported\n.TP\n4\noutput cannot be written\n"
      ".TP\n5\nsome of several items failed\n.TP\n128+n\nterminated by signal n\n"
      ".SH FILES\n.TP\n$XDG_CONFIG_HOME/zoneplate/config, ~/.config/zoneplate/config\n"
      "Options and presets of \\fBzoneplate render\\fR.\n"
      ".TP\n$XDG_CACHE_HOME/zoneplate, ~/.cache/zoneplate\nFiltered environments.\n"
      ".SH ENVIRONMENT\n.TP\nNO_COLOR, CLICOLOR_FORCE\nSwitch the colours of messages off and on.\n");
}

}  // namespace zoneplate::cli
