// SPDX-License-Identifier: BSD-3-Clause
// Parts of the program that are loaded when they are first used.
#include <csom/io/Module.h>
#include <dlfcn.h>

#include <stdexcept>

#include "CodeFolder.h"

namespace csom::detail {
namespace {

namespace fs = std::filesystem;

/// The module in the prefix that this code is part of, if it is there; otherwise its bare name.
std::string fileOf(const std::string& module) {
  const fs::path folder = folderOfThisCode();
  for (const fs::path& place : {folder, folder / ".." / CSOM_LIBRARY_FOLDER}) {
    std::error_code error;
    if (fs::exists(place / module, error)) return (place / module).string();
  }
  return module;
}

[[noreturn]] void fail(const std::string& module) {
  const char* reason = ::dlerror();
  throw std::runtime_error(module + ", a part of this program, cannot be loaded: " +
                           (reason != nullptr ? reason : "the dynamic linker gives no reason"));
}

}  // namespace

void* addressInModule(const std::string& module, const std::string& function) {
  void* handle = ::dlopen(fileOf(module).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) fail(module);
  void* address = ::dlsym(handle, function.c_str());
  if (address == nullptr) fail(module);
  return address;  // never closed: libraries with threads or registries cannot be unloaded
}

}  // namespace csom::detail
