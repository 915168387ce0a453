// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace zoneplate {

/// Whether the text names an antialiasing method, with or without parameters.
bool is_method(std::string_view text);

/// The methods of a list "none,ssaa:n=4", without repetitions; `all` is every method with its defaults and all of its
/// variants.
///
/// Errors    ErrorKind::Usage for a method that does not exist.
std::vector<std::string> compared_methods(const std::string& text);

}  // namespace zoneplate
