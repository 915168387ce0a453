// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace zoneplate {

/// The version of the JSON reports, their field `version`. It is incremented when the name or the meaning of a field
/// changes. CHANGELOG.md lists the changes.
inline constexpr int report_version = 2;

}  // namespace zoneplate
