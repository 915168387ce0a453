// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/cli/progress.h"

#include <fmt/format.h>

#include "zoneplate/base/utf8.h"
#include "zoneplate/cli/log.h"
#include "zoneplate/job/option/values.h"
#include "zoneplate/report/json.h"

namespace zoneplate::cli {

// Control sequence: return to column 0, clear to the end of the line (ECMA-48, EL).
constexpr std::string_view wipe = "\r\x1b[K";

void Progress::begin(std::string_view stage, double done) {
  if (kind_ == ProgressKind::None) return;
  std::string line;
  if (kind_ == ProgressKind::Json) {
    line = Json(Json::Object{{"stage", stage}, {"done", done}}).text() + '\n';
  } else {
    constexpr int cells = 24;
    const int full = static_cast<int>(done * cells);
    line = fmt::format("{}[{:#<{}}{:.<{}}] {}", wipe, "", full, "", cells - full, printable(stage));
    const double seconds = watch_.ms() / 1000, left = done > 0 ? seconds / done - seconds : 0;
    if (seconds > 2 && left >= 1)
      line += left < 100 ? fmt::format(", {:.0f} s left", left) : fmt::format(", {:.0f} min left", left / 60);
  }
  write_to_stderr(line);
}

void Progress::clear() {
  if (kind_ == ProgressKind::Bar) write_to_stderr(wipe);
}

ProgressKind parse_progress(const std::string& text) {
  constexpr ProgressKind kinds[] = {ProgressKind::None, ProgressKind::Bar, ProgressKind::Json};
  const std::size_t choice = parse_choice(text, {"auto", "none", "bar", "json"});
  if (choice == 0) return stderr_is_terminal() ? ProgressKind::Bar : ProgressKind::None;
  return kinds[choice - 1];
}

}  // namespace zoneplate::cli
