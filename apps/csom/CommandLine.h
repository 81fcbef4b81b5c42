// SPDX-License-Identifier: BSD-3-Clause
// The command line of this process, as one would type it again.
#pragma once

#include <string>
#include <vector>

namespace csom {

/// Quoted for a shell; empty if the system does not tell.
std::string commandLine();

/// A word as one would type it in a shell.
std::string shellQuoted(const std::string& word);

/// A text of a library with the options that it names as they are given here: "… (--box, --frame)".
std::string withFlags(const std::string& text, const std::vector<std::string>& options);

}  // namespace csom
