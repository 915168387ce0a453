// SPDX-License-Identifier: Apache-2.0
#include "mpi_ranks.h"

#include <mpi.h>

#include <algorithm>
#include <cstdint>

namespace zoneplate {
namespace {

/// MPI counts bytes by int.
constexpr std::size_t max_bytes_at_once = std::size_t{1} << 30;

template <class Begin>
void for_pieces(std::size_t size, Begin begin) {
  for (std::size_t at = 0; at < size; at += max_bytes_at_once)
    begin(at, static_cast<int>(std::min(max_bytes_at_once, size - at)));
}

}  // namespace

MpiRanks::MpiRanks() {
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &count_);
}

std::vector<ByteBuffer> MpiRanks::exchange(std::span<const ByteBuffer> to) {
  const auto count = static_cast<std::size_t>(count_);
  std::vector<std::uint64_t> sent(count), received(count);
  for (std::size_t r = 0; r < count; ++r) sent[r] = to[r].size();
  MPI_Alltoall(sent.data(), 1, MPI_UINT64_T, received.data(), 1, MPI_UINT64_T, MPI_COMM_WORLD);
  std::vector<ByteBuffer> from(count);
  std::vector<MPI_Request> requests;
  for (int r = 0; r < count_; ++r) {
    const auto other = static_cast<std::size_t>(r);
    if (r == rank_ || received[other] == 0) continue;
    from[other] = ByteBuffer::unset(static_cast<std::size_t>(received[other]));
    for_pieces(from[other].size(), [&](std::size_t at, int size) {
      MPI_Irecv(from[other].data() + at, size, MPI_BYTE, r, 0, MPI_COMM_WORLD, &requests.emplace_back());
    });
  }
  for (int r = 0; r < count_; ++r) {
    if (r == rank_) continue;
    const ByteBuffer& buffer = to[static_cast<std::size_t>(r)];
    sent_bytes_ += buffer.size();
    for_pieces(buffer.size(), [&](std::size_t at, int size) {
      MPI_Isend(buffer.bytes().data() + at, size, MPI_BYTE, r, 0, MPI_COMM_WORLD, &requests.emplace_back());
    });
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  return from;
}

int MpiRanks::count_on_machine() const {
  MPI_Comm machine;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  int count = 1;
  MPI_Comm_size(machine, &count);
  MPI_Comm_free(&machine);
  return count;
}

}  // namespace zoneplate
