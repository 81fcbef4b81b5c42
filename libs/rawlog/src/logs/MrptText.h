// SPDX-License-Identifier: BSD-3-Clause
// MRPT's words as one line of ours.
#pragma once

#include <mrpt/core/Clock.h>

#include <exception>
#include <optional>
#include <string>

namespace csom::detail {

/// messageOf(error), short and fit for a terminal: it may quote a damaged file.
std::string oneLine(const std::exception& error);

/// A class name without its namespaces.
std::string shortName(const std::string& class_name);

/// Seconds since 1970; nothing for MRPT's invalid time stamp.
std::optional<double> secondsOf(const mrpt::Clock::time_point& timestamp);

}  // namespace csom::detail
