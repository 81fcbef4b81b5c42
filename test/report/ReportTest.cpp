// SPDX-License-Identifier: BSD-3-Clause
// The files that a run leaves.
#include <csom/core/Error.h>
#include <csom/report/Report.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "SampleMaps.h"

namespace csom {
namespace {

namespace fs = std::filesystem;

class ReportTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string("csom-report-") +
               testing::UnitTest::GetInstance()->current_test_info()->name() + "-" +
               std::to_string(getpid()));
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_))
      names.insert(entry.path().filename().string());
    return names;
  }
  std::string read(const std::string& name) const {
    std::ifstream file(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  fs::path folder_;
  MapDocument document_ = test::mapOf({{{0, 0, 0}, 1}});
  MapFigures figures_ = computeFigures(document_);
};

TEST_F(ReportTest, WritesPagePicturesAndRecordAndNoOthers) {
  writeReport(test::sampleRecord(), document_, figures_, (folder_ / "a" / "b").string());
  folder_ = folder_ / "a" / "b";
  EXPECT_EQ(files(), (std::set<std::string>{"run.json", "top.png", "front.png", "side.png",
                                            "isometric.png", "report.html"}));
  const std::string json = read("run.json");
  EXPECT_EQ(json.front(), '{');
  EXPECT_EQ(json.back(), '\n');
  for (const char* view : {"top.png", "front.png", "side.png", "isometric.png"})
    EXPECT_EQ(read(view).substr(1, 3), "PNG");
  EXPECT_THAT(read("report.html"), testing::StartsWith("<!DOCTYPE html>"));
  folder_ = folder_.parent_path().parent_path();
}

TEST_F(ReportTest, WritesWhatWasAskedFor) {
  ReportOptions options;
  options.png = options.html = false;
  writeReport(test::sampleRecord(), document_, figures_, folder_.string(), options);
  EXPECT_EQ(files(), (std::set<std::string>{"run.json"}));
  options.json = false;
  options.html = true;
  writeReport(test::sampleRecord(), document_, figures_, folder_.string(), options);
  EXPECT_EQ(files(), (std::set<std::string>{"run.json", "report.html"}));
}

TEST_F(ReportTest, WritesThePicturesOfTheFirstCameraAsFiles) {
  using Moment = CameraPicture::Moment;
  RunRecord record = test::sampleRecord();
  for (const Moment moment : {Moment::First, Moment::Middle, Moment::Last}) {
    record.pictures.push_back(test::samplePicture(moment, "left"));
    record.pictures.push_back(test::samplePicture(moment, "right"));
    record.pictures.back().points = {'n', 'o'};
  }
  writeReport(record, document_, figures_, folder_.string());
  const std::vector<std::string> names = reportFiles();
  EXPECT_EQ(files(), std::set<std::string>(names.begin(), names.end()));
  EXPECT_EQ(read("camera-first-segmentation.jpg"), "seg");
  EXPECT_EQ(read("camera-middle-points.jpg"), "dots");
  EXPECT_EQ(read("camera-last-points.jpg"), "dots");
}

TEST_F(ReportTest, WritesNoPicturesUnlessAsked) {
  RunRecord record = test::sampleRecord();
  record.pictures = {test::samplePicture(CameraPicture::Moment::First, "left")};
  ReportOptions options;
  options.pictures = options.png = options.html = false;
  writeReport(record, document_, figures_, folder_.string(), options);
  EXPECT_EQ(files(), (std::set<std::string>{"run.json"}));
}

TEST_F(ReportTest, ReplacesAnEarlierReport) {
  fs::create_directories(folder_);
  std::ofstream(folder_ / "run.json") << "old";
  writeReport(test::sampleRecord(), document_, figures_, folder_.string());
  EXPECT_THAT(read("run.json"), testing::HasSubstr("\"program_version\": \"1.2.3\""));
}

TEST_F(ReportTest, NamesTheFolderThatItCannotCreate) {
  fs::create_directories(folder_);
  const fs::path blocked = folder_ / "file" / "out";
  std::ofstream(folder_ / "file") << "in the way";
  try {
    writeReport(test::sampleRecord(), document_, figures_, blocked.string());
    FAIL() << "it should throw";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(blocked.string()));
  }
}

TEST_F(ReportTest, NamesTheFileThatItCannotReplace) {
  fs::create_directories(folder_ / "report.html" / "occupied");
  try {
    writeReport(test::sampleRecord(), document_, figures_, folder_.string());
    FAIL() << "it should throw";
  } catch (const FileError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("report.html"));
  }
}

}  // namespace
}  // namespace csom
