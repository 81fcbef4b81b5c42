// SPDX-License-Identifier: BSD-3-Clause
// Makes things in a thread of its own, while others are worked on.
#include <csom/rawlog/ReadAhead.h>
#include <sys/resource.h>
#include <unistd.h>

namespace csom::detail {

void giveWay() {
  constexpr int kLowest = 19;
  // Linux has priorities by thread. Where that fails the thread only is in the way of others.
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kLowest);
}

}  // namespace csom::detail
