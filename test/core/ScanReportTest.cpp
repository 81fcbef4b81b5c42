// SPDX-License-Identifier: BSD-3-Clause
// Reports of scans: every field is visited, and added.
#include <csom/core/ScanReport.h>
#include <gtest/gtest.h>

#include <set>
#include <string>

namespace csom {
namespace {

TEST(ScanReport, EveryFieldIsVisitedOnce) {
  static_assert(sizeof(std::size_t) == sizeof(double));
  ScanReport report;
  std::set<std::string> names;
  std::set<const void*> fields;
  visitReport(report, [&](const std::string& name, auto& field) {
    names.insert(name);
    fields.insert(&field);
  });
  EXPECT_EQ(fields.size(), sizeof(ScanReport) / sizeof(double)) << "a field without a visit";
  EXPECT_EQ(names.size(), fields.size());
  EXPECT_EQ(names.count("rejected_class_out_of_range"), 1U);
}

TEST(ScanReport, SumsEveryField) {
  ScanReport report;
  double next = 1;
  visitReport(report, [&](const std::string&, auto& field) {
    field = static_cast<std::decay_t<decltype(field)>>(next);
    next *= 2;
  });
  ScanReport sum = report;
  sum += report;
  const auto is_twice = [](const std::string& name, const auto& twice, const auto& once) {
    EXPECT_EQ(twice, 2 * once) << name;
  };
  visitReports(is_twice, sum, report);
}

}  // namespace
}  // namespace csom
