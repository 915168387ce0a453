#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "zoneplate/scene/import_budget.h"

namespace zoneplate {

/// Where a child process writes its answer.
class ImportAnswer {
 public:
  explicit ImportAnswer(int pipe) : pipe_(pipe) {}
  /// Never returns where nobody reads any more.
  void write(const void* data, std::size_t size);
  bool is_begun() const { return is_begun_; }

 private:
  int pipe_;
  bool is_begun_ = false;
};

/// True in the process of an ImportChild: what would be put into one can be done here.
bool is_import_child();

/// Reading that may go wrong in every way, in a process of its own that may be lost.
///
/// The child has limits on memory and time and the filter of sandbox.h; it ends with its parent. `work` makes its
/// result first and writes it then: an Error that it throws before it writes is thrown here again, by the first `read`.
/// Errors    Trouble::Input with `place` in front where the child crashes, runs out of memory or time, or asks the
///           system for what a reader does not need.
class ImportChild {
 public:
  /// `prepare` runs in the child before its rights are taken, to open libraries.
  ImportChild(const std::string& place, ImportBudget& budget, const std::function<void(ImportAnswer&)>& work,
              const std::function<void()>& prepare = {});
  ~ImportChild();
  ImportChild(const ImportChild&) = delete;
  ImportChild& operator=(const ImportChild&) = delete;

  void read(void* out, std::size_t size);

 private:
  std::size_t read_some(void* out, std::size_t size);
  void begin();
  [[noreturn]] void fail();

  std::string place_;
  ImportBudget& budget_;
  int id_ = -1, pipe_ = -1;
  bool is_begun_ = false;
};

}  // namespace zoneplate
