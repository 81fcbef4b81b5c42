// SPDX-License-Identifier: BSD-3-Clause
#include <csom/io/OutputFile.h>
#include <sqlite3.h>

#include <cmath>
#include <limits>
#include <random>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// Runs SQL on a file, as somebody who tampers with it would.
void runSql(const std::string& file, const std::string& sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  char* message = nullptr;
  EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, &message), SQLITE_OK)
      << sql << ": " << (message != nullptr ? message : "");
  sqlite3_free(message);
  sqlite3_close(database);
}

std::string loadError(const std::string& file) {
  return fileErrorOf([&] { loadMap(file); });
}

void expectEqual(const ScanRecord& a, const ScanRecord& b) {
  EXPECT_EQ(a.timestamp, b.timestamp);
  EXPECT_EQ(a.sensor_label, b.sensor_label);
  EXPECT_EQ(a.observation_class, b.observation_class);
  EXPECT_EQ(a.origin, b.origin);
  EXPECT_EQ(a.report.points, b.report.points);
  EXPECT_EQ(a.report.rejected, b.report.rejected);
  EXPECT_EQ(a.report.training_points, b.report.training_points);
  EXPECT_EQ(a.report.free_points, b.report.free_points);
  EXPECT_EQ(a.report.free_voxels, b.report.free_voxels);
  EXPECT_EQ(a.report.blocks_observed, b.report.blocks_observed);
  EXPECT_EQ(a.report.blocks_filled, b.report.blocks_filled);
  EXPECT_EQ(a.report.voxels_updated, b.report.voxels_updated);
  EXPECT_EQ(a.report.prepare_ms, b.report.prepare_ms);
  EXPECT_EQ(a.report.infer_ms, b.report.infer_ms);
  EXPECT_EQ(a.report.commit_ms, b.report.commit_ms);
}

class MapFileTest : public testing::Test {
 protected:
  /// A saved sample map.
  std::string savedMap() const {
    const std::string file = folder_ / "map.csom";
    saveMap(sampleDocument(), file);
    return file;
  }

  TempFolder folder_;
};

TEST_F(MapFileTest, RoundTripKeepsEverything) {
  const MapDocument saved = sampleDocument();
  ASSERT_GT(saved.map.knownVoxelCount(), 100U);
  const MapDocument loaded = loadMap(savedMap());
  EXPECT_EQ(mapDigest(loaded.map), mapDigest(saved.map));
  EXPECT_EQ(loaded.map.knownVoxelCount(), saved.map.knownVoxelCount());
  EXPECT_EQ(loaded.labels, saved.labels);
  EXPECT_EQ(loaded.meta, saved.meta);
  ASSERT_EQ(loaded.scans.size(), saved.scans.size());
  for (std::size_t i = 0; i < saved.scans.size(); ++i) expectEqual(loaded.scans[i], saved.scans[i]);
}

TEST_F(MapFileTest, EveryOptionIsKept) {
  Options options;
  options.number_of_classes = 7;
  options.resolution = 0.1;
  options.block_depth = 3;
  options.method = Method::SBki;
  options.see_csom.rvfm = false;
  options.kernel.aklm = false;
  options.kernel.shape = Kernel::Linear;
  options.see_csom.neighbourhood = Neighbourhood::ExtendedBlock;
  options.scan.ds_resolution = 1.0 / 3;
  options.scan.min_range = 0.5;
  options.scan.max_range = 70;
  options.free_space.mode = FreeSpace::Raycast;
  options.free_space.weight = 0.0625;
  options.see_csom.context_neighbours = 18;
  options.kernel.length_min = 0.31;
  options.kernel.length_max = 0.47;
  options.kernel.length = 0.4;
  options.prior = 1e-4;
  options.threads = 3;
  MapDocument document;
  document.map = SemanticMap(options);
  std::string yaml = "name: seven\nclasses:\n";
  for (int i = 0; i < 7; ++i)
    yaml += "  - {id: " + std::to_string(i) + ", name: " + (i == 0 ? "free" : "c") +
            (i == 0 ? "" : std::to_string(i)) + ", color: [" + std::to_string(i) + ", 0, 0]}\n";
  document.labels = LabelSet::fromYaml(yaml, "seven");
  saveMap(document, folder_ / "m.csom");
  const Options loaded = loadMap(folder_ / "m.csom").map.options();
  visitOptions(options, [&](const OptionInfo& option, auto& value) {
    visitOptions(loaded, [&](const OptionInfo& other, const auto& read) {
      if (std::string(option.key) == other.key) {
        EXPECT_EQ(toString(value), toString(read)) << option.key;
      }
    });
  });
}

TEST_F(MapFileTest, EmptyMapRoundTrip) {
  saveMap(MapDocument{}, folder_ / "empty.csom");
  const MapDocument loaded = loadMap(folder_ / "empty.csom");
  EXPECT_TRUE(loaded.map.empty());
  EXPECT_TRUE(loaded.scans.empty());
}

TEST_F(MapFileTest, EqualDocumentsMakeEqualFiles) {
  saveMap(sampleDocument(), folder_ / "a.csom");
  saveMap(loadMap(folder_ / "a.csom"), folder_ / "b.csom");
  EXPECT_EQ(readBytes(folder_ / "a.csom"), readBytes(folder_ / "b.csom"));
}

TEST_F(MapFileTest, NanInScansSurvives) {
  MapDocument document = sampleDocument();
  document.scans[0].timestamp = std::numeric_limits<double>::quiet_NaN();
  saveMap(document, folder_ / "nan.csom");
  EXPECT_TRUE(std::isnan(loadMap(folder_ / "nan.csom").scans[0].timestamp));
}

TEST_F(MapFileTest, IsASqliteDatabaseThatSaysWhatItIs) {
  const std::string bytes = readBytes(savedMap());
  EXPECT_EQ(bytes.substr(0, 15), "SQLite format 3");
  EXPECT_EQ(bytes.substr(68, 4), "CSOM") << "the application id in the header";
}

TEST_F(MapFileTest, ReplacesAnOldMapAndLeavesNoOtherFile) {
  writeBytes(folder_ / "map.csom", "old");
  savedMap();
  EXPECT_NO_THROW(loadMap(folder_ / "map.csom"));
  EXPECT_THAT(folder_.fileNames(), ElementsAre("map.csom"));
}

TEST_F(MapFileTest, RefusesMapAndLabelsOfDifferentSize) {
  MapDocument document = sampleDocument();
  document.labels = LabelSet::occupancy();
  EXPECT_THROW(saveMap(document, folder_ / "map.csom"), std::invalid_argument);
  EXPECT_THAT(folder_.fileNames(), testing::IsEmpty());
}

TEST_F(MapFileTest, UnwritableTargetsAreNamed) {
  EXPECT_THAT(fileErrorOf([] { saveMap(sampleDocument(), "/nowhere/map.csom"); }),
              HasSubstr("/nowhere/map.csom: cannot be written: No such file or directory"));
  EXPECT_THAT(fileErrorOf([&] { saveMap(sampleDocument(), folder_.path()); }),
              HasSubstr("is a folder"));
  EXPECT_THAT(fileErrorOf([] { saveMap(sampleDocument(), "/dev/full"); }),
              HasSubstr("/dev/full: is not a regular file"));
}

// ---- files that are no maps -------------------------------------------------------------------

TEST_F(MapFileTest, RefusesWhatIsNoMap) {
  EXPECT_THAT(loadError(folder_ / "missing.csom"), HasSubstr("missing.csom: no such file"));
  EXPECT_THAT(loadError(folder_.path()), HasSubstr("is a folder"));
  writeBytes(folder_ / "empty", "");
  EXPECT_THAT(loadError(folder_ / "empty"), HasSubstr("empty: is no csom map"));
  writeBytes(folder_ / "text", std::string(5000, 'x'));
  EXPECT_THAT(loadError(folder_ / "text"), HasSubstr("text: is no csom map (not a SQLite"));
  runSql(folder_ / "other", "CREATE TABLE meta (key TEXT, value TEXT)");
  EXPECT_THAT(loadError(folder_ / "other"), HasSubstr("other: is no csom map"));
}

TEST_F(MapFileTest, RefusesALaterVersionAndSaysWhatToDo) {
  const std::string file = savedMap();
  runSql(file, "PRAGMA user_version = 3");
  EXPECT_THAT(loadError(file), AllOf(HasSubstr("format version 3"),
                                     HasSubstr("reads up to 2; use a newer mrpt_csom")));
}

TEST_F(MapFileTest, EveryTruncationIsAnError) {
  const std::string bytes = readBytes(savedMap());
  ASSERT_GT(bytes.size(), 8192U);
  for (std::size_t size = 0; size < bytes.size(); size += bytes.size() / 61) {
    writeBytes(folder_ / "cut.csom", bytes.substr(0, size));
    EXPECT_THAT(loadError(folder_ / "cut.csom"), HasSubstr("cut.csom: ")) << size;
  }
}

TEST_F(MapFileTest, FlippedBitsNeverCrashAndNeverChangeTheMap) {
  const std::string bytes = readBytes(savedMap());
  const std::string digest = mapDigest(sampleMap());
  std::mt19937 random(7);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::string damaged = bytes;
    const std::size_t at = random() % damaged.size();
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (random() % 8)));
    writeBytes(folder_ / "flip.csom", damaged);
    try {
      EXPECT_EQ(mapDigest(loadMap(folder_ / "flip.csom").map), digest) << "byte " << at;
    } catch (const FileError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
}

struct Tampering {
  const char* name;
  const char* sql;
  const char* reason;
};

/// How GoogleTest shows the parameter.
void PrintTo(const Tampering& value, std::ostream* out) {
  *out << value.name;
}

class TamperedMaps : public MapFileTest, public testing::WithParamInterface<Tampering> {};

TEST_P(TamperedMaps, AreRefusedWithTableAndReason) {
  const std::string file = savedMap();
  runSql(file, GetParam().sql);
  const std::string message = loadError(file);
  EXPECT_THAT(message, HasSubstr(file + ": "));
  EXPECT_THAT(message, HasSubstr(GetParam().reason));
  EXPECT_THAT(message, testing::Not(HasSubstr("\n")));
}

INSTANTIATE_TEST_SUITE_P(
    All, TamperedMaps,
    testing::Values(
        Tampering{"NoChunksTable", "DROP TABLE chunks", "has no table chunks"},
        Tampering{"ChunkMissing", "DELETE FROM chunks WHERE rowid = 1", "digest"},
        Tampering{"ChunkMoved", "UPDATE chunks SET x = x + 1000 WHERE rowid = 1",
                  "row 1: its hash does not match"},
        Tampering{"ChunkFarAway", "UPDATE chunks SET x = 2000000 WHERE rowid = 1",
                  "row 1: its hash does not match"},
        Tampering{"ChunkIndexHuge", "UPDATE chunks SET z = 9223372036854775807 WHERE rowid = 1",
                  "is out of range"},
        Tampering{"ChunkIndexText", "UPDATE chunks SET x = 'a' WHERE rowid = 1",
                  "column 'x' is a text, must be an integer"},
        Tampering{"WrongHash", "UPDATE chunks SET hash = hash + 1 WHERE rowid = 2",
                  "row 2: its hash does not match"},
        Tampering{"RecordNoZstd", "UPDATE chunks SET record = x'0102030405' WHERE rowid = 1",
                  "table chunks, row 1: no zstd frame"},
        Tampering{"RecordEmpty", "UPDATE chunks SET record = x'' WHERE rowid = 1",
                  "table chunks, row 1"},
        // A frame header that announces 2^40 bytes.
        Tampering{"RecordBomb",
                  "UPDATE chunks SET record = x'28b52ffde000000000000100000100' WHERE rowid = 1",
                  "are possible"},
        Tampering{"RecordText", "UPDATE chunks SET record = 'abc' WHERE rowid = 1",
                  "must be a blob"},
        Tampering{"NoDigest", "DELETE FROM meta WHERE key = 'digest'", "table meta says ''"},
        Tampering{"OtherResolution", "UPDATE options SET value = '0.5' WHERE key = 'resolution'",
                  "digest"},
        Tampering{"NanResolution", "UPDATE options SET value = 'nan' WHERE key = 'resolution'",
                  "table options: resolution"},
        Tampering{"HugeResolution", "UPDATE options SET value = '1e300' WHERE key = 'resolution'",
                  "resolution"},
        Tampering{"ClassesHuge",
                  "UPDATE options SET value = '2000000000' WHERE key = 'number_of_classes'",
                  "table options: number_of_classes"},
        Tampering{"OptionMissing", "DELETE FROM options WHERE key = 'prior'",
                  "table options: prior is missing"},
        Tampering{"OptionUnknown", "INSERT INTO options VALUES ('colour', '1')",
                  "unknown option colour"},
        Tampering{"OptionNumber", "UPDATE options SET value = x'00' WHERE key = 'prior'",
                  "must be a text"},
        Tampering{"OtherMethod", "UPDATE options SET value = 's-bki' WHERE key = 'method'",
                  "have been changed"},
        Tampering{"OtherColour", "UPDATE labels SET yaml = replace(yaml, '255', '254')",
                  "have been changed"},
        Tampering{"ScanMissing", "DELETE FROM scans WHERE id = 2", "have been changed"},
        Tampering{"ScanMoved", "UPDATE scans SET origin_x = origin_x + 1 WHERE id = 1",
                  "table scans, row 1: its hash does not match"},
        Tampering{"NoDescription", "DROP TABLE description", "has no table description"},
        Tampering{"OtherMeta", "INSERT INTO meta VALUES ('seed', '1')", "have been changed"},
        Tampering{"NoChecksum", "DELETE FROM meta WHERE key = 'checksum'", "have been changed"},
        Tampering{"NoLabels", "DELETE FROM labels", "table labels is empty"},
        Tampering{"BadLabels", "UPDATE labels SET yaml = 'name: a'",
                  "table labels: line 1: the label set lacks the key 'classes'"},
        Tampering{
            "OtherLabels",
            "UPDATE labels SET yaml = 'name: a\nclasses: [{id: 0, name: free, color: [1,1,1]},"
            "{id: 1, name: b, color: [2,2,2]}]'",
            "table labels has 2 classes, the options say 3"},
        Tampering{"ScanCountNegative", "UPDATE scans SET points = -1 WHERE id = 2",
                  "table scans, row 2: points is -1"},
        Tampering{"ScanText", "UPDATE scans SET timestamp = 'noon' WHERE id = 1",
                  "column 'timestamp' is a text"}),
    [](const auto& test) { return test.param.name; });

// ---- digest -----------------------------------------------------------------------------------

Scan randomScan(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(-6, 6);
  Scan scan;
  for (int i = 0; i < 200; ++i) {
    scan.points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
    scan.labels.push_back(static_cast<ClassId>(1 + random() % 2));
  }
  return scan;
}

TEST(MapDigest, DoesNotDependOnTheOrderOfScans) {
  Options options;
  options.number_of_classes = 3;
  SemanticMap forward(options);
  SemanticMap backward(options);
  for (unsigned i = 0; i < 5; ++i) forward.insert(randomScan(i));
  for (unsigned i = 5; i-- > 0;) backward.insert(randomScan(i));
  EXPECT_EQ(mapDigest(forward), mapDigest(backward));
  EXPECT_EQ(mapDigest(forward).size(), 16U);
  backward.insert(randomScan(0));
  EXPECT_NE(mapDigest(forward), mapDigest(backward));
}

TEST(MapDigest, SeesResolutionClassesAndPrior) {
  const Options base;
  Options resolution = base;
  resolution.resolution = 0.3;
  Options classes = base;
  classes.number_of_classes = 3;
  Options prior = base;
  prior.prior = 0.002;
  Options threads = base;
  threads.threads = 2;
  const std::string digest = mapDigest(SemanticMap(base));
  EXPECT_NE(digest, mapDigest(SemanticMap(resolution)));
  EXPECT_NE(digest, mapDigest(SemanticMap(classes)));
  EXPECT_NE(digest, mapDigest(SemanticMap(prior)));
  EXPECT_EQ(digest, mapDigest(SemanticMap(threads))) << "threads do not change a map";
}

TEST_F(MapFileTest, TablesAreTablesAndNotQueriesThatNeverEnd) {
  const std::string endless =
      " AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) ";
  const std::pair<const char*, const char*> views[] = {
      {"meta", "SELECT 'a' AS key, 'b' AS value FROM n"},
      {"options", "SELECT 'a' AS key, 'b' AS value FROM n"},
      {"labels", "SELECT 'a' AS yaml FROM n WHERE i < 0"},
      {"scans", "SELECT 1 AS id FROM n"},
      {"chunks", "SELECT i AS x, i AS y, i AS z, i AS hash, x'00' AS record FROM n WHERE i < 0"}};
  for (const auto& [table, query] : views) {
    const std::string file = savedMap();
    runSql(file, std::string("DROP TABLE ") + table + "; CREATE VIEW " + table + endless + query);
    EXPECT_THAT(loadError(file),
                AllOf(HasSubstr("map.csom"), HasSubstr(std::string("its table ") + table +
                                                       " is not made as csom makes it")));
  }
}

TEST(MapFileLocks, AFileThatSomebodyElseHoldsSaysSo) {
  const TempFolder folder;
  const std::string file = folder / "map.csom";
  saveMap(sampleDocument(), file);
  sqlite3* holder = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &holder), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(holder, "BEGIN EXCLUSIVE", nullptr, nullptr, nullptr), SQLITE_OK);
  EXPECT_THAT(loadError(file), AllOf(HasSubstr(file), HasSubstr("cannot be locked"),
                                     HasSubstr("its file system has no locks")));
  sqlite3_close(holder);
}

}  // namespace
}  // namespace csom::test
