// SPDX-License-Identifier: BSD-3-Clause
// A checksum at the end of every page of a finished file: no byte changes unnoticed.
#include "PageSeals.h"

#include <csom/core/Error.h>
#include <xxhash.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>

namespace csom::detail {

namespace {

using Page = std::array<char, kPageSize>;

/// The number of the page is the seed: pages that have changed places are found too.
std::uint64_t computeSeal(const Page& page, std::uint64_t number) {
  return XXH3_64bits_withSeed(page.data(), kPageSize - kSealSize, number);
}

std::uint64_t sealIn(const Page& page) {
  std::uint64_t seal = 0;
  std::memcpy(&seal, page.data() + kPageSize - kSealSize, sizeof seal);
  return seal;
}

}  // namespace

void sealPages(const std::string& path, const std::string& shown_name) {
  const auto fail = [&] {
    throw FileError(shown_name, std::string("cannot be written: ") + std::strerror(errno));
  };
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  if (!file) fail();
  Page page{};
  for (std::uint64_t number = 1; file.read(page.data(), kPageSize); ++number) {
    const std::uint64_t seal = computeSeal(page, number);
    file.seekp(static_cast<std::streamoff>(number * kPageSize - kSealSize));
    file.write(reinterpret_cast<const char*>(&seal), sizeof seal);
    // Between writing and reading a stream wants to be told its place.
    file.seekg(static_cast<std::streamoff>(number * kPageSize));
    if (!file) fail();
  }
  file.clear();
  file.close();
  if (!file) fail();
}

std::vector<std::string> checkSeals(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw FileError(file, std::string("cannot be read: ") + std::strerror(errno));
  std::vector<std::string> faults;
  Page page{};
  std::uint64_t number = 1;
  for (; stream.read(page.data(), kPageSize); ++number) {
    if (sealIn(page) != computeSeal(page, number))
      faults.push_back("page " + std::to_string(number) + " (from byte " +
                       std::to_string((number - 1) * kPageSize) + ") is not as it was written");
  }
  if (stream.gcount() != 0)
    faults.push_back("the file ends in the middle of page " + std::to_string(number));
  return faults;
}

}  // namespace csom::detail
