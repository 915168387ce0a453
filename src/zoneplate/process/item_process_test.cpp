// SPDX-License-Identifier: Apache-2.0
#include "zoneplate/process/item_process.h"
#include "zoneplate/job/import_time.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "zoneplate/base/deadline.h"
#include "zoneplate/base/error.h"
#include "zoneplate/base/out_of_memory.h"
#include "zoneplate/os/sandbox.h"
#include "zoneplate/process/packed.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

ItemLimits small_limits() {
  ItemLimits limits{.name = "model.xyz", .load = {}};
  limits.load.memory = std::uint64_t{64} << 20;
  return limits;
}

struct Ending {
  std::optional<ErrorKind> trouble;
  std::string message;
  bool operator==(const Ending&) const = default;
};

Ending ending_of(ItemProcess& process, const ItemEvents& events = {}) {
  try {
    process.next(events);
    return {};
  } catch (const Error& error) {
    return {error.kind(), error.what()};
  }
}

Ending ending_of(const std::function<void(ItemSender&)>& deed, const ItemLimits& limits = small_limits()) {
  ItemProcess process(limits, 1, [&](std::size_t, ItemSender& sender) { return deed(sender), Bytes{}; });
  return ending_of(process);
}

TEST(ItemProcess, SendsFilesFramesAndItsResult) {
  ItemProcess process(small_limits(), 1, [](std::size_t, ItemSender& sender) {
    sender.progress("read", 0.25);
    sender.has_read();
    sender.file(7, -1, Bytes{1, 2, 3});
    sender.film_frame(Rgba8Image(2, 1, {4, 5, 6, 7}));
    return Bytes{9};
  });
  std::string seen;
  ItemEvents events;
  events.progress = [&](std::string_view stage, double done) {
    seen += std::string(stage) + std::to_string(done) + ' ';
  };
  events.file = [&](int frame, int layer, std::uint64_t size, const ItemEvents::Read& read) {
    Bytes bytes(size);
    read(bytes);
    EXPECT_EQ(bytes, (Bytes{1, 2, 3}));
    seen += "file " + std::to_string(frame) + ' ' + std::to_string(layer) + ' ';
  };
  events.film_frame = [&](std::uint64_t size, const ItemEvents::Read& read) {
    Bytes bytes(size);
    read(bytes);
    EXPECT_EQ(bytes, (Bytes{4, 5, 6, 7, 4, 5, 6, 7}));
    seen += "frame";
  };
  EXPECT_EQ(process.next(events), Bytes{9});
  EXPECT_EQ(seen, "read0.250000 file 7 -1 frame");
}

TEST(ItemProcess, ErrorsAreOfReadingOrOfRendering) {
  const Ending usage{ErrorKind::Usage, "no such option"};
  EXPECT_EQ(ending_of([](ItemSender&) { throw Error(ErrorKind::Usage, "no such option"); }), usage);
  const auto crash = [](ItemSender& sender) { sender.progress("x", 0), std::abort(); };
  EXPECT_EQ(ending_of(crash), (Ending{ErrorKind::Input, "model.xyz: its process crashed (signal 6)"}));
  const auto late_crash = [](ItemSender& sender) { sender.has_read(), std::abort(); };
  EXPECT_EQ(ending_of(late_crash), (Ending{ErrorKind::Failed, "model.xyz: its process crashed (signal 6)"}));
  const auto killed = [](ItemSender& sender) { sender.has_read(), ::raise(SIGKILL); };
  ItemLimits trusted = small_limits();
  trusted.is_sandboxed = false;
  EXPECT_EQ(ending_of(killed, trusted).message,
            "model.xyz: its process ran out of time or memory (--max-memory, --max-seconds)");
  EXPECT_EQ(ending_of([](ItemSender&) { throw std::length_error("too long"); }),
            (Ending{ErrorKind::Failed, "model.xyz: too long"}));
}

TEST(ItemProcess, GoesOnAfterAJobThatFails) {
  ItemProcess process(small_limits(), 5, [](std::size_t job, ItemSender&) {
    if (job == 1) throw Error(ErrorKind::Input, "one");
    if (job == 2) std::abort();
    return Bytes{static_cast<std::uint8_t>(job)};
  });
  EXPECT_EQ(process.next({}), Bytes{0});
  EXPECT_EQ(ending_of(process).message, "one");
  EXPECT_EQ(ending_of(process).message, "model.xyz: its process crashed (signal 6)");
  EXPECT_EQ(process.next({}), Bytes{3});
  EXPECT_EQ(process.next({}), Bytes{4});
}

TEST(ItemProcess, WhatTheReceiverThrowsEndsThatJobAlone) {
  ItemProcess process(small_limits(), 2, [](std::size_t job, ItemSender& sender) {
    sender.file(-1, -1, Bytes(1 << 21));
    return Bytes{static_cast<std::uint8_t>(job)};
  });
  ItemEvents full_disk;
  full_disk.file = [](int, int, std::uint64_t, const ItemEvents::Read&) { throw Error(ErrorKind::Output, "full"); };
  EXPECT_EQ(ending_of(process, full_disk), (Ending{ErrorKind::Output, "full"}));
  ItemEvents taken;
  taken.file = [](int, int, std::uint64_t size, const ItemEvents::Read& read) {
    Bytes bytes(size);
    read(bytes);
  };
  EXPECT_EQ(process.next(taken), Bytes{1});
}

TEST(ItemProcess, MemoryIsNamedByWhatGrew) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer's allocator ends the process by itself";
#endif
  const auto grow = [](ItemSender&) {
    std::vector<Bytes> all;
    for (;;) all.emplace_back(1 << 20, std::uint8_t{1});
  };
  EXPECT_EQ(ending_of(grow), (Ending{ErrorKind::Input,
                                     "model.xyz: reading it needs more memory than the limit of 64 MB "
                                     "(--max-memory)"}));
  const auto grow_late = [&](ItemSender& sender) {
    sender.has_read();
    growing("screen vertices", [&] { grow(sender); });
  };
  EXPECT_EQ(ending_of(grow_late), (Ending{ErrorKind::Failed,
                                          "model.xyz: screen vertices need more memory than the limit "
                                          "of 64 MB (--max-memory)"}));
  // Allocations of libraries count too.
  const auto grow_by_malloc = [](ItemSender&) {
    for (int i = 0; i < 128; ++i)
      if (void* const memory = std::malloc(1 << 20); !memory) throw Error(ErrorKind::Input, "malloc failed");
  };
  EXPECT_EQ(ending_of(grow_by_malloc).message, "malloc failed");
}

void sleep_seconds(double s) { std::this_thread::sleep_for(std::chrono::duration<double>(s)); }

TEST(ItemProcess, TimeIsKeptWithAndWithoutItsHelp) {
  ItemLimits hurried = small_limits();
  hurried.load.seconds = 0.05;
  const Ending late{ErrorKind::Input,
                    "model.xyz: takes longer to load than the limit of 0.05 s (--max-import-seconds)"};
  const auto polite = [&](ItemSender&) {
    within_import_time("model.xyz", hurried.load, [] {
      for (;;) sleep_seconds(0.01), check_deadline();
    });
  };
  EXPECT_EQ(ending_of(polite, hurried), late);
  EXPECT_EQ(ending_of([](ItemSender&) { sleep_seconds(100); }, hurried), late);
  // The limit of reading counts neither what happens between files nor the file before.
  hurried.load.seconds = 1;
  const auto between_files = [](ItemSender& sender) {
    sleep_seconds(0.9), sender.has_read(), sleep_seconds(1), sender.begins_to_read(""), sleep_seconds(0.1);
    throw Error(ErrorKind::Input, "read");
  };
  EXPECT_EQ(ending_of(between_files, hurried), (Ending{ErrorKind::Input, "read"}));
  const auto late_second = [](ItemSender& sender) { sender.has_read(), sender.begins_to_read(""), sleep_seconds(100); };
  hurried.load.seconds = 0.05;
  EXPECT_EQ(ending_of(late_second, hurried), late);

  ItemLimits short_item = small_limits();
  short_item.seconds = 0.05;
  const Ending too_long{ErrorKind::Failed, "model.xyz: takes longer than the limit of 0.05 s (--max-seconds)"};
  const auto slow = [](ItemSender& sender) { sender.has_read(), sleep_seconds(100); };
  EXPECT_EQ(ending_of(slow, short_item), too_long);
  const auto checked = [](ItemSender& sender) {
    for (sender.has_read();;) sleep_seconds(0.01), check_deadline();
  };
  EXPECT_EQ(ending_of(checked, short_item), too_long);
}

TEST(ItemProcess, HasNoRightsButToReadItsFolder) {
  const std::string folder = testing::TempDir() + "zoneplate_item_" + std::to_string(::getpid());
  ASSERT_EQ(::system(("mkdir -p " + folder + "/in " + folder + "/out").c_str()), 0);
  for (const char* name : {"/in/a", "/out/a"}) std::ofstream(folder + name) << "x";
  ItemLimits limits = small_limits();
  limits.readable = std::vector<std::string>{folder + "/in"};

  const auto opens = [](const std::string& path) {
    return [path](ItemSender&) {
      const int file = ::open(path.c_str(), O_RDONLY);
      if (file < 0) throw Error(ErrorKind::Input, "model.xyz: cannot be read: " + std::to_string(errno));
    };
  };
  EXPECT_EQ(ending_of(opens(folder + "/in/a"), limits), Ending{});
  if (sandbox_lacks().files.empty()) {
    EXPECT_EQ(ending_of(opens(folder + "/out/a"), limits),
              (Ending{ErrorKind::Input, "model.xyz: cannot be read: " + std::to_string(EACCES)}));
    EXPECT_EQ(ending_of(opens("/etc/passwd"), limits).trouble, ErrorKind::Input);
  }
  const Ending ended{ErrorKind::Input,
                     "model.xyz: its process made a system call that it has no right to, and was ended"};
  EXPECT_EQ(ending_of([&](ItemSender&) { ::open((folder + "/in/b").c_str(), O_WRONLY | O_CREAT, 0600); }, limits),
            ended);
  EXPECT_EQ(ending_of([&](ItemSender&) { static_cast<void>(::fork()); }, limits), ended);
  EXPECT_EQ(ending_of([&](ItemSender&) { ::socket(AF_INET, SOCK_STREAM, 0); }, limits), ended);
  EXPECT_NE(::access((folder + "/in/b").c_str(), F_OK), 0);
  ASSERT_EQ(::system(("rm -r " + folder).c_str()), 0);
}

TEST(ItemMessages, BytesThatAreNoMessageAreAnError) {
  ItemEvents events;
  events.file = [](int, int, std::uint64_t size, const ItemEvents::Read& read) {
    Bytes some(std::min<std::uint64_t>(size, 100));
    read(some);
  };
  const auto receive = [&](const Bytes& bytes) {
    std::size_t at = 0;
    const auto source = [&](std::span<std::uint8_t> out) {
      if (out.size() > bytes.size() - at) throw Error(ErrorKind::Input, "at its end");
      std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), out.size(), out.begin());
      at += out.size();
    };
    receive_message("model.xyz", events, source);
  };
  Bytes sent;
  ItemSender sender([&](std::span<const std::uint8_t> bytes) { sent.insert(sent.end(), bytes.begin(), bytes.end()); });
  sender.file(1, 2, Bytes(50));
  EXPECT_NO_THROW(receive(sent));
  for (std::size_t i = 0; i < 24; ++i) {
    Bytes damaged = sent;
    damaged[i] = 0xff;
    if (const bool is_padding = (i > 0 && i < 4) || (i >= 12 && i < 16); is_padding)
      EXPECT_NO_THROW(receive(damaged)) << i;
    else if (const bool is_a_number = i >= 4 && i < 11; is_a_number)  // frames may be negative
      EXPECT_NO_THROW(receive(damaged)) << i;
    else
      EXPECT_THROW(receive(damaged), Error) << i;
  }
  EXPECT_THROW(receive({sent.begin(), sent.end() - 1}), Error);
  sent.clear();
  sender.file(1, 2, Bytes(150));  // the receiver reads 100 of these bytes
  EXPECT_THROW(receive(sent), Error);
}

TEST(Packed, ComesOutAsItWentIn) {
  Packer in;
  in.value(3.5), in.text("abc"), in.value(std::uint8_t{7});
  const Bytes bytes = std::move(in).bytes();
  Unpacker out(bytes);
  EXPECT_EQ(out.value<double>(), 3.5);
  EXPECT_EQ(out.text(), "abc");
  EXPECT_EQ(out.value<std::uint8_t>(), 7);
  EXPECT_THROW(out.value<std::uint8_t>(), Error);
  Packer lie;
  lie.value(~std::uint64_t{0});
  const Bytes short_bytes = std::move(lie).bytes();
  EXPECT_THROW(Unpacker(short_bytes).text(), Error);
}

}  // namespace
}  // namespace zoneplate
