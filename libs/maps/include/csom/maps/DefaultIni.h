// SPDX-License-Identifier: BSD-3-Clause
// All keys of an ini file with their defaults and what they mean.
#pragma once

#include <string>

namespace csom {

/// An ini file that says what is so anyway: every key with its default, under a comment that the
/// options themselves give. Keys whose default is to be left out are commented out.
std::string defaultIni();

}  // namespace csom
