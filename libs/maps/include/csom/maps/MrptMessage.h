// SPDX-License-Identifier: BSD-3-Clause
// What an exception of MRPT says, in one line.
#pragma once

#include <exception>
#include <string>

namespace csom::detail {

/// MRPT's what() spans many lines with a call stack: the innermost message of it. Of any other
/// exception the first line.
std::string messageOf(const std::exception& error);

}  // namespace csom::detail
