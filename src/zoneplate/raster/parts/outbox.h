// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zoneplate/base/parallel.h"
#include "zoneplate/base/ranks/ranks.h"

namespace zoneplate {

/// A message from one rank to another about a tile.
struct TileMessage {
  std::uint32_t tile;
  std::uint32_t flags;
  std::span<const std::byte> bytes;
};

/// Messages about tiles, which the threads of a loop write at the same time.
class Outbox {
 public:
  /// It must be constructed inside the `with_threads` in which it is used. `capacity`: the bytes that a thread may send
  /// to a rank, for which address space is reserved once it has sent many, so that they are not copied again and again.
  explicit Outbox(Ranks& ranks, std::size_t capacity = 0) : ranks_(ranks), capacity_(capacity) {}

  /// Sends a message, whose bytes write(buffer) appends.
  template <class Write>
  void send(int rank, std::uint32_t tile, std::uint32_t flags, Write write) {
    ByteBuffer& to = threads_.local(static_cast<std::size_t>(ranks_.count()))[static_cast<std::size_t>(rank)];
    constexpr std::size_t many = std::size_t{1} << 19;
    const std::size_t at = to.size();
    if (at > many && at < capacity_) to.reserve(capacity_ - at);
    to.put(Head{tile, flags, 0});
    write(to);
    const Head head{tile, flags, to.size() - at - sizeof(Head)};
    std::memcpy(to.data() + at, &head, sizeof head);
  }
  void send(int rank, std::uint32_t tile, std::uint32_t flags) {
    send(rank, tile, flags, [](ByteBuffer&) {});
  }

  /// Exchanges all messages with the other ranks: use(rank, message) is called for each one to this rank, also of its
  /// own. The bytes last as long as the outbox.
  template <class Use>
  void exchange(Use use) {
    join_threads();
    received_ = ranks_.exchange(sent_);
    received_[own()] = ByteBuffer();
    for (std::size_t r = 0; r < received_.size(); ++r)
      for_messages((r == own() ? sent_[r] : received_[r]).bytes(),
                   [&](const TileMessage& message) { use(static_cast<int>(r), message); });
  }
  /// Calls use(message) for each message that this rank has sent.
  template <class Use>
  void for_sent(Use use) const {
    for (const ByteBuffer& buffer : sent_) for_messages(buffer.bytes(), use);
  }

 private:
  struct Head {
    std::uint32_t tile, flags;
    std::uint64_t size;
  };
  std::size_t own() const { return static_cast<std::size_t>(ranks_.rank()); }

  template <class Use>
  static void for_messages(std::span<const std::byte> bytes, Use use) {
    ByteReader reader(bytes);
    while (!reader.is_at_end()) {
      const auto head = reader.take<Head>();
      use(TileMessage{head.tile, head.flags, reader.take(static_cast<std::size_t>(head.size))});
    }
  }

  void join_threads() {
    sent_.resize(static_cast<std::size_t>(ranks_.count()));
    threads_.for_each([&](std::vector<ByteBuffer>& of_thread) {
      for (std::size_t r = 0; r < sent_.size(); ++r)
        if (sent_[r].size() == 0)
          sent_[r] = std::move(of_thread[r]);
        else
          sent_[r].append(of_thread[r].bytes());
    });
  }

  Ranks& ranks_;
  std::size_t capacity_;
  PerThread<std::vector<ByteBuffer>> threads_;
  std::vector<ByteBuffer> sent_, received_;
};

}  // namespace zoneplate
