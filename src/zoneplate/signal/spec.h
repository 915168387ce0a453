#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace zoneplate {

/// A parameter of something that is named in text: "sigma" of `gaussian:sigma=2`.
struct SpecParam {
  std::string_view name;
  std::string_view meaning;
  double value = 0;  ///< the default
  double low = 0, high = 0;
};

/// What a text such as `gaussian:sigma=2,radius=6` says.
struct Spec {
  std::string name;
  std::map<std::string, double, std::less<>> values;
};

/// Errors    ErrorKind::Usage for an empty name, a parameter without `=`, one given twice, or not a finite number.
Spec parse_spec(std::string_view text);

/// The value of each of `params`, in their order: as given, or the default.
///
/// Errors    ErrorKind::Usage for a parameter that is not one of them, or a value outside [low, high].
std::vector<double> settle(const Spec& spec, const std::vector<SpecParam>& params);

/// "name:a=1,b=2" with numbers in the shortest form that reads back the same.
std::string text_of(const Spec& spec);

}  // namespace zoneplate
