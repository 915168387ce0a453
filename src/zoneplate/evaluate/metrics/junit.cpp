// SPDX-License-Identifier: Apache-2.0
// JUnit XML, as Jenkins, GitLab and GitHub's actions read it. The format has no standard; these elements and attributes
// are those that the schemas of Jenkins and of Ant have in common.
#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/evaluate/metrics/judgement_text.h"
#include "zoneplate/report/markup.h"

namespace zoneplate {
namespace {

std::string values_of(const JudgedItem& item) {
  std::string text;
  for (const metrics::Result& result : item.results)
    text += fmt::format("{} {}{}{}\n", result.metric->name, number_text(result.value),
                        result.metric->unit.empty() ? "" : " ", result.metric->unit);
  for (const std::string& remark : remarks_of(item)) text += remark + '\n';
  return text;
}

/// True if there was no image to measure: in JUnit an error, not a failure.
bool is_error(const JudgedItem& item) {
  return item.outcome == PairOutcome::Unreadable || item.outcome == PairOutcome::NotRendered;
}

/// What the metrics do not say of the images that pass: of a test case that passes, the format has no text.
std::string remarks_of_passed(const Judgement& judgement) {
  std::string text;
  for (const JudgedItem& item : judgement.items)
    if (item.passed() && item.stored.has_news())
      for (const std::string& remark : remarks_of(item)) text += fmt::format("{}: {}\n", item.name, remark);
  if (!judgement.not_compared.empty()) text += fmt::format("not compared: {}\n", joined(judgement.not_compared));
  return text;
}

}  // namespace

std::string junit_of(const Judgement& judgement, const ComparedPaths& paths, const std::string& time) {
  const auto errors = std::ranges::count_if(judgement.items, is_error);
  const bool has_pooled_case = !judgement.pooled_message.empty();
  const std::size_t failures = judgement.failures() - static_cast<std::size_t>(errors) + has_pooled_case;
  double seconds = 0;
  for (const JudgedItem& item : judgement.items) seconds += item.seconds;
  const std::string suite = escape_markup(paths.test + " against " + paths.reference);

  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
      "  <testsuite name=\"{}\" package=\"zoneplate\" id=\"0\" timestamp=\"{}\" hostname=\"localhost\" tests=\"{}\" "
      "failures=\"{}\" errors=\"{}\" time=\"{:.3f}\">\n    <properties/>\n",
      suite, time, judgement.items.size() + has_pooled_case, failures, errors, seconds);
  for (const JudgedItem& item : judgement.items) {
    text += fmt::format("    <testcase name=\"{}\" classname=\"zoneplate.metrics\" time=\"{:.3f}\"",
                        escape_markup(item.name), item.seconds);
    if (item.passed()) {
      text += "/>\n";
      continue;
    }
    const std::string_view kind = is_error(item) ? "error" : "failure";
    text += fmt::format(">\n      <{} type=\"{}\" message=\"{}\">{}</{}>\n    </testcase>\n", kind,
                        name_of(item.outcome), escape_markup(item.message), escape_markup(values_of(item)), kind);
  }
  if (has_pooled_case)
    text += fmt::format(
        "    <testcase name=\"all images\" classname=\"zoneplate.metrics\" time=\"0.000\">\n      <failure "
        "type=\"failed\" message=\"{}\"></failure>\n    </testcase>\n",
        escape_markup(judgement.pooled_message));
  return text +
         fmt::format("    <system-out>{}</system-out>\n    <system-err></system-err>\n  </testsuite>\n</testsuites>\n",
                     escape_markup(remarks_of_passed(judgement)));
}

}  // namespace zoneplate
