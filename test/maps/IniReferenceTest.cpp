// SPDX-License-Identifier: BSD-3-Clause
// docs/ini-reference.md says of every key what the program says.
#include <csom/maps/DefaultIni.h>
#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace csom {
namespace {

using Rows = std::vector<std::string>;
using Tables = std::map<std::string, Rows>;  // by the end of a section's name, "insertOpts"

std::string escaped(const std::string& text) {
  return std::regex_replace(text, std::regex(R"(\|)"), R"(\|)");
}

/// The rows that the tables must have.
Tables expectedTables() {
  const std::regex section(R"(;?\[.*_00_([A-Za-z]+)(_00)?\])");
  const std::regex key(R"(;?([A-Za-z_0-9]+) = (.*))");
  std::istringstream ini(defaultIni());
  Tables tables;
  Rows* rows = nullptr;
  std::string comment;
  for (std::string line; std::getline(ini, line);) {
    std::smatch match;
    if (std::regex_match(line, match, section)) {
      rows = &tables[match[1]];
    } else if (std::regex_match(line, match, key)) {
      const std::string value = match[2].length() == 0 ? "none" : match[2].str();
      if (rows != nullptr)
        rows->push_back("| `" + match[1].str() + "` | " + value + " | " + escaped(comment) + " |");
    } else if (line.rfind("; ", 0) == 0) {
      comment = line.substr(2);
    }
  }
  return tables;
}

Tables writtenTables() {
  const std::regex heading(R"(## `…_([A-Za-z]+?)(_00)?`.*)");
  std::ifstream page(CSOM_SOURCE_DIR "/docs/ini-reference.md");
  Tables tables;
  Rows* rows = nullptr;
  for (std::string line; std::getline(page, line);) {
    std::smatch match;
    if (std::regex_match(line, match, heading)) rows = &tables[match[1]];
    if (line.rfind("| `", 0) == 0 && rows != nullptr) rows->push_back(line);
  }
  return tables;
}

TEST(IniReference, ItsTablesAreWhatTheProgramPrints) {
  const Tables expected = expectedTables();
  EXPECT_EQ(expected.size(), 6u) << "sections";
  EXPECT_GT(expected.at("insertOpts").size(), 30u);
  const Tables written = writtenTables();
  for (const auto& [section, rows] : expected) {
    ASSERT_EQ(written.count(section), 1u) << section;
    EXPECT_EQ(written.at(section), rows)
        << section << ": scripts/update-ini-reference writes the tables";
  }
}

TEST(IniReference, EveryKeyIsExplained) {
  for (const auto& [section, rows] : expectedTables())
    for (const std::string& row : rows) EXPECT_THAT(row, testing::Not(testing::HasSubstr("|  |")));
}

}  // namespace
}  // namespace csom
