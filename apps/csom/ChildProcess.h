// SPDX-License-Identifier: BSD-3-Clause
// Another program, run to its end as if it had been started instead of this one.
#pragma once

#include <string>
#include <vector>

namespace csom {

struct ProgramEnd {
  int exit_code = 0;  ///< as a shell tells it: 128 + signal if a signal ended it
  int signal = 0;     ///< 0 = none
};

/// Runs `command`, whose first word is looked for in PATH, with `variable`=`value` in its
/// environment besides those of this program. Signals that this program receives meanwhile go to
/// it: SIGINT, SIGQUIT, SIGTERM and SIGHUP. Throws ConfigError if it cannot be started. To be
/// called by one thread, while there are no others.
ProgramEnd runToItsEnd(const std::vector<std::string>& command, const std::string& variable,
                       const std::string& value);

}  // namespace csom
