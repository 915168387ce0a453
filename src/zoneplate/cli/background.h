#pragma once

#include <deque>
#include <functional>
#include <future>

namespace zoneplate::cli {

/// Does work beside the caller: frames are encoded and written while the next ones are drawn.
///
/// As many pieces go on at a time as there may be threads, with one thread each; where that is one, `run` does the work
/// itself. A piece may end before one that was begun earlier.
class Background {
 public:
  /// Waits for what is still going on; what goes wrong then is lost, so `wait` comes first.
  ~Background();

  /// Begins the work, once there is room for it. Rethrows what earlier work threw.
  void run(std::function<void()> work);
  /// Waits for all work. Rethrows what it threw.
  void wait();

 private:
  void wait_for_first();
  std::deque<std::future<void>> running_;
};

}  // namespace zoneplate::cli
