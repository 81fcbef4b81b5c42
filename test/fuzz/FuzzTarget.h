// SPDX-License-Identifier: BSD-3-Clause
// What the fuzz targets share: bytes become a file, and errors that a reader may report are none.
#pragma once

#include <csom/core/Error.h>
#include <csom/core/Options.h>
#include <csom/io/TemporaryFolder.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>

namespace csom::fuzz {

/// Gives the bytes as a file to a reader. Whatever it throws but the errors by which a reader
/// refuses a file ends the program: std::bad_alloc and std::out_of_range are findings.
template <class Read>
void readAsFile(const std::uint8_t* data, std::size_t size, const char* name, Read&& read) {
  static const TemporaryFolder folder;
  const std::string file = folder.file(name);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    read(file);
  } catch (const FileError&) {
  } catch (const ConfigError&) {
  } catch (const OptionError&) {
  }
}

}  // namespace csom::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
