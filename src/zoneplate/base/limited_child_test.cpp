#include "zoneplate/base/limited_child.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <vector>

#include "zoneplate/base/clock.h"

namespace zoneplate {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(LimitedChild, SendsItsAnswer) {
  Bytes sent(300'000);  // more than a pipe holds
  for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = static_cast<std::uint8_t>(i * 7);
  LimitedChild child({}, [&](const LimitedChild::Send& send) {
    send(std::span(sent).first(1000));
    send(std::span(sent).subspan(1000));
  });
  Bytes read(sent.size()), more(1);
  EXPECT_TRUE(child.read(read));
  EXPECT_EQ(read, sent);
  EXPECT_FALSE(child.read(more));
}

std::string cause_of(const LimitedChild::Limits& limits, const std::function<void(const LimitedChild::Send&)>& work) {
  LimitedChild child(limits, work);
  Bytes read(10);
  EXPECT_FALSE(child.read(read));
  return child.cause();
}

TEST(LimitedChild, TellsWhyItHasNoAnswer) {
  EXPECT_EQ(cause_of({}, [](auto&) { throw LimitedChild::Refusal{"is\npurple"}; }), "is purple");
  EXPECT_EQ(cause_of({}, [](auto&) { std::raise(SIGKILL); }), "crashed its reader");
  EXPECT_EQ(cause_of({}, [](auto& send) { send(Bytes{1, 2, 3}); }), "crashed its reader");
}

TEST(LimitedChild, IsStoppedAtItsLimits) {
  const Stopwatch watch;
  const auto wait_for_ever = [](auto&) {
    for (volatile int i = 0;;) i = i + 1;
  };
  EXPECT_EQ(cause_of({.seconds = 0.2}, wait_for_ever), "takes longer than the limit");
  EXPECT_LT(watch.ms(), 5000);
}

TEST(LimitedChild, ALateOneIsNotWaitedFor) {
  const Stopwatch watch;
  {
    LimitedChild child({}, [](auto&) { ::pause(); });
  }
  EXPECT_LT(watch.ms(), 5000);
}

}  // namespace
}  // namespace zoneplate
