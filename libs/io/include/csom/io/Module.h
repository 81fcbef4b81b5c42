// SPDX-License-Identifier: BSD-3-Clause
// Parts of the program that are loaded when they are first used.
#pragma once

#include <string>

namespace csom::detail {

/// The address of an `extern "C"` function in a module of this program, such as csom-vdb.so.
///
/// A module holds what is seldom used and needs libraries that take long to load; it has the
/// version and the compiler of the program. It is looked for beside this code and among the
/// libraries of its prefix, then like any library (RUNPATH, LD_LIBRARY_PATH, the system's folders),
/// and stays once it was loaded.
///
/// Throws std::runtime_error in the dynamic linker's words if there is no such module or function.
/// Thread-safe.
void* addressInModule(const std::string& module, const std::string& function);

/// The same as a pointer to a function of type `Function`, which is believed.
template <class Function>
Function* functionOfModule(const std::string& module, const std::string& function) {
  return reinterpret_cast<Function*>(addressInModule(module, function));
}

}  // namespace csom::detail
