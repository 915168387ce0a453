// SPDX-License-Identifier: Apache-2.0
// zoneplate completions: scripts for tab completion, from the tables of options of all verbs.
#include "zoneplate/cli/completions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "zoneplate/base/error.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/cli/verbs.h"
#include "zoneplate/job/option/values.h"

namespace zoneplate::cli {
namespace {

constexpr std::array<std::string_view, 3> shells = {"bash", "zsh", "fish"};

// True for options whose value is the name of a file or folder.
bool takes_path(const Option& option) {
  constexpr std::string_view placeholders[] = {"FILE", "OUT", "PATH", "DIR", "REF"};
  return std::ranges::find(placeholders, option.value) != std::end(placeholders);
}

// A text in single quotes; an apostrophe in it is written by `apostrophe`.
std::string quoted(std::string_view text, std::string_view apostrophe) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'')
      out += apostrophe;
    else if (c == '\n')
      out += ' ';
    else
      out += c;
  }
  return out + "'";
}

// A name as an identifier of a shell: "contact_sheet", "sdf_from_mask".
std::string identifier(std::string name) {
  std::ranges::replace_if(
      name, [](char c) { return c == '-' || c == ' '; }, '_');
  return name;
}

std::string bash_case(const Syntax& syntax) {
  std::vector<std::string> all = {"-h", "--help"};
  std::string values;
  for (const Option& option : syntax.options) {
    const std::vector<std::string> names = names_of(option);
    all.insert(all.end(), names.begin(), names.end());
    if (option.value.empty()) continue;
    const std::string words = takes_path(option)       ? "-"
                              : option.choices.empty() ? ""
                                                       : fmt::format("{}", fmt::join(option.choices, " "));
    values += fmt::format("        {}) values='{}' takes_value=1 ;;\n", fmt::join(names, "|"), words);
  }
  return fmt::format("    '{}')\n      options='{}'\n      case $previous in\n{}      esac ;;\n", syntax.verb,
                     fmt::join(all, " "), values);
}

std::string zsh_function(const Syntax& syntax) {
  std::string text = fmt::format("_zoneplate_{}() {{\n  _arguments -S", identifier(syntax.verb));
  for (const Option& option : syntax.options) {
    const std::vector<std::string> names = names_of(option);
    std::string meaning;
    for (const char c : option.meaning)
      meaning += c == '[' || c == ']' || c == ':' ? std::string("\\") + c : std::string(1, c);
    const std::string action = takes_path(option)       ? "_files"
                               : option.choices.empty() ? " "
                                                        : fmt::format("({})", fmt::join(option.choices, " "));
    const std::string value = option.value.empty() ? "" : fmt::format(":{}:{}", option.value, action);
    for (const std::string& name : names)
      text += " \\\n    " + quoted(fmt::format("({}){}{}[{}]{}", fmt::join(names, " "), name,
                                               option.value.empty()     ? ""
                                               : name.starts_with("--") ? "="
                                                                        : "+",
                                               meaning, value),
                                   "'\\''");
  }
  return text + " \\\n    '*:input:_files'\n}\n";
}

// fish: the condition under which the completions of a verb apply. Render also applies without any verb.
std::string fish_condition(const std::string& verb) {
  const std::size_t space = verb.find(' ');
  if (verb == "render") return "__zoneplate_renders";
  if (space == verb.npos) return "__fish_seen_subcommand_from " + verb;
  return fmt::format("__fish_seen_subcommand_from {}; and __fish_seen_subcommand_from {}", verb.substr(0, space),
                     verb.substr(space + 1));
}

std::string fish_lines(const Syntax& syntax) {
  std::string text;
  for (const Option& option : syntax.options) {
    std::string line = "complete -c zoneplate -n " + quoted(fish_condition(syntax.verb), "\\'");
    for (const std::string& name : names_of(option))
      line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!option.value.empty()) line += takes_path(option) ? " -r -F" : " -x";
    if (!option.choices.empty()) line += fmt::format(" -a '{}'", fmt::join(option.choices, " "));
    text += line + " -d " + quoted(option.meaning, "\\'") + '\n';
  }
  return text;
}

std::vector<std::string> names_of(std::span<const Verb> verbs) {
  std::vector<std::string> names;
  for (const Verb& verb : verbs) names.emplace_back(verb.name);
  return names;
}

// Prints the part of each verb.
void print_verbs(Shell shell) {
  const std::string form = fmt::format("--help={}", shells[static_cast<std::size_t>(shell)]);
  for (const Verb& verb : all_verbs()) {
    if (verb.subcommands == nullptr) verb.run({&form, 1});
    if (verb.subcommands != nullptr)
      for (const Verb& each : verb.subcommands()) each.run({&form, 1});
  }
}

void print_bash() {
  print(fmt::format(R"(# Tab completion of zoneplate for bash; made by `zoneplate completions bash`.
_zoneplate() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}}
  local verbs='{}' verb=render subcommands='' options='' values='' takes_value=''
  if [[ $current == '=' ]]; then current=''
  elif [[ $previous == '=' ]]; then previous=${{COMP_WORDS[COMP_CWORD-2]}}; fi
  COMPREPLY=()
  case " $verbs " in *" ${{COMP_WORDS[1]}} "*) ((COMP_CWORD > 1)) && verb=${{COMP_WORDS[1]}} ;; esac
  case $verb in
)",
                    fmt::join(names_of(all_verbs()), " ")));
  for (const Verb& verb : all_verbs())
    if (verb.subcommands != nullptr)
      print(fmt::format("    {}) subcommands='{}' ;;\n", verb.name, fmt::join(names_of(verb.subcommands()), " ")));
  print(R"(  esac
  if [[ -n $subcommands ]]; then
    if ((COMP_CWORD == 2)); then
      COMPREPLY=($(compgen -W "$subcommands" -- "$current"))
      return
    fi
    verb="$verb ${COMP_WORDS[2]}"
  fi
  case $verb in
)");
  print_verbs(Shell::Bash);
  print(R"(  esac
  if [[ $values == - ]]; then
    COMPREPLY=($(compgen -f -- "$current"))
  elif [[ -n $takes_value ]]; then
    COMPREPLY=($(compgen -W "$values" -- "$current"))
  elif [[ $current == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$current"))
  else
    ((COMP_CWORD == 1)) && COMPREPLY=($(compgen -W "$verbs" -- "$current"))
    COMPREPLY+=($(compgen -f -- "$current"))
  fi
}
complete -o filenames -o bashdefault -F _zoneplate zoneplate
)");
}

void print_zsh() {
  print("#compdef zoneplate\n# Tab completion of zoneplate for zsh; made by `zoneplate completions zsh`.\n");
  print_verbs(Shell::Zsh);
  std::string verbs, cases;
  for (const Verb& verb : all_verbs()) {
    verbs += fmt::format("    {}\n", quoted(fmt::format("{}:{}", verb.name, verb.summary), "'\\''"));
    if (verb.subcommands == nullptr) {
      cases += fmt::format("    {0}) shift words; ((CURRENT--)); _zoneplate_{1} ;;\n", verb.name,
                           identifier(std::string(verb.name)));
      continue;
    }
    cases += fmt::format("    {}) if ((CURRENT == 3)); then compadd {}; else\n", verb.name,
                         fmt::join(names_of(verb.subcommands()), " "));
    cases +=
        "      local subcommand=${words[3]//-/_}; shift 2 words; ((CURRENT -= 2)); "
        "(( $+functions[_zoneplate_" +
        identifier(std::string(verb.name)) + "_$subcommand] )) && _zoneplate_" + identifier(std::string(verb.name)) +
        "_$subcommand; fi ;;\n";
  }
  print("_zoneplate() {\n  local -a verbs=(\n" + verbs + "  )\n" +
        "  if ((CURRENT == 2)) && [[ $words[2] != -* ]]; then _describe verb verbs; _files; return; fi\n" +
        "  case $words[2] in\n" + cases + "    *) _zoneplate_render ;;\n  esac\n}\n_zoneplate \"$@\"\n");
}

void print_fish() {
  print("# Tab completion of zoneplate for fish; made by `zoneplate completions fish`.\n");
  std::vector<std::string> others;
  for (const std::string& name : names_of(all_verbs()))
    if (name != "render") others.push_back(name);
  print(
      fmt::format("function __zoneplate_renders\n  not __fish_seen_subcommand_from {}\nend\n", fmt::join(others, " ")));
  for (const Verb& verb : all_verbs()) {
    print(fmt::format("complete -c zoneplate -n __fish_use_subcommand -a {} -d {}\n", verb.name,
                      quoted(verb.summary, "\\'")));
    if (verb.subcommands == nullptr) continue;
    const std::string names = fmt::format("{}", fmt::join(names_of(verb.subcommands()), " "));
    for (const Verb& each : verb.subcommands())
      print(
          fmt::format("complete -c zoneplate -n '__fish_seen_subcommand_from {}; and not "
                      "__fish_seen_subcommand_from {}' -a {} -d {}\n",
                      verb.name, names, each.name, quoted(each.summary, "\\'")));
  }
  print_verbs(Shell::Fish);
}

}  // namespace

std::optional<Shell> shell_of(std::string_view name) {
  const auto found = std::ranges::find(shells, name);
  if (found == shells.end()) return std::nullopt;
  return static_cast<Shell>(found - shells.begin());
}

std::string completions_of(const Syntax& syntax, Shell shell) {
  return shell == Shell::Bash ? bash_case(syntax) : shell == Shell::Zsh ? zsh_function(syntax) : fish_lines(syntax);
}

void run_completions(std::span<const std::string> arguments) {
  Syntax syntax{.verb = "completions",
                .summary = "Print the tab completions of a shell: bash, zsh or fish",
                .operands = "SHELL",
                .examples =
                    "  source <(zoneplate completions bash)\n"
                    "  zoneplate completions zsh > ~/.zfunc/_zoneplate      in a folder of $fpath\n"
                    "  zoneplate completions fish > ~/.config/fish/completions/zoneplate.fish\n"};
  if (!parse(syntax, arguments)) return;
  if (syntax.found_operands.size() != 1) throw Error(ErrorKind::Usage, "completions: give a shell, bash, zsh or fish");
  constexpr void (*printers[])() = {print_bash, print_zsh, print_fish};
  printers[parse_choice(syntax.found_operands[0], shells)]();
}

}  // namespace zoneplate::cli
