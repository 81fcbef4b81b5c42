// SPDX-License-Identifier: BSD-3-Clause
// Logs of every format, whole, cut off, damaged and of other kinds.
#include <csom/rawlog/RawlogReader.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include "rawlog/LogFixtures.h"

namespace csom::test {
namespace {

std::vector<RawlogEntry> readAll(RawlogReader& reader) {
  std::vector<RawlogEntry> entries;
  while (auto entry = reader.next()) entries.push_back(std::move(*entry));
  return entries;
}

std::string errorOf(const std::string& file) {
  try {
    RawlogReader reader(file);
  } catch (const FileError& error) {
    return error.what();
  }
  return "no error";
}

TEST(RawlogReader, ReadsObservationsInOrder) {
  const TempFolder folder;
  RawlogReader reader(writeLog(folder / "a.rawlog", driveEntries(3)));
  const auto entries = readAll(reader);
  ASSERT_EQ(entries.size(), 6u);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    EXPECT_EQ(entries[i].index, i);
    ASSERT_EQ(entries[i].observations.size(), 1u);
    EXPECT_EQ(entries[i].observations[0]->sensorLabel, i % 2 == 0 ? "truth" : "lidar");
    EXPECT_FALSE(entries[i].key_frame_pose);
  }
  EXPECT_TRUE(reader.end().complete);
  EXPECT_EQ(reader.end().entries, 6u);
  EXPECT_FALSE(reader.isSimpleMap());
}

TEST(RawlogReader, ReadsActionsAndSensoryFrames) {
  const TempFolder folder;
  RawlogReader reader(writeLog(
      folder / "a.rawlog",
      {movement(1, 0, 0), frameOf({wallCloud(1), odometry(1, 0, 0, 0)}), movement(1, 0, 0)}));
  const auto entries = readAll(reader);
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_TRUE(entries[0].action);
  EXPECT_TRUE(entries[0].observations.empty());
  ASSERT_EQ(entries[1].observations.size(), 2u);
  EXPECT_EQ(entries[1].observations[1]->sensorLabel, "wheels");
  EXPECT_TRUE(entries[2].action);
}

TEST(RawlogReader, ReadsAWholeRawlogObject) {
  const TempFolder folder;
  auto log = mrpt::obs::CRawlog::Create();
  log->insert(wallCloud(1));
  log->insert(wallCloud(2));
  RawlogReader reader(writeLog(folder / "a.rawlog", {log}));
  EXPECT_EQ(readAll(reader).size(), 2u);
  EXPECT_TRUE(reader.end().complete);
}

TEST(RawlogReader, PassesOverCommentsAndForeignObjects) {
  const TempFolder folder;
  auto comment = mrpt::obs::CObservationComment::Create();
  comment->text = "a drive";
  RawlogReader reader(writeLog(folder / "a.rawlog",
                               {comment, wallCloud(1), mrpt::maps::CSimplePointsMap::Create()}));
  const auto entries = readAll(reader);
  ASSERT_EQ(entries.size(), 3u);
  EXPECT_TRUE(entries[0].observations.empty());
  EXPECT_EQ(entries[1].observations.size(), 1u);
  EXPECT_TRUE(entries[2].observations.empty());
}

TEST(RawlogReader, ReadsSimplemapsWithTheirPoses) {
  const TempFolder folder;
  mrpt::maps::CSimpleMap map;
  const mrpt::poses::CPose3D pose(1, 2, 3, 0.4, 0.5, 0.6);
  map.insert(mrpt::poses::CPose3DPDFGaussian(pose), *frameOf({wallCloud(1), wallCloud(2)}));
  map.insert(mrpt::poses::CPose3DPDFGaussian(), *frameOf({wallCloud(3)}));
  ASSERT_TRUE(map.saveToFile(folder / "a.simplemap.gz"));
  RawlogReader reader(folder / "a.simplemap.gz");
  EXPECT_TRUE(reader.isSimpleMap());
  const auto entries = readAll(reader);
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[0].observations.size(), 2u);
  ASSERT_TRUE(entries[0].key_frame_pose);
  EXPECT_EQ(*entries[0].key_frame_pose, pose);
  EXPECT_TRUE(reader.end().complete);
}

TEST(RawlogReader, ReadsWhatMrptShips) {
  const std::string folder = "/usr/share/mrpt/datasets/";
  RawlogReader demo(folder + "localization_demo.rawlog");
  EXPECT_EQ(readAll(demo).size(), 37u * 2);
  EXPECT_TRUE(demo.end().complete);
  RawlogReader map(folder + "localization_demo.simplemap.gz");
  EXPECT_TRUE(map.isSimpleMap());
  EXPECT_GT(readAll(map).size(), 10u);
  EXPECT_TRUE(map.end().complete) << map.end().reason;
}

TEST(RawlogReader, FindsTheFolderOfImages) {
  const TempFolder folder;
  for (const char* name : {"a.b.rawlog", "a.b.rawlog.gz"}) {
    writeLog(folder / name, driveEntries(1));
    EXPECT_EQ(RawlogReader(folder / name).imageFolder(), folder / "Images");
  }
  std::filesystem::create_directory(folder / "a.b_Images");
  for (const char* name : {"a.b.rawlog", "a.b.rawlog.gz"})
    EXPECT_EQ(RawlogReader(folder / name).imageFolder(), folder / "a.b_Images");
}

TEST(RawlogReader, YieldsAllThatACutOffLogHolds) {
  const TempFolder folder;
  const std::string bytes = readBytes(writePlainLog(folder / "whole.rawlog", driveEntries(3)));
  std::vector<std::uint64_t> ends;  // of the entries
  {
    RawlogReader reader(folder / "whole.rawlog");
    while (reader.next()) ends.push_back(reader.end().bytes);
  }
  ASSERT_EQ(ends.back(), bytes.size());
  const std::string file = folder / "cut.rawlog";
  for (std::size_t size = ends[0]; size < bytes.size(); size += 13) {
    writeBytes(file, bytes.substr(0, size));
    RawlogReader reader(file);
    const auto whole = static_cast<std::size_t>(
        std::count_if(ends.begin(), ends.end(), [&](auto end) { return end <= size; }));
    ASSERT_EQ(readAll(reader).size(), whole) << size;
    const bool at_an_end = std::count(ends.begin(), ends.end(), size) > 0;
    ASSERT_EQ(reader.end().complete, at_an_end) << size;
    ASSERT_EQ(reader.end().bytes, ends[whole - 1]);
    if (at_an_end) continue;
    ASSERT_THAT(reader.end().reason,
                testing::StartsWith("cut off in the middle of entry " + std::to_string(whole)));
  }
}

TEST(RawlogReader, YieldsAllThatACutOffSimplemapHolds) {
  const TempFolder folder;
  mrpt::maps::CSimpleMap map;
  for (int i = 0; i < 4; ++i)
    map.insert(mrpt::poses::CPose3DPDFGaussian(), *frameOf({wallCloud(i)}));
  auto whole = std::make_shared<mrpt::maps::CSimpleMap>(map);
  const std::string bytes = readBytes(writePlainLog(folder / "whole.simplemap", {whole}));
  writeBytes(folder / "cut.simplemap", bytes.substr(0, bytes.size() * 5 / 8));
  RawlogReader reader(folder / "cut.simplemap");
  EXPECT_EQ(readAll(reader).size(), 2u);
  EXPECT_FALSE(reader.end().complete);
}

TEST(RawlogReader, YieldsWhatAGzipFileHoldsBeforeItsCut) {
  const TempFolder folder;
  const std::string bytes = readBytes(writeLog(folder / "a.rawlog", driveEntries(200)));
  writeBytes(folder / "cut.rawlog.gz", bytes.substr(0, bytes.size() / 2));
  RawlogReader reader(folder / "cut.rawlog.gz");
  const std::size_t entries = readAll(reader).size();
  EXPECT_GT(entries, 20u);
  EXPECT_LT(entries, 390u);
  EXPECT_FALSE(reader.end().complete);
}

// Every length field of the first cloud claims gigabytes: the log ends there, or the process does
// with one line.
TEST(RawlogReaderDeathTest, SurvivesHostileLengths) {
  const TempFolder folder;
  const std::string bytes =
      readBytes(writePlainLog(folder / "a.rawlog", {wallCloud(1), wallCloud(2)}));
  const std::string file = folder / "hostile.rawlog";
  for (std::size_t at = 36; at < 200; at += 3) {
    std::string hostile = bytes;
    hostile.replace(at, 4, "\xff\xff\xff\x7f");
    writeBytes(file, hostile);
    const auto readToTheEnd = [&] {
      RawlogReader reader(file);
      const bool complete_or_said = readAll(reader).size() == 2 || !reader.end().reason.empty();
      std::fputs(complete_or_said ? "said" : "silent", stderr);
      std::_Exit(complete_or_said ? 1 : 7);
    };
    EXPECT_EXIT(readToTheEnd(), testing::ExitedWithCode(1),
                "said|hostile.rawlog: entry [01] is damaged so badly")
        << "byte " << at;
  }
}

TEST(RawlogReader, RefusesWhatIsNoLog) {
  const TempFolder folder;
  writeBytes(folder / "empty", "");
  writeBytes(folder / "text", "this is no rawlog at all");
  writeBytes(folder / "zeros", std::string(100, '\0'));
  writeBytes(folder / "unknown", std::string("\x8b") + "CFooBarBaz1" + std::string(20, '\1'));
  writeLog(folder / "map", {mrpt::maps::CSimplePointsMap::Create()});

  using testing::HasSubstr;
  EXPECT_THAT(errorOf(folder / "missing"), HasSubstr("missing: no such file"));
  EXPECT_THAT(errorOf(folder.path()), HasSubstr("is a folder"));
  EXPECT_THAT(errorOf(folder / "empty"), HasSubstr("is empty"));
  for (const char* name : {"text", "zeros", "unknown"})
    EXPECT_THAT(errorOf(folder / name), HasSubstr("is neither a rawlog nor a simplemap")) << name;
  EXPECT_THAT(errorOf(folder / "map"), HasSubstr("CSimplePointsMap"));
  for (const char* name : {"missing", "empty", "text", "zeros", "unknown", "map"})
    EXPECT_THAT(errorOf(folder / name), testing::Not(HasSubstr("\n"))) << name;
}

// A short log fails when it is closed, a long one while it is written.
TEST(RawlogWriter, ReportsAFullDisk) {
  for (const int entries : {1, 400}) {
    EXPECT_THAT(fileErrorOf([&] { writeLog("/dev/full", driveEntries(entries)); }),
                testing::AllOf(testing::HasSubstr("/dev/full: cannot be written"),
                               testing::HasSubstr("No space left")));
  }
}

TEST(RawlogWriter, WritesTheBytesOfMrpt) {
  const TempFolder folder;
  const Entries entries = driveEntries(20);
  {
    mrpt::io::CFileGZOutputStream stream(folder / "mrpt.rawlog");
    auto archive = mrpt::serialization::archiveFrom(stream);
    for (const auto& entry : entries) archive << *entry;
  }
  EXPECT_EQ(readBytes(writeLog(folder / "ours.rawlog", entries)),
            readBytes(folder / "mrpt.rawlog"));
}

TEST(RawlogReader, AnEntryThatClaimsTooMuchIsDamagedWhereverItStands) {
  const TempFolder folder;
  const std::string whole =
      readBytes(writePlainLog(folder / "whole.rawlog", {odometry(1, 0, 0, 0)}));
  std::string huge = whole;
  const std::size_t at = huge.find(bytesOf(std::uint32_t{6}) + "wheels");
  ASSERT_NE(at, std::string::npos);
  huge.replace(at, 4, bytesOf(std::uint32_t{0x7fffffff}));
  for (const std::string& before : {std::string(), whole}) {
    writeBytes(folder / "huge.rawlog", before + huge);
    RawlogReader reader(folder / "huge.rawlog");
    readAll(reader);
    EXPECT_FALSE(reader.end().complete);
    EXPECT_THAT(reader.end().reason,
                testing::HasSubstr("is damaged: it claims to be larger than the file can hold"));
  }
}

TEST(RawlogReader, NamesOfClassesAreMadePrintable) {
  const TempFolder folder;
  const std::string bytes = readBytes(writePlainLog(folder / "whole.rawlog", {wallCloud(1)}));
  const std::string name = "evil\x1b[2J";
  writeBytes(folder / "evil.rawlog",
             bytes + static_cast<char>(0x80 + name.size()) + name + std::string(9, '\0'));
  RawlogReader reader(folder / "evil.rawlog");
  readAll(reader);
  EXPECT_THAT(reader.end().reason, testing::HasSubstr("entry 1 (evil?[2J) is damaged"));
}

}  // namespace
}  // namespace csom::test
