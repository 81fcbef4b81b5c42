// SPDX-License-Identifier: BSD-3-Clause
// Where the plug-in of this program lies.
#include <csom/maps/PluginFile.h>
#include <dlfcn.h>

#include <filesystem>
#include <stdexcept>

namespace csom {

std::string pluginFile() {
  Dl_info info{};
  // Any address inside of this library will do.
  if (dladdr(reinterpret_cast<const void*>(&pluginFile), &info) == 0 || info.dli_fname == nullptr)
    throw std::runtime_error("libcsom-maps.so: the dynamic linker does not say where it lies");
  return std::filesystem::canonical(info.dli_fname).string();
}

}  // namespace csom
