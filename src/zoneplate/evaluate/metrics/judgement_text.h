// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "zoneplate/evaluate/metrics/judge.h"
#include "zoneplate/report/json.h"

namespace zoneplate {

/// The operands as they were given, for reports.
struct ComparedPaths {
  std::string reference, test;
};

/// The result for people: the pooled values, then a line for each image that failed.
std::string text_of(const Judgement& judgement);

/// The result for programs.
Json json_of(const Judgement& judgement, const ComparedPaths& paths);

/// The result as JUnit XML, with one test case for each image; `time` is the UTC time in ISO 8601.
std::string junit_of(const Judgement& judgement, const ComparedPaths& paths, const std::string& time);

/// The result as a page for a browser (report/html_page.h), with the evidence of the items.
std::string html_of(const Judgement& judgement, const ComparedPaths& paths);

/// What the metrics do not say of a pair, a line each: stored values that differ or are not finite, layers that were
/// only compared for equality, and what was not compared.
std::vector<std::string> remarks_of(const JudgedItem& item);

/// The texts with commas between them.
std::string joined(const std::vector<std::string>& texts);

/// What standard error reports if something failed: one line; empty if everything passed.
std::string failure_of(const Judgement& judgement);

/// "passed", "failed", "missing", "new", "unreadable" or "not rendered".
std::string_view name_of(PairOutcome outcome);

}  // namespace zoneplate
