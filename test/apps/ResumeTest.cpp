// SPDX-License-Identifier: BSD-3-Clause
// A run of csom map that is killed, stopped or runs out of disk goes on and makes the same map.
#include <csom/io/MapRepair.h>
#include <csom/io/MapStore.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <thread>

#include "apps/RunningProgram.h"
#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

std::string shipped(const std::string& path) {
  return std::string(CSOM_SOURCE_DIR) + "/" + path;
}

/// How often the test kills: CSOM_KILLS, for a long run.
int killsWanted() {
  const char* const text = std::getenv("CSOM_KILLS");
  return text != nullptr ? std::atoi(text) : 15;
}

class Resume : public testing::Test {
 protected:
  Resume() {
    const std::string section = "[MappingApplication_semanticContinuousMap_00_";
    writeBytes(config, "[MappingApplication]\nsemanticContinuousMap_count = 1\n" + section +
                           "creationOpts]\nlabel_set = simulator\nresolution = 0.4\n" + section +
                           "insertOpts]\npoint_labels = intensity\nunlabelled_class = drop\n"
                           "method = s-csm\nds_resolution = 0.4\nmax_range = 20\n");
  }

  std::vector<std::string> command(int logs = 1, const std::string& checkpoint = "0") const {
    std::vector<std::string> words{"map", "-c",        config,         "-o",
                                   out,   "--no-html", "--checkpoint", checkpoint};
    for (int i = 0; i < logs; ++i) words.push_back(drive(i));
    return words;
  }

  /// The same drive in files of different content, as no log may be mapped twice: an empty member
  /// of gzip behind it has another time.
  std::string drive(int number) const {
    if (number == 0) return shipped("rawlogs/campus.rawlog");
    const std::string file = folder / ("drive" + std::to_string(number) + ".rawlog");
    std::string nothing("\x1f\x8b\x08\0\0\0\0\0\0\x03\x03\0\0\0\0\0\0\0\0\0", 20);
    nothing[4] = static_cast<char>(number);
    writeBytes(file, readBytes(shipped("rawlogs/campus.rawlog")) + nothing);
    return file;
  }

  /// The digest of the map of a run that nothing disturbs, in a folder of its own.
  std::string undisturbed(int logs = 1) const {
    auto words = command(logs, "10");
    words[4] = folder / "undisturbed";
    const auto run = runCsom(folder.path(), words);
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    return digest(folder / "undisturbed/map.csom");
  }

  static std::string digest(const std::string& map) {
    const MapVerification found = verifyMap(map);
    EXPECT_THAT(found.faults, IsEmpty());
    EXPECT_TRUE(found.finished);
    return found.digest;
  }

  bool isUnfinished() const { return std::filesystem::exists(unfinished); }

  ProgramResult resume(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"map", "--resume", out};
    words.insert(words.end(), more.begin(), more.end());
    return runCsom(folder.path(), words);
  }

  /// Returns when the run has committed a scan; false if it has ended before.
  bool waitForScan(RunningProgram& run) const {
    while (run.isRunning()) {
      try {
        if (isUnfinished() && !loadMap(unfinished).scans.empty()) return true;
      } catch (const FileError&) {
        // It has just been finished.
      }
    }
    return false;
  }

  void expectOnlyResults() const {
    for (const auto& entry : std::filesystem::directory_iterator(out))
      EXPECT_THAT(entry.path().filename().string(), testing::Not(HasSubstr("unfinished")));
  }

  const TempFolder folder;
  const std::string config = folder / "coarse.ini";
  const std::string out = folder / "out";
  const std::string unfinished = out + "/unfinished.csom";
};

TEST_F(Resume, AfterEveryKillToTheSameMap) {
  const auto start = std::chrono::steady_clock::now();
  const std::string expected = undisturbed();
  const auto length = std::chrono::steady_clock::now() - start;
  std::mt19937 random(2024);
  std::uniform_real_distribution<double> moment(0.0, 1.0);
  const int wanted = killsWanted();
  int kills = 0, resumed = 0, finished = 0;
  while (kills < wanted || isUnfinished()) {
    const bool go_on = isUnfinished();
    resumed += go_on ? 1 : 0;
    RunningProgram run(
        folder.path(),
        go_on ? std::vector<std::string>{"map", "--resume", out, "--checkpoint", "0"} : command());
    if (kills < wanted) {
      std::this_thread::sleep_for(length * moment(random));
      run.send(SIGKILL);
    }
    const auto result = run.wait();
    if (result.exit_code == 128 + SIGKILL) {
      ++kills;
      if (isUnfinished()) {
        const MapVerification found = verifyMap(unfinished);
        ASSERT_THAT(found.faults, IsEmpty()) << "after kill " << kills;
        ASSERT_FALSE(found.finished);
      }
      continue;
    }
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    ++finished;
    ASSERT_EQ(digest(out + "/map.csom"), expected) << "after kill " << kills;
    expectOnlyResults();
    std::filesystem::remove_all(out);
  }
  std::printf("%d kills, %d runs resumed, %d maps finished\n", kills, resumed, finished);
  EXPECT_GE(kills, wanted);
  EXPECT_GT(resumed, 0);
}

TEST_F(Resume, AfterCtrlC) {
  constexpr int kLogs = 8;
  const std::string expected = undisturbed(kLogs);
  RunningProgram run(folder.path(), command(kLogs));
  ASSERT_TRUE(waitForScan(run));
  run.send(SIGINT);
  const auto stopped = run.wait();
  EXPECT_EQ(stopped.exit_code, 130) << stopped.errors;
  EXPECT_THAT(stopped.errors, AllOf(HasSubstr("csom: stopped; "), HasSubstr(" saved; go on with: "
                                                                            "csom map --resume ")));
  EXPECT_THAT(stopped.errorLines(), testing::SizeIs(1));
  const auto info = runCsom(folder.path(), {"info", unfinished});
  EXPECT_EQ(info.exit_code, 0);
  EXPECT_THAT(info.output, HasSubstr("unfinished"));

  const auto begun_again = runCsom(folder.path(), command(kLogs));
  EXPECT_EQ(begun_again.exit_code, 1);
  EXPECT_THAT(begun_again.errors, HasSubstr("is the map of a run that has not been finished"));

  const auto resumed = resume();
  EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
  EXPECT_EQ(digest(out + "/map.csom"), expected);
  expectOnlyResults();
  EXPECT_EQ(resume().exit_code, 1);
  // The record of the run is that of all of it.
  EXPECT_EQ(loadMap(out + "/map.csom").scans.size(), 68U * kLogs);
}

TEST_F(Resume, WithLittleMemoryToo) {
  constexpr int kLogs = 6;
  const std::string expected = undisturbed(kLogs);
  RunningProgram run(folder.path(), command(kLogs));
  ASSERT_TRUE(waitForScan(run));
  run.send(SIGTERM);
  EXPECT_EQ(run.wait().exit_code, 130);
  const auto resumed = resume({"--max-memory", "1MB"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.errors;
  EXPECT_EQ(digest(out + "/map.csom"), expected);
}

TEST_F(Resume, AfterAFullDisk) {
  const std::string expected = undisturbed();
  int failed = 0, resumed = 0;
  for (std::uint64_t kilobytes = 8; kilobytes <= 1024; kilobytes = kilobytes * 3 / 2) {
    std::filesystem::remove_all(out);
    RunningProgram run(folder.path(), command(), {kilobytes * 1024});
    const auto full = run.wait();
    if (full.exit_code == 0) continue;
    ++failed;
    EXPECT_EQ(full.exit_code, 1) << full.errors;
    EXPECT_THAT(full.errors, HasSubstr("cannot be ")) << kilobytes;
    if (!isUnfinished()) {
      EXPECT_FALSE(std::filesystem::exists(out)) << "what holds nothing is removed";
      continue;
    }
    ++resumed;
    EXPECT_THAT(full.errors, HasSubstr("; go on with: csom map --resume "));
    EXPECT_THAT(verifyMap(unfinished).faults, IsEmpty());
    const auto again = resume();
    ASSERT_EQ(again.exit_code, 0) << again.errors;
    EXPECT_EQ(digest(out + "/map.csom"), expected) << kilobytes;
    expectOnlyResults();
  }
  EXPECT_GT(failed, 3);
  EXPECT_GT(resumed, 1);
}

TEST_F(Resume, AnOldMapStaysUntilTheNewOneIsComplete) {
  ASSERT_EQ(runCsom(folder.path(), command(1, "10")).exit_code, 0);
  const std::string before = readBytes(out + "/map.csom");
  RunningProgram run(folder.path(), command(8));
  ASSERT_TRUE(waitForScan(run));
  run.send(SIGKILL);
  run.wait();
  EXPECT_EQ(readBytes(out + "/map.csom"), before);
  ASSERT_EQ(resume().exit_code, 0);
  EXPECT_NE(readBytes(out + "/map.csom"), before);
}

TEST_F(Resume, OneWritesAndOthersRead) {
  RunningProgram run(folder.path(), command(8));
  ASSERT_TRUE(waitForScan(run));
  run.send(SIGSTOP);  // in the middle of whatever it does
  const auto second = runCsom(folder.path(), command(8));
  const auto also = resume();
  const auto info = runCsom(folder.path(), {"info", unfinished, "--json"});
  const auto exported =
      runCsom(folder.path(), {"export", unfinished, "--to", "ply", "-o", folder / "now.ply"});
  run.send(SIGCONT);
  EXPECT_EQ(run.wait().exit_code, 0) << "nobody was in its way";
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_THAT(second.errors, HasSubstr("is being written by another process"));
  EXPECT_EQ(also.exit_code, 1);
  EXPECT_THAT(also.errors, HasSubstr("is being written by another process"));
  EXPECT_EQ(info.exit_code, 0) << info.errors;
  EXPECT_THAT(info.output, HasSubstr("\"state\": \"unfinished\""));
  EXPECT_EQ(exported.exit_code, 0) << exported.errors;
}

TEST_F(Resume, RefusesOtherInputs) {
  const std::string log = folder / "log.rawlog";
  std::filesystem::copy_file(shipped("rawlogs/campus.rawlog"), log);
  std::vector<std::string> words = command(8);
  words.push_back(log);
  words.erase(std::find(words.begin(), words.end(), shipped("rawlogs/campus.rawlog")));
  RunningProgram run(folder.path(), words);
  ASSERT_TRUE(waitForScan(run));
  run.send(SIGINT);
  ASSERT_EQ(run.wait().exit_code, 130);

  const std::string ini = readBytes(config);
  writeBytes(config, ini + "\n");
  EXPECT_THAT(resume().errors, HasSubstr("coarse.ini: is not what it was when this map was begun"));
  writeBytes(config, ini);
  const std::string bytes = readBytes(log);
  std::filesystem::copy_file(shipped("rawlogs/room.rawlog"), log,
                             std::filesystem::copy_options::overwrite_existing);
  const auto refused = resume();
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.errors, HasSubstr("log.rawlog: is not what it was when this map was begun"));
  writeBytes(log, bytes);
  EXPECT_EQ(resume().exit_code, 0);
}

TEST_F(Resume, NeedsAnUnfinishedMapAndNoOtherOptions) {
  const auto none = resume();
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.errors, HasSubstr("has no unfinished.csom"));
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(resume({"-c", config}).exit_code, 2);
  EXPECT_EQ(runCsom(folder.path(), {"map", "-c", config, "-o", out}).exit_code, 2);
}

}  // namespace
}  // namespace csom::test
