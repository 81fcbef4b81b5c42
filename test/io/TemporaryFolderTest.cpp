// SPDX-License-Identifier: BSD-3-Clause
#include <csom/io/TemporaryFolder.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>

#include "TestFiles.h"

namespace csom {
namespace {

TEST(TemporaryFolder, GoesWithAllThatIsInIt) {
  std::string file;
  {
    const TemporaryFolder folder;
    file = folder.file("a.txt");
    test::writeBytes(file, "x");
    const TemporaryFolder other;
    EXPECT_NE(folder.file(""), other.file(""));
  }
  EXPECT_FALSE(std::filesystem::exists(std::filesystem::path(file).parent_path()));
}

TEST(TemporaryFolder, WhereNoneCanBeMadeIsAnError) {
  const std::string before = getenv("TMPDIR") != nullptr ? getenv("TMPDIR") : "";
  setenv("TMPDIR", "/dev/null", 1);
  EXPECT_THROW(TemporaryFolder(), FileError);
  if (before.empty())
    unsetenv("TMPDIR");
  else
    setenv("TMPDIR", before.c_str(), 1);
}

}  // namespace
}  // namespace csom
