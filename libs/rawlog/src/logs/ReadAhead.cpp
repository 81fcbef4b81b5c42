// SPDX-License-Identifier: BSD-3-Clause
// Makes things in a thread of its own, while others are worked on.
#include <csom/rawlog/ReadAhead.h>
#include <sys/resource.h>
#include <unistd.h>

namespace csom::detail {

void giveWay() {
  // A tenth of the time where two compete. Not the lowest priority: other programs that keep the
  // processors busy would starve this thread, and with it those who wait for it.
  constexpr int kNice = 10;
  // Linux has priorities by thread. Where that fails the thread only is in the way of others.
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNice);
}

}  // namespace csom::detail
