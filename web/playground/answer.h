// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <span>
#include <string>

#include "zoneplate/base/parallel.h"
#include "zoneplate/base/spec.h"
#include "zoneplate/report/json.h"

namespace zoneplate {

/// The number of threads that the page gives the module: 1 without -pthread.
int threads_of_page();

/// Calls `body`, which returns a JSON value and may use these threads, and returns its text, or {"error": ...}. The
/// text is valid until the next call.
template <class Body>
const char* answer(const Body& body) {
  static std::string text;
  try {
    with_threads(threads_of_page(), [&] { text = Json(body()).text(); });
  } catch (const std::exception& error) {
    text = Json(Json::Object{{"error", error.what()}}).text();
  }
  return text.c_str();
}

inline Json::Array params_of(std::span<const Param> params) {
  Json::Array out;
  for (const Param& p : params)
    out.push_back(Json::Object{{"name", p.name},
                               {"meaning", p.meaning},
                               {"value", p.value},
                               {"low", p.low},
                               {"high", p.high},
                               {"choices", Json::Array(p.choices.begin(), p.choices.end())},
                               {"names", Json::Array(p.names.begin(), p.names.end())},
                               {"decimals", p.decimals}});
  return out;
}

}  // namespace zoneplate
