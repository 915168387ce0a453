// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/job/output/background.h"

#include <cstddef>
#include <utility>

#include "zoneplate/base/isa.h"
#include "zoneplate/base/parallel.h"

namespace zoneplate {

Background::~Background() {
  for (std::future<void>& work : running_) work.wait();
}

void Background::run(std::function<void()> work) {
  const auto most = static_cast<std::size_t>(thread_limit());
  if (most == 1) return work();
  while (running_.size() >= most) wait_for_first();
  running_.push_back(std::async(std::launch::async, [work = std::move(work), isa = current_isa()] {
    with_isa(isa, [&] { with_threads(1, work); });
  }));
}

void Background::wait() {
  while (!running_.empty()) wait_for_first();
}

void Background::wait_for_first() {
  std::future<void> first = std::move(running_.front());
  running_.pop_front();
  first.get();
}

}  // namespace zoneplate
