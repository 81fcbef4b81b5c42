// SPDX-License-Identifier: BSD-3-Clause
// run.json read again: the same record, and plain words for what is none.
#include <csom/core/Error.h>
#include <csom/report/HtmlReport.h>
#include <csom/report/Report.h>
#include <csom/report/RunRecordReader.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "SampleMaps.h"

namespace csom {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// A record with something in every field, and the map of its scans.
struct SampleRun {
  SampleRun() {
    record.up = {0.0, -1.0, 0.25};
    record.labels = {5, 6, 7, 1, 20, 300, 4000};
    record.unused.points = 9;
    record.unused.rejected[0] = 8;
    record.unused.free_voxels = 7;
    record.camera_labels = test::sampleCameraLabels();
    record.deskew = DeskewStatistics{5, 6, 7};
    record.registration = RegistrationStatistics{100, 3, 12.5};
    record.pictures = {test::samplePicture(CameraPicture::Moment::First, "left"),
                       test::samplePicture(CameraPicture::Moment::Last, "left")};
    for (const RunScan& scan : record.scans) document.scans.push_back(scan.record);
  }
  std::string text() const { return toJson(record, figures()); }
  MapFigures figures() const {
    MapFigures figures = computeFigures(document);
    figures.memory_bytes = 123456;  // while it grew
    return figures;
  }

  RunRecord record = test::sampleRecord();
  MapDocument document = test::mapOf({{{0, 0, 0}, 1}, {{1, 0, 0}, 0}});
};

TEST(RunRecordReaderTest, ReadsWhatToJsonWrites) {
  const SampleRun run;
  const SavedRun saved = runFromJson(run.text(), "run.json", run.document);
  EXPECT_EQ(toJson(saved.record, saved.figures), run.text());
  const RunRecord& read = saved.record;
  EXPECT_EQ(read.unused.points, 9u);
  EXPECT_EQ(read.unused.rejected[0], 8u);
  EXPECT_EQ(read.unused.free_voxels, 7u);
  EXPECT_EQ(read.labels.unknown, 20u);
  EXPECT_EQ(read.parameters.front().help, run.record.parameters.front().help);
  EXPECT_EQ(read.scans.at(1).insert_ms, 30);
}

class RunFolder : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder); }

  const SampleRun run;
  const std::string folder = testing::TempDir() + "csom-run-" + std::to_string(getpid());
};

TEST_F(RunFolder, GivesTheSamePageAgain) {
  writeReport(run.record, run.document, run.figures(), folder);
  const SavedRun read = loadRun(folder, run.document);
  EXPECT_EQ(htmlReport(read.record, run.document, read.figures, {}),
            htmlReport(run.record, run.document, run.figures(), {}));
}

TEST_F(RunFolder, DoesWithoutPicturesThatAreGone) {
  writeReport(run.record, run.document, run.figures(), folder);
  std::filesystem::remove(folder + "/camera-last-points.jpg");
  const RunRecord read = loadRun(folder, run.document).record;
  ASSERT_EQ(read.pictures.size(), 1u);
  EXPECT_EQ(read.pictures.front().moment, CameraPicture::Moment::First);
}

std::string refusal(const std::string& text, const MapDocument& document) {
  try {
    runFromJson(text, "out/run.json", document);
  } catch (const FileError& error) {
    return error.what();
  }
  return "it was read";
}

TEST(RunRecordReaderTest, NamesWhatIsWrong) {
  const SampleRun run;
  const auto changed = [&](auto&& change) {
    json text = json::parse(run.text());
    change(text);
    return refusal(text.dump(), run.document);
  };
  EXPECT_THAT(refusal("{", run.document), HasSubstr("out/run.json: is no JSON"));
  EXPECT_THAT(refusal("[]", run.document), HasSubstr("is no JSON object"));
  EXPECT_THAT(changed([](json& j) { j.erase("command"); }), HasSubstr("command is missing"));
  EXPECT_THAT(changed([](json& j) { j["scans"][1]["insert_ms"] = "x"; }),
              HasSubstr("scans[1].insert_ms is no number"));
  EXPECT_THAT(changed([](json& j) { j["scans"].erase(0); }),
              HasSubstr("has 1 entries, but the map has 2 scans"));
  EXPECT_THAT(changed([](json& j) { j["unused"]["points"] = -3; }),
              HasSubstr("unused.points is no count"));
  EXPECT_THAT(changed([](json& j) { j["labels"].erase("unknown"); }),
              HasSubstr("labels.unknown is missing"));
  EXPECT_THAT(changed([](json& j) { j["camera_labels"]["points"]["hidden"] = "x"; }),
              HasSubstr("camera_labels.points.hidden is no count"));
  EXPECT_THAT(changed([](json& j) { j["up"] = {1, 2}; }), HasSubstr("up is no list of three"));
  EXPECT_THAT(changed([](json& j) { j["pictures"][0]["classes"] = {300}; }),
              HasSubstr("pictures[0].classes has an entry that is no class id"));
  EXPECT_THAT(changed([](json& j) { j["map"]["digest"] = "0123"; }),
              HasSubstr("belongs to the map with the digest 0123"));
}

}  // namespace
}  // namespace csom
