// SPDX-License-Identifier: BSD-3-Clause
// Files and processes: nothing is lost, counted twice, run or written elsewhere in silence. Each
// test is a kind of fault that once was.
#include <csom/io/MapRepair.h>
#include <csom/io/MapStore.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "apps/RunningProgram.h"
#include "rawlog/LogFixtures.h"

namespace csom::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;

class RightOrRefusedFiles : public testing::Test {
 protected:
  ProgramResult csom(const std::vector<std::string>& arguments) const {
    return runCsom(folder.path(), arguments);
  }
  /// A command line in the folder.
  ProgramResult shell(const std::string& line) const {
    return runProgram(folder.path(), "sh",
                      {"-c", "cd " + shellQuoted(folder.path()) + " && " + line});
  }
  std::string csomWord() const { return shellQuoted(CSOM_PROGRAM); }
  void sql(const std::string& file, const std::string& statements) const {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
    char* error = nullptr;
    EXPECT_EQ(sqlite3_exec(database, statements.c_str(), nullptr, nullptr, &error), SQLITE_OK)
        << statements << ": " << (error != nullptr ? error : "");
    sqlite3_free(error);
    sqlite3_close(database);
  }

  const TempFolder folder;
  const std::string map = folder / "map.csom";
};

// --- B1: repair and the write-ahead log
// -------------------------------------------------------------

class WriteAheadLog : public RightOrRefusedFiles {
 protected:
  /// A map whose chunks are in the log alone, as a machine leaves it that loses its power.
  WriteAheadLog() {
    const MapDocument document = sampleDocument();
    const auto store = MapStore::create(folder / "live.csom", document, {});
    store->commit(document.map.chunks().sorted(), MapStore::Voxels::Replace, document.scans, {});
    for (const char* ending : {"", "-wal"})
      fs::copy_file(folder / ("live.csom" + std::string(ending)), map + ending);
  }
};

TEST_F(WriteAheadLog, B1_RepairReadsWhatWasCommittedLast) {
  const auto run = csom({"repair", map, folder / "saved.csom"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("no voxel is lost"));
  EXPECT_EQ(mapDigest(loadMap(folder / "saved.csom").map), mapDigest(sampleMap()));
}

TEST_F(WriteAheadLog, B1_RepairStopsWhereTheLogCannotBeRead) {
  fs::remove(map + "-wal");
  fs::create_directory(map + "-wal");
  const auto run = csom({"repair", map, folder / "saved.csom"});
  EXPECT_EQ(run.exit_code, 1) << run.output;
  EXPECT_THAT(run.errors, AllOf(HasSubstr("map.csom-wal: cannot be copied"),
                                HasSubstr("what was committed last")));
  EXPECT_FALSE(fs::exists(folder / "saved.csom"));
}

TEST_F(WriteAheadLog, B1_RepairStopsWhereThereIsNoRoomForACopy) {
  RunningProgram running(folder.path(), {"repair", map, folder / "saved.csom"}, {4096});
  const auto run = running.wait();
  EXPECT_EQ(run.exit_code, 1) << run.output;
  EXPECT_THAT(run.errors, AllOf(HasSubstr("cannot be copied to"), HasSubstr("TMPDIR")));
  EXPECT_THAT(run.output, Not(HasSubstr("no voxel is lost")));
}

TEST_F(WriteAheadLog, B1_ALogThatIsDamagedIsALossThatIsTold) {
  const std::string log = readBytes(map + "-wal");
  std::mt19937 random(3);
  for (int i = 0; i < 40; ++i) {
    std::string damaged = log;
    // SQLite would pass over all that lies behind.
    damaged[i == 0 ? 0 : random() % damaged.size()] ^= 1;
    writeBytes(map + "-wal", damaged);
    fs::remove(map + "-shm");
    fs::remove(folder / "saved.csom");
    const auto run = csom({"repair", map, folder / "saved.csom"});
    if (run.exit_code != 0) continue;
    if (mapDigest(loadMap(folder / "saved.csom").map) == mapDigest(sampleMap())) continue;
    EXPECT_THAT(run.output,
                AllOf(HasSubstr("may be lost, as the log"), Not(HasSubstr("no voxel is lost"))));
  }
}

// --- B2: a path is a path
// ----------------------------------------------------------------------------

TEST_F(RightOrRefusedFiles, B2_PathsThatLookLikeUrisAreFiles) {
  saveMap(sampleDocument(), folder / "a.csom");
  MapDocument other = sampleDocument();
  other.map.merge(sampleMap());
  saveMap(other, folder / "b.csom");
  const std::string csom = csomWord();
  for (const char* name : {"file:m.csom", "file:m.csom?mode=memory", ":memory:"}) {
    SCOPED_TRACE(name);
    const auto merge = shell(csom + " merge a.csom b.csom -o " + shellQuoted(name));
    ASSERT_EQ(merge.exit_code, 0) << merge.errors;
    EXPECT_THAT(folder.fileNames(), UnorderedElementsAre("a.csom", "b.csom", name));
    const auto info = shell(csom + " info " + shellQuoted(name));
    EXPECT_EQ(info.exit_code, 0) << info.errors;
    EXPECT_EQ(shell(csom + " info --verify " + shellQuoted(name)).exit_code, 0);
    EXPECT_EQ(shell(csom + " repair " + shellQuoted(name) + " file:r.csom").exit_code, 0);
    EXPECT_TRUE(fs::exists(folder / "file:r.csom"));
    fs::remove(folder / "file:r.csom");
    fs::remove(folder / name);
  }
  EXPECT_EQ(shell(csom + " info file:a.csom").exit_code, 1) << "there is no such file";
  EXPECT_THAT(folder.fileNames(), UnorderedElementsAre("a.csom", "b.csom"));
}

TEST_F(RightOrRefusedFiles, B2_ARunMayWriteToAFolderThatLooksLikeAUri) {
  writeConfig(folder);
  writeLog(folder / "a.rawlog", driveEntries(2));
  const auto run = shell(csomWord() + " map a.rawlog -c map.ini -o file:out");
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(loadMap(folder / "file:out/map.csom").scans.size(), 2u);
  EXPECT_THAT(folder.fileNames(),
              UnorderedElementsAre("a.rawlog", "file:out", "labels.yaml", "map.ini"));
}

// --- B3: exports of nothing
// ------------------------------------------------------------------------------

TEST_F(RightOrRefusedFiles, B3_ASelectionThatTheExportsGridMissesIsRefusedInEveryFormat) {
  saveMap(sampleDocument(), map);
  const SemanticMap sample = sampleMap();
  std::optional<VoxelIndex> occupied;
  sample.forEachVoxel([&](const VoxelIndex& index, const DirichletVoxel& voxel) {
    if (voxel.state() == VoxelState::Occupied) occupied = index;
  });
  ASSERT_TRUE(occupied);
  const Eigen::Vector3d center = sample.grid().center(*occupied);
  std::string box, frame;
  for (const double side : {-0.01, 0.01})
    for (int axis = 0; axis < 3; ++axis)
      box += (box.empty() ? "" : ",") + std::to_string(center[axis] + side);
  // Turned by 45 degrees, with its centre on a corner of the other grid: between four centres.
  const double half = std::sqrt(0.5);
  frame = std::to_string(-half * (center.x() - center.y())) + "," +
          std::to_string(-half * (center.x() + center.y())) + ",0,45,0,0";
  for (const auto& [format, file] :
       std::vector<std::pair<std::string, std::string>>{{"octomap", "x.ot"},
                                                        {"octomap", "x.bt"},
                                                        {"vdb", "x.vdb"},
                                                        {"glb", "x.glb"},
                                                        {"nav2", "x.yaml"},
                                                        {"gridmap", "x.gridmap"}}) {
    SCOPED_TRACE(file);
    std::vector<std::string> command{"export",      map,     "--to", format,    "-o",
                                     folder / file, "--box", box,    "--frame", frame};
    if (format == "nav2" || format == "gridmap")
      command.insert(command.end(), {"--traversable", "road"});
    const auto run = csom(command);
    EXPECT_EQ(run.exit_code, 2) << run.errors;
    EXPECT_THAT(run.errors, HasSubstr("so small that"));
    EXPECT_THAT(folder.fileNames(), ElementsAre("map.csom"));
  }
}

// --- B4: boxes
// ---------------------------------------------------------------------------------------------

TEST_F(RightOrRefusedFiles, B4_CentresThatAnExportPrintsLieInABoxMadeOfThem) {
  MapDocument document = sampleDocument();
  Options options = document.map.options();
  options.resolution = 0.1;
  options.method = Method::SCsm;
  options.free_space.mode = FreeSpace::None;
  document.map = SemanticMap(options);
  Scan scan;
  scan.origin = {0.05, 0.05, 0.05};
  for (int i = 0; i < 40; ++i) {
    scan.points.emplace_back(0.1F * static_cast<float>(i), 0.1F * static_cast<float>(3 * i), 1.0F);
    scan.labels.push_back(1);
  }
  document.map.insert(scan);
  saveMap(document, map);
  ASSERT_EQ(csom({"export", map, "--to", "csv", "-o", folder / "all.csv"}).exit_code, 0);
  std::istringstream lines(readBytes(folder / "all.csv"));
  std::string line;
  std::getline(lines, line);
  int voxels = 0;
  for (; std::getline(lines, line); ++voxels) {
    std::size_t end = 0;
    for (int commas = 0; commas < 3; ++commas) end = line.find(',', end) + 1;
    const std::string center = line.substr(0, end - 1);
    const auto query = csom({"query", map, "--box", center + "," + center, "--json"});
    ASSERT_EQ(query.exit_code, 0) << query.errors;
    EXPECT_EQ(nlohmann::json::parse(query.output).at("known_voxels"), 1) << center;
    const auto part = csom(
        {"export", map, "--to", "csv", "-o", folder / "one.csv", "--box", center + "," + center});
    EXPECT_EQ(part.exit_code, 0) << center << ": " << part.errors;
  }
  EXPECT_EQ(voxels, 40);
}

// --- B5: schemas
// ------------------------------------------------------------------------------------------------

TEST_F(RightOrRefusedFiles, B5_AMapWithAnotherSchemaIsRefusedAndNothingInItRuns) {
  struct Case {
    const char* name;
    std::string statements;
    const char* reason;
  };
  const std::string copy_chunks =
      "ALTER TABLE chunks RENAME TO old; "
      "CREATE TABLE chunks (x INTEGER NOT NULL, y INTEGER NOT NULL, z INTEGER NOT NULL, "
      "hash INTEGER NOT NULL, record BLOB NOT NULL); INSERT INTO chunks SELECT * FROM old;";
  for (const Case& c : {
           Case{"trigger", "CREATE TRIGGER t AFTER INSERT ON resume BEGIN DELETE FROM chunks; END",
                "has a trigger 't'"},
           Case{"view", "CREATE VIEW v AS SELECT * FROM chunks", "has a view 'v'"},
           Case{"table", "CREATE TABLE extra (x)", "has a table 'extra'"},
           Case{"index", "CREATE INDEX i ON scans (points)", "has a index 'i'"},
           Case{"view instead of a table",
                "DROP TABLE labels; CREATE VIEW labels AS SELECT value AS yaml FROM meta",
                "table labels is not made as csom makes it"},
           Case{"generated column",
                "DROP TABLE chunks; CREATE TABLE chunks (x INTEGER NOT NULL, y INTEGER NOT NULL, "
                "z INTEGER NOT NULL, hash INTEGER NOT NULL, record BLOB NOT NULL GENERATED ALWAYS "
                "AS (zeroblob(900000000)) VIRTUAL, PRIMARY KEY (z, y, x)); "
                "INSERT INTO chunks VALUES (0, 0, 0, 0), (1, 0, 0, 0), (2, 0, 0, 0)",
                "table chunks is not made as csom makes it"},
           Case{"chunks without a key", copy_chunks + "DROP TABLE old",
                "table chunks is not made as csom makes it"},
           Case{"missing table", "DROP TABLE totals", "has no table totals"},
           Case{"two label sets", "INSERT INTO labels SELECT yaml FROM labels",
                "table labels has two rows"},
       }) {
    SCOPED_TRACE(c.name);
    fs::remove(map);
    saveMap(sampleDocument(), map);
    sql(map, c.statements);
    const std::string csom_word = csomWord();
    for (const char* command :
         {"info map.csom", "query map.csom --point 0,0,0", "export map.csom --to csv -o x.csv",
          "merge map.csom map.csom -o x.csom"}) {
      // In so little memory that nothing made up fits into it.
      const auto run = shell("ulimit -v 2000000; " + csom_word + " " + command);
      EXPECT_EQ(run.exit_code, 1) << command;
      EXPECT_THAT(run.errors, HasSubstr(c.reason)) << command;
    }
    const auto verified = csom({"info", map, "--verify"});
    EXPECT_EQ(verified.exit_code, 1);
    EXPECT_THAT(verified.errors, HasSubstr(c.reason));
  }
}

TEST_F(RightOrRefusedFiles, B5_ChunksThatAreThereTwiceAreRefused) {
  saveMap(sampleDocument(), map);
  // Past the unique index: a file that SQLite itself calls damaged.
  sql(map, "PRAGMA writable_schema = ON; DELETE FROM sqlite_master WHERE type = 'index'");
  sql(map,
      "PRAGMA writable_schema = ON; UPDATE sqlite_master SET sql = replace(sql, ', PRIMARY KEY (z, "
      "y, x)', '') WHERE name = 'chunks'");
  sql(map, "INSERT INTO chunks SELECT * FROM chunks LIMIT 1");
  const auto run = csom({"info", map});
  EXPECT_EQ(run.exit_code, 1) << run.output;
}

TEST_F(RightOrRefusedFiles, B5_TheDigestThatInfoPrintsIsThatOfTheFile) {
  saveMap(sampleDocument(), map);
  const auto run = csom({"info", map});
  EXPECT_THAT(run.output, HasSubstr("digest          " + mapDigest(sampleMap())));
  sql(map, "UPDATE meta SET value = '0123456789abcdef' WHERE key = 'digest'");
  const auto changed = csom({"info", map});
  EXPECT_EQ(changed.exit_code, 1);
  EXPECT_THAT(changed.errors, HasSubstr("its chunks have digest " + mapDigest(sampleMap())));
}

// --- B6: what a run is resumed with
// ----------------------------------------------------------------------------

class Resumed : public RightOrRefusedFiles {
 protected:
  /// A run that was stopped in its middle.
  void stopARun(const std::vector<std::string>& more = {}, int signal = SIGTERM) const {
    writeConfig(folder, "method = s-csm\n");
    if (!fs::exists(log)) writeLog(log, driveEntries(400));
    std::vector<std::string> command{
        "map", log, "-c", folder / "map.ini", "-o", folder / "out", "--checkpoint", "0"};
    command.insert(command.end(), more.begin(), more.end());
    RunningProgram run(folder.path(), command);
    while (run.isRunning() && !hasScans())
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    run.send(signal);
    const ProgramResult result = run.wait();
    ASSERT_EQ(result.exit_code, 130) << result.errors;
    ASSERT_TRUE(fs::exists(unfinished)) << result.errors;
  }
  bool hasScans() const {
    try {
      return fs::exists(unfinished) && !loadMap(unfinished).scans.empty();
    } catch (const FileError&) {
      return false;
    }
  }
  const std::string log = folder / "a.rawlog";
  const std::string unfinished = folder / "out/unfinished.csom";
};

TEST_F(Resumed, B6_OutputsOutsideOfTheFolderComeFromTheCommandLine) {
  stopARun({"--write-simplemap", folder / "first.simplemap"});
  const auto without = csom({"map", "--resume", folder / "out"});
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_THAT(without.errors, AllOf(HasSubstr("first.simplemap"), HasSubstr("--write-simplemap")));
  EXPECT_FALSE(fs::exists(folder / "first.simplemap"));
  const auto run =
      csom({"map", "--resume", folder / "out", "--write-simplemap", folder / "second.simplemap"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_TRUE(fs::exists(folder / "second.simplemap"));
  EXPECT_FALSE(fs::exists(folder / "first.simplemap"));
  EXPECT_EQ(loadMap(folder / "out/map.csom").scans.size(), 400u);
}

TEST_F(Resumed, B6_ALabelCacheIsUsedOnlyIfItIsNamedAgain) {
  stopARun({"--label-cache", folder / "cache"});
  fs::remove_all(folder / "cache");
  EXPECT_EQ(csom({"map", "--resume", folder / "out"}).exit_code, 0);
  EXPECT_FALSE(fs::exists(folder / "cache"));
}

TEST_F(Resumed, B6_ATriggerInTheFileRunsNothing) {
  stopARun();
  const std::size_t chunks = loadMap(unfinished).map.chunks().chunkCount();
  sql(unfinished, "CREATE TRIGGER t AFTER INSERT ON resume BEGIN DELETE FROM chunks; END");
  const auto run = csom({"map", "--resume", folder / "out"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.errors, HasSubstr("has a trigger 't'"));
  sql(unfinished, "DROP TRIGGER t");
  EXPECT_EQ(loadMap(unfinished).map.chunks().chunkCount(), chunks);
  EXPECT_EQ(csom({"map", "--resume", folder / "out"}).exit_code, 0);
}

// --- B7: nothing counts twice
// -------------------------------------------------------------------------------------

TEST_F(RightOrRefusedFiles, B7_NoLogCountsTwice) {
  const std::string config = writeConfig(folder);
  writeLog(folder / "a.rawlog", driveEntries(3));
  writeLog(folder / "b.rawlog", driveEntries(4));
  fs::copy_file(folder / "a.rawlog", folder / "copy.rawlog");
  const auto mapInto = [&](const std::string& name, const std::vector<std::string>& logs) {
    std::vector<std::string> command{"map", "-c", config, "-o", folder / name};
    for (const std::string& log : logs) command.push_back(folder / log);
    return csom(command);
  };
  ASSERT_EQ(mapInto("a", {"a.rawlog"}).exit_code, 0);
  ASSERT_EQ(mapInto("b", {"b.rawlog"}).exit_code, 0);
  ASSERT_EQ(mapInto("c", {"copy.rawlog"}).exit_code, 0);
  writeConfig(folder, "method = s-csm\n");
  ASSERT_EQ(mapInto("other", {"a.rawlog"}).exit_code, 0);
  const auto merge = [&](const std::vector<std::string>& maps, const std::string& output) {
    std::vector<std::string> command{"merge", "-o", folder / output};
    for (const std::string& name : maps) command.push_back(folder / name);
    return csom(command);
  };
  ASSERT_EQ(merge({"a/map.csom", "b/map.csom"}, "ab.csom").exit_code, 0);
  for (const auto& maps :
       std::vector<std::vector<std::string>>{{"a/map.csom", "a/map.csom"},
                                             {"a/map.csom", "b/map.csom", "c/map.csom"},
                                             {"a/map.csom", "other/map.csom"},
                                             {"ab.csom", "a/map.csom"},
                                             {"b/map.csom", "ab.csom"}}) {
    const auto run = merge(maps, "twice.csom");
    EXPECT_EQ(run.exit_code, 1) << maps[0] << " " << maps[1];
    EXPECT_THAT(run.errors, HasSubstr("count twice"));
    EXPECT_FALSE(fs::exists(folder / "twice.csom"));
  }
  for (const char* again : {"a.rawlog", "copy.rawlog"}) {
    const auto run = mapInto("twice", {"a.rawlog", "b.rawlog", again});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_THAT(run.errors, HasSubstr("count twice"));
  }
}

TEST_F(RightOrRefusedFiles, B7_MapsOfOtherProgramsAreKnownByTheirContent) {
  saveMap(sampleDocument(), folder / "a.csom");
  saveMap(sampleDocument(), folder / "b.csom");
  const auto run = csom({"merge", folder / "a.csom", folder / "b.csom", "-o", folder / "c.csom"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.errors, HasSubstr("is the same map as"));
}

// --- B8: signals, full devices, texts
// ----------------------------------------------------------------------------

TEST_F(Resumed, B8_AClosedTerminalIsAsAWishToStop) {
  stopARun({}, SIGHUP);
  EXPECT_EQ(csom({"map", "--resume", folder / "out"}).exit_code, 0);
  EXPECT_EQ(loadMap(folder / "out/map.csom").scans.size(), 400u);
}

/// So many voxels that writing them takes a while.
MapDocument largeDocument(int seed) {
  MapDocument document = sampleDocument();
  Options options = document.map.options();
  options.method = Method::SCsm;
  options.free_space.mode = FreeSpace::None;
  options.resolution = 0.1;
  document.map = SemanticMap(options);
  std::mt19937 random(static_cast<unsigned>(seed));
  std::uniform_real_distribution<float> within(-20, 20);
  Scan scan;
  for (int i = 0; i < 200000; ++i) {
    scan.points.emplace_back(within(random), within(random), within(random) / 10);
    scan.labels.push_back(1);
  }
  document.map.insert(scan);
  return document;
}

TEST_F(RightOrRefusedFiles, B8_SignalsLeaveNoTemporaryFilesInAnyCommand) {
  saveMap(largeDocument(1), map);
  saveMap(largeDocument(2), folder / "more.csom");
  writeConfig(folder, "method = s-csm\n");
  writeLog(folder / "a.rawlog", driveEntries(300));
  ASSERT_EQ(
      csom({"map", folder / "a.rawlog", "-c", folder / "map.ini", "-o", folder / "run"}).exit_code,
      0);
  fs::create_directories(folder / "drive/velodyne_points/data");
  for (int i = 0; i < 300; ++i) {
    const std::string number = std::to_string(1000000000 + i).substr(1);
    writeBytes(folder / ("drive/velodyne_points/data/0" + number + ".bin"),
               std::string(16 * 20000, '\x3f'));
  }
  fs::create_directory(folder / "temporary");
  const std::string world = CSOM_SOURCE_DIR "/config/worlds/doorways.yaml";
  const auto exported = [&](const char* format, const std::string& name) {
    return std::vector<std::string>{"export", map, "--to", format, "-o", folder / ("o/" + name)};
  };
  const std::vector<std::pair<std::vector<std::string>, std::string>> commands{
      {exported("npz", "x.npz"), "x.npz"},
      {exported("ply", "x.ply"), "x.ply"},
      {exported("csv", "x.csv"), "x.csv"},
      {exported("vdb", "x.vdb"), "x.vdb"},
      {exported("octomap", "x.ot"), "x.ot"},
      {exported("glb", "x.glb"), "x.glb"},
      {exported("points", "x.map"), "x.map"},
      {{"merge", map, folder / "more.csom", "-o", folder / "o/x.csom"}, "x.csom"},
      {{"repair", map, folder / "o/x.csom"}, "x.csom"},
      {{"report", folder / "run", "-o", folder / "o/report"}, "report"},
      {{"simulate", world, "-o", folder / "o/x.rawlog"}, "x.rawlog"},
      {{"import", "kitti-raw", folder / "drive", "-o", folder / "o/x.rawlog"}, "x.rawlog"},
      {{"eval", "run", "P4", "-o", folder / "o/tables"}, "tables"},
      {{"map", folder / "a.rawlog", "-c", folder / "map.ini", "-o", folder / "o/out"}, "out"},
  };
  const auto namesIn = [](const std::string& path) {
    std::vector<std::string> names;
    std::error_code error;
    for (fs::recursive_directory_iterator at(path, error), end; !error && at != end;
         at.increment(error))
      names.push_back(at->path().filename().string());
    return names;
  };
  ::setenv("TMPDIR", (folder / "temporary").c_str(), 1);
  int caught = 0;
  for (const auto& [command, result] : commands) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
      SCOPED_TRACE(command[0] + " " + result + ", signal " + std::to_string(signal));
      fs::remove_all(folder / "o");
      fs::create_directory(folder / "o");
      RunningProgram run(folder.path(), command);
      // When there is something that should not stay.
      bool unfinished = false;
      while (!unfinished && run.isRunning()) {
        for (const std::string& name : namesIn(folder / "o"))
          unfinished |= name.find(".tmp") != std::string::npos || name.rfind("unfinished-", 0) == 0;
        unfinished |= !fs::is_empty(folder / "temporary");
      }
      run.send(signal);
      if (command[0] == "map") {  // which finishes its scan, unless it is asked twice
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        run.send(signal);
      }
      const ProgramResult end = run.wait();
      caught += unfinished && end.exit_code != 0 ? 1 : 0;
      std::vector<std::string> left;
      for (const auto& entry : fs::directory_iterator(folder / "o"))
        left.push_back(entry.path().filename().string());
      EXPECT_THAT(left, AnyOf(IsEmpty(), ElementsAre(result))) << end.errors;
      for (const std::string& name : namesIn(folder / "o")) {
        EXPECT_THAT(name, Not(HasSubstr(".tmp")));
        EXPECT_FALSE(name.rfind("unfinished-", 0) == 0) << name;
      }
      EXPECT_THAT(namesIn(folder / "temporary"), IsEmpty());
      fs::remove_all(folder / "temporary");
      fs::create_directory(folder / "temporary");
    }
  }
  ::unsetenv("TMPDIR");
  EXPECT_GT(caught, 20) << "or nothing has been tried out";
}

TEST_F(RightOrRefusedFiles, B8_TextsThatCannotBeWrittenAreFailures) {
  for (const char* command : {"map --print-config", "--help", "--version", "map --help"}) {
    const auto run = shell(csomWord() + " " + command + " >/dev/full");
    EXPECT_EQ(run.exit_code, 1) << command;
    EXPECT_THAT(run.errors, HasSubstr("standard output: cannot be written")) << command;
    EXPECT_EQ(shell(csomWord() + " " + command + " >/dev/null").exit_code, 0) << command;
  }
}

TEST_F(RightOrRefusedFiles, B8_CellsOfACsvAreNoFormulas) {
  for (const char* name : {"=1+1", "+1", "-1", "@sum", "=HYPERLINK(\"x\",1)"}) {
    MapDocument document = sampleDocument();
    std::string yaml = document.labels.toYaml();
    const std::string road = "\"road\"";
    std::string quoted = "'" + std::string(name) + "'";
    const std::size_t at = yaml.find("road");
    ASSERT_NE(at, std::string::npos) << yaml;
    const bool in_quotes = yaml[at - 1] == '"' || yaml[at - 1] == '\'';
    yaml.replace(in_quotes ? at - 1 : at, in_quotes ? 6 : 4, quoted);
    document.labels = LabelSet::fromYaml(yaml, "test");
    saveMap(document, map);
    const auto run = csom({"export", map, "--to", "csv", "-o", folder / "x.csv"});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    const std::string csv = readBytes(folder / "x.csv");
    EXPECT_FALSE(csv.find(",1," + std::string(name, 1)) != std::string::npos) << name;
    EXPECT_FALSE(csv.find(",1,\"" + std::string(name, 1)) != std::string::npos) << name;
    EXPECT_TRUE(csv.find(",1,'" + std::string(name, 1)) != std::string::npos ||
                csv.find(",1,\"'=HYPERLINK") != std::string::npos)
        << name;
  }
}

TEST_F(RightOrRefusedFiles, B8_NothingFromAFileSteersTheTerminal) {
  MapDocument document = sampleDocument();
  document.meta["rawlog"] =
      "a\x1b[31mred\u202egnp.exe\u200b\xc2\x9b"
      "31m\x9b";
  saveMap(document, map);
  for (const auto& run : {csom({"info", map}), csom({"merge", map, map, "-o", folder / "\x1b[2Jx"}),
                          csom({"info", folder / "no\u202ename"})}) {
    for (const std::string& text : {run.output, run.errors})
      for (const char* bad : {"\x1b", "\u202e", "\u200b", "\xc2\x9b", "\x9b"})
        EXPECT_THAT(text, Not(HasSubstr(bad)));
  }
}

TEST_F(RightOrRefusedFiles, B8_ARunRecordThatIsNoRegularFileIsRefused) {
  writeConfig(folder);
  writeLog(folder / "a.rawlog", driveEntries(2));
  ASSERT_EQ(
      csom({"map", folder / "a.rawlog", "-c", folder / "map.ini", "-o", folder / "out"}).exit_code,
      0);
  fs::remove(folder / "out/run.json");
  ASSERT_EQ(::mkfifo((folder / "out/run.json").c_str(), 0600), 0);
  EXPECT_THAT(csom({"report", folder / "out"}).errors,
              HasSubstr("run.json: is not a regular file"));
  fs::remove(folder / "map.ini");
  ASSERT_EQ(::mkfifo((folder / "map.ini").c_str(), 0600), 0);
  const auto ini = csom({"map", folder / "a.rawlog", "-c", folder / "map.ini", "-o", folder / "b"});
  EXPECT_EQ(ini.exit_code, 2);
  EXPECT_THAT(ini.errors, HasSubstr("is no regular file"));
  EXPECT_THAT(csom({"simulate", folder / "map.ini", "-o", folder / "x.rawlog"}).errors,
              HasSubstr("is no regular file"));
}

}  // namespace
}  // namespace csom::test
