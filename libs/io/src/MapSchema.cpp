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

std::string createTables() {
  std::string scans;
  for (const auto& [name, type] : kFixedScanColumns) scans += std::string(", ") + name + " " + type;
  const ScanReport report;
  visitReport(report, [&](const std::string& name, const auto& field) {
    constexpr bool is_time = std::is_same_v<decltype(field), const double&>;
    scans += ", " + name + (is_time ? " REAL" : " INTEGER");
  });
  return "PRAGMA application_id = " + std::to_string(kApplicationId) +
         "; PRAGMA user_version = " + std::to_string(kFormatVersion) +
         "; CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;"
         "CREATE TABLE options (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;"
         "CREATE TABLE labels (yaml TEXT NOT NULL);"
         "CREATE TABLE description (hash INTEGER NOT NULL, bytes BLOB NOT NULL);"
         "CREATE TABLE totals (chunks INTEGER NOT NULL, scans INTEGER NOT NULL,"
         " digest TEXT NOT NULL, checksum TEXT NOT NULL, hash INTEGER NOT NULL);"
         "CREATE TABLE resume (key TEXT PRIMARY KEY, value BLOB NOT NULL, hash INTEGER NOT NULL)"
         " WITHOUT ROWID;"
         "CREATE TABLE scans (id INTEGER PRIMARY KEY" +
         scans +
         ", hash INTEGER NOT NULL);"
         "CREATE TABLE chunks (x INTEGER NOT NULL, y INTEGER NOT NULL, z INTEGER NOT NULL,"
         " hash INTEGER NOT NULL, record BLOB NOT NULL, PRIMARY KEY (z, y, x));";
}

}  // namespace csom::detail
