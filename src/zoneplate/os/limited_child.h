// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "zoneplate/base/error.h"

namespace zoneplate {

/// The stream to which a child process writes its answer.
class ChildAnswer {
 public:
  explicit ChildAnswer(int pipe) : pipe_(pipe) {}
  /// Does not return if the reader is gone.
  void write(const void* data, std::size_t size);
  bool is_begun() const { return is_begun_; }

 private:
  int pipe_;
  bool is_begun_ = false;
};

/// The error of a child that ended without its whole answer: it crashed, or it was killed.
class ChildEnded : public Error {
 public:
  using Error::Error;
};

class LimitedChild;

/// Children that work at the same time, while the parent reads their answers one after the other.
///
/// As long as the parent waits for one of them, it moves the answers of the others into memory, so that they do not
/// wait for it.
class LimitedChildren {
 public:
  /// `has_ended` is called when a child whose answer the parent does not read at present has written all of it.
  /// Requires  it throws nothing; it may start children.
  explicit LimitedChildren(std::function<void()> has_ended) : has_ended_(std::move(has_ended)) {}
  LimitedChildren(const LimitedChildren&) = delete;
  LimitedChildren& operator=(const LimitedChildren&) = delete;

 private:
  friend class LimitedChild;
  /// Waits for at most 50 ms until the child's answer can be read; whether it can.
  bool wait_for(const LimitedChild& child);

  std::function<void()> has_ended_;
  std::vector<LimitedChild*> all_;
};

/// True in the process of a LimitedChild, in which work does not need another child.
bool is_limited_child();

/// Runs work on untrusted data in a child process, a fork of this one.
///
/// The child has limits of memory and time and the sandbox of sandbox.h; it ends with its parent, and is killed by the
/// destructor. `work` computes its result first and then writes it: an Error that it throws before the first write is
/// rethrown in the parent by the first `read`.
/// Errors    ChildEnded, of ErrorKind::Input with `place` in front, if the child crashes, exceeds its memory or time, or makes a system
///           call that reading does not need; ErrorKind::Failed if no process can be started.
class LimitedChild {
 public:
  struct Limits {
    std::uint64_t memory = std::uint64_t{1} << 30;  ///< bytes beyond the memory that the process has at the start
    double seconds = 60;                            ///< processor time per thread
    /// The options that raise the limits, for error messages; may be empty.
    std::string options;
    std::function<void()> check_time;  ///< called while the parent waits; throws when its own limit is exceeded
    bool is_sandboxed = true;          ///< false: only the limits apply
    std::optional<std::vector<std::string>> readable = {};  ///< files and folders; nothing: all that the user may read
    /// The subject of error messages about the end of the child.
    std::string worker = "its reader";
    bool ignores_termination = false;     ///< SIGTERM ends the child only with its parent
    LimitedChildren* siblings = nullptr;  ///< the child becomes one of them; they outlive it
  };

  /// `open` runs in the child before the sandbox is entered, to open libraries.
  LimitedChild(std::string place, Limits limits, const std::function<void(ChildAnswer&)>& work,
               const std::function<void()>& open = {});
  ~LimitedChild();
  LimitedChild(const LimitedChild&) = delete;
  LimitedChild& operator=(const LimitedChild&) = delete;

  void read(void* out, std::size_t size);

  /// Whether the child's whole answer is in the parent's memory.
  bool has_ended() const { return has_ended_; }

 private:
  friend class LimitedChildren;
  void keep_some();
  std::size_t take_kept(void* out, std::size_t size);
  bool wait() const;
  std::size_t read_some(void* out, std::size_t size);
  void begin();
  [[noreturn]] void fail();

  std::string place_;
  Limits limits_;
  int id_ = -1, pipe_ = -1;
  bool is_begun_ = false, has_ended_ = false;
  std::vector<std::uint8_t> kept_;  ///< read ahead
  std::size_t taken_ = 0;           ///< bytes of `kept_` that `read` has returned
};

}  // namespace zoneplate
