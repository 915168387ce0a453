// SPDX-License-Identifier: Apache-2.0
// The report as one HTML page: a table of all images, and each failed pair as reference, test image and error map.
#include <fmt/format.h>

#include <algorithm>

#include "zoneplate/cli/metrics/judgement_text.h"
#include "zoneplate/codec/png.h"
#include "zoneplate/report/markup.h"

namespace zoneplate::cli {
namespace {

constexpr std::string_view style = R"(
:root { color-scheme: light dark; --line: #8884; --bad: #c62828; --good: #2e7d32; }
@media (prefers-color-scheme: dark) { :root { --bad: #ff8a80; --good: #81c784; } }
body { font: 15px/1.45 system-ui, sans-serif; margin: 2rem auto; max-width: 100rem; padding: 0 1.5rem; }
h1 { font-size: 1.4rem; margin-bottom: .2rem; }
h2 { font-size: 1.05rem; margin: 2rem 0 .3rem; }
table { border-collapse: collapse; }
th, td { text-align: left; padding: .25rem .9rem .25rem 0; border-bottom: 1px solid var(--line); }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; }
.failed { color: var(--bad); font-weight: 600; }
.passed { color: var(--good); }
figure { display: inline-block; margin: .5rem 1rem .5rem 0; vertical-align: top; }
figcaption { font-size: .85rem; opacity: .75; }
img { display: block; max-width: 30vw; min-width: 12rem; image-rendering: pixelated; border: 1px solid var(--line);
  background: repeating-conic-gradient(#bbb 0 25%, #ddd 0 50%) 0 0 / 16px 16px; }
)";

std::string image_of(std::string_view caption, const Rgba8Image& image, const std::string& alternative) {
  if (image.empty()) return {};
  return fmt::format("<figure><img alt=\"{} of {}\" src=\"{}\"><figcaption>{}</figcaption></figure>\n", caption,
                     escape_markup(alternative), data_uri("image/png", encode_png(image)), caption);
}

std::string row_of(const JudgedItem& item, const std::vector<PooledResult>& columns) {
  std::string text = fmt::format("<tr><td>{}</td><td class=\"{}\">{}</td>", escape_markup(item.name),
                                 item.passed() ? "passed" : "failed", name_of(item.outcome));
  for (const PooledResult& column : columns) {
    const auto found = std::ranges::find(item.results, column.metric, &metrics::Result::metric);
    text += fmt::format("<td class=\"number\">{}</td>", found == item.results.end() ? "–" : number_text(found->value));
  }
  return text + fmt::format("<td>{}</td></tr>\n", escape_markup(item.message));
}

}  // namespace

std::string html_of(const Judgement& judgement, const ComparedPaths& paths) {
  const std::size_t count = judgement.items.size(), failures = judgement.failures();
  std::string text = fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<title>{} of {} images failed</title>\n"
      "<style>{}</style>\n</head>\n<body>\n<h1>Image comparison: {} of {} images failed</h1>\n"
      "<p>Test images: {}. References: {}.</p>\n",
      failures, count, style, failures, count, escape_markup(paths.test), escape_markup(paths.reference));
  if (!judgement.pooled_message.empty())
    text += fmt::format("<p class=\"failed\">All images together: {}.</p>\n", escape_markup(judgement.pooled_message));

  text += "<table>\n<thead><tr><th>image</th><th>outcome</th>";
  for (const PooledResult& column : judgement.pooled)
    text += fmt::format("<th class=\"number\">{}{}{}</th>", column.metric->name,
                        column.metric->unit.empty() ? "" : ", ", column.metric->unit);
  text += "<th>reason</th></tr></thead>\n<tbody>\n<tr><td><b>all images</b></td><td></td>";
  for (const PooledResult& column : judgement.pooled)
    text += fmt::format("<td class=\"number\"><b>{}</b></td>", number_text(column.value));
  text += "<td></td></tr>\n";
  for (const bool passed : {false, true})
    for (const JudgedItem& item : judgement.items)
      if (item.passed() == passed) text += row_of(item, judgement.pooled);
  text += "</tbody>\n</table>\n";

  for (const JudgedItem& item : judgement.items) {
    if (item.evidence.test.empty()) continue;
    text +=
        fmt::format("<h2>{}</h2>\n<p class=\"failed\">{}</p>\n", escape_markup(item.name), escape_markup(item.message));
    text += image_of("Reference", item.evidence.reference, item.name);
    text += image_of("Test image", item.evidence.test, item.name);
    text += image_of("Error map", item.evidence.map, item.name);
  }
  return text + "</body>\n</html>\n";
}

}  // namespace zoneplate::cli
