// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <barrier>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

#include "zoneplate/base/ranks/ranks.h"

namespace zoneplate {

/// Ranks that are threads of this process.
class ThreadRanks {
 public:
  explicit ThreadRanks(int count) : count_(count), barrier_(count), sent_(static_cast<std::size_t>(count)) {}

  /// Calls body(ranks) for each rank at once, and waits for all. An exception that every rank throws is thrown here.
  void run(const std::function<void(Ranks&)>& body) {
    std::vector<std::exception_ptr> errors(static_cast<std::size_t>(count_));
    {
      std::vector<std::jthread> threads;
      for (int r = 0; r < count_; ++r)
        threads.emplace_back([&, r] {
          try {
            One own(*this, r);
            body(own);
          } catch (...) {
            errors[static_cast<std::size_t>(r)] = std::current_exception();
          }
        });
    }
    if (errors.front()) std::rethrow_exception(errors.front());
  }

 private:
  class One : public Ranks {
   public:
    One(ThreadRanks& all, int rank) : all_(all), rank_(rank) {}
    int rank() const override { return rank_; }
    int count() const override { return all_.count_; }
    std::vector<ByteBuffer> exchange(std::span<const ByteBuffer> to) override {
      all_.sent_[static_cast<std::size_t>(rank_)] = to;
      all_.barrier_.arrive_and_wait();
      std::vector<ByteBuffer> from(to.size());
      for (std::size_t r = 0; r < to.size(); ++r)
        if (static_cast<int>(r) != rank_) from[r].append(all_.sent_[r][static_cast<std::size_t>(rank_)].bytes());
      all_.barrier_.arrive_and_wait();
      return from;
    }

   private:
    ThreadRanks& all_;
    int rank_;
  };

  int count_;
  std::barrier<> barrier_;
  std::vector<std::span<const ByteBuffer>> sent_;
};

}  // namespace zoneplate
