// SPDX-License-Identifier: BSD-3-Clause
// A thread that makes things ahead of who takes them.
#include <csom/rawlog/ReadAhead.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace csom::test {
namespace {

TEST(ReadAhead, HandsOutAllInOrder) {
  int made = 0;
  ReadAhead<std::unique_ptr<int>> ahead(2, [&]() -> std::optional<std::unique_ptr<int>> {
    if (made == 100) return std::nullopt;
    return std::make_unique<int>(made++);
  });
  for (int i = 0; i < 100; ++i) {
    const auto item = ahead.next();
    ASSERT_TRUE(item);
    EXPECT_EQ(**item, i);
  }
  EXPECT_FALSE(ahead.next());
  EXPECT_FALSE(ahead.next()) << "asked again";
}

TEST(ReadAhead, AnErrorComesBehindWhatWasMadeBefore) {
  int made = 0;
  ReadAhead<int> ahead(8, [&]() -> std::optional<int> {
    if (made == 2) throw std::runtime_error("the disk is gone");
    return made++;
  });
  EXPECT_EQ(ahead.next(), 0);
  EXPECT_EQ(ahead.next(), 1);
  try {
    ahead.next();
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "the disk is gone");
  }
}

TEST(ReadAhead, StopsWhenNobodyTakesAnyMore) {
  std::atomic<int> made{0};
  {
    ReadAhead<int> ahead(3, [&]() -> std::optional<int> { return made++; });
    EXPECT_EQ(ahead.next(), 0);
  }
  const int at_the_end = made;
  EXPECT_LE(at_the_end, 1 + 3 + 1) << "taken, kept, and one that found no room";
}

}  // namespace
}  // namespace csom::test
