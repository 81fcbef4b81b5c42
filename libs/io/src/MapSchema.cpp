// SPDX-License-Identifier: BSD-3-Clause
#include "MapSchema.h"

#include <csom/core/ScanReport.h>

#include <type_traits>

namespace csom::detail {

namespace {

constexpr const char* kFixedScanColumns[][2] = {
    {"timestamp", "REAL"}, {"sensor_label", "TEXT"}, {"observation_class", "TEXT"},
    {"origin_x", "REAL"},  {"origin_y", "REAL"},     {"origin_z", "REAL"}};

}  // namespace

std::string scanColumns() {
  std::string columns;
  for (const auto& [name, type] : kFixedScanColumns) columns += std::string(name) + ", ";
  const ScanReport report;
  visitReport(report, [&](const std::string& name, const auto&) { columns += name + ", "; });
  columns.resize(columns.size() - 2);
  return columns;
}

std::map<std::string, std::string> makeTables(std::int64_t version) {
  constexpr char kTexts[] = " (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID";
  std::map<std::string, std::string> tables{
      {"meta", std::string("CREATE TABLE meta") + kTexts},
      {"options", std::string("CREATE TABLE options") + kTexts},
      {"labels", "CREATE TABLE labels (yaml TEXT NOT NULL)"},
      {"chunks",
       "CREATE TABLE chunks (x INTEGER NOT NULL, y INTEGER NOT NULL, z INTEGER NOT NULL,"
       " hash INTEGER NOT NULL, record BLOB NOT NULL, PRIMARY KEY (z, y, x))"}};
  std::string& scans = tables["scans"];
  scans = "CREATE TABLE scans (id INTEGER PRIMARY KEY";
  for (const auto& [name, type] : kFixedScanColumns) scans += std::string(", ") + name + " " + type;
  const ScanReport report;
  visitReport(report, [&](const std::string& name, const auto& field) {
    constexpr bool is_time = std::is_same_v<decltype(field), const double&>;
    scans += ", " + name + (is_time ? " REAL" : " INTEGER");
  });
  scans += version >= 2 ? ", hash INTEGER NOT NULL)" : ")";
  if (version < 2) return tables;
  tables["description"] = "CREATE TABLE description (hash INTEGER NOT NULL, bytes BLOB NOT NULL)";
  tables["totals"] =
      "CREATE TABLE totals (chunks INTEGER NOT NULL, scans INTEGER NOT NULL,"
      " digest TEXT NOT NULL, checksum TEXT NOT NULL, hash INTEGER NOT NULL)";
  tables["resume"] =
      "CREATE TABLE resume (key TEXT PRIMARY KEY, value BLOB NOT NULL, hash INTEGER NOT NULL)"
      " WITHOUT ROWID";
  return tables;
}

std::string createTables() {
  std::string statements = "PRAGMA application_id = " + std::to_string(kApplicationId) +
                           "; PRAGMA user_version = " + std::to_string(kFormatVersion) + "; ";
  for (const auto& [name, statement] : makeTables(kFormatVersion)) statements += statement + "; ";
  return statements;
}

}  // namespace csom::detail
