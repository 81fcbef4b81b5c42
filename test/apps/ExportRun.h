// SPDX-License-Identifier: BSD-3-Clause
// csom export of one map into every format, each read back.
#pragma once

#include <csom/exports/NavigationGrid.h>
#include <csom/io/MapFile.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "apps/RunCsom.h"
#include "exports/GlbReader.h"
#include "exports/ReadBack.h"

namespace csom::test {

/// Requires success, and a last line that names the file.
inline void exportTo(const std::string& folder, const std::string& map, const std::string& format,
                     const std::string& file, const std::vector<std::string>& further = {}) {
  std::vector<std::string> arguments{"export", map, "--to", format, "-o", file};
  arguments.insert(arguments.end(), further.begin(), further.end());
  const ProgramResult run = runCsom(folder, arguments);
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(run.output, "");
  // A slow machine may see lines of progress before it.
  const std::vector<std::string> lines = run.errorLines();
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(lines.back().rfind(file + ": ", 0), 0U) << run.errors;
  for (std::size_t i = 0; i + 1 < lines.size(); ++i)
    EXPECT_EQ(lines[i].rfind("exporting", 0), 0U) << run.errors;
}

/// Every format that holds voxels: the same ones, of the same classes, in the same places.
inline void expectAllFormatsReadBack(const std::string& folder, const std::string& map_file) {
  const MapDocument document = loadMap(map_file);
  const double resolution = document.map.grid().resolution();
  for (const VoxelFormat& format : voxelFormats()) {
    SCOPED_TRACE(format.name + " " + format.extension);
    const std::string file = folder + "/map." + format.extension;
    exportTo(folder, map_file, format.name, file);
    const VoxelClasses expected = voxelsOf(document.map, format);
    const VoxelClasses read = format.read(file, resolution, document.labels);
    EXPECT_EQ(read.size(), expected.size());
    EXPECT_TRUE(read == expected);
  }
  exportTo(folder, map_file, "glb", folder + "/map.glb");
  EXPECT_TRUE(readGlb(folder + "/map.glb", resolution, document.labels).faces ==
              makeFaces(document.map, document.labels));
}

}  // namespace csom::test
