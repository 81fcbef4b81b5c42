// SPDX-License-Identifier: BSD-3-Clause
// What an exception of MRPT says, in one line.
#pragma once

#include <string>

namespace csom {

/// MRPT's what() spans many lines; the reason is in the one that begins with "Message:". The first
/// line of any other.
std::string oneLine(const std::string& what);

}  // namespace csom
