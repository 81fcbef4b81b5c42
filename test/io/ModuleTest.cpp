// SPDX-License-Identifier: BSD-3-Clause
// Modules that cannot be loaded; exports/VdbFileTest and rawlog/ScanRegistrationTest load those
// that can.
#include <csom/io/Module.h>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

TEST(Module, OneThatIsMissingIsNamed) {
  EXPECT_THAT([] { detail::addressInModule("csom-none.so", "csomNothing"); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(HasSubstr("csom-none.so, a part of this program, cannot be loaded: "),
                        HasSubstr("No such file"))));
}

TEST(Module, OneOfAnotherVersionIsNamed) {
  EXPECT_THAT([] { detail::addressInModule("libm.so.6", "csomNothing"); },
              ThrowsMessage<std::runtime_error>(
                  AllOf(HasSubstr("libm.so.6, a part of this program"), HasSubstr("csomNothing"))));
}

TEST(Module, FindsTheFunctionEachTime) {
  void* cosine = detail::addressInModule("libm.so.6", "cos");
  EXPECT_NE(cosine, nullptr);
  EXPECT_EQ(detail::addressInModule("libm.so.6", "cos"), cosine);
}

}  // namespace
}  // namespace csom::test
