// SPDX-License-Identifier: BSD-3-Clause
// The command line of this process, as one would type it again.
#pragma once

#include <string>

namespace csom {

/// Quoted for a shell; empty if the system does not tell.
std::string commandLine();

/// A word as one would type it in a shell.
std::string shellQuoted(const std::string& word);

}  // namespace csom
