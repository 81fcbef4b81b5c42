// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/RunCsom.h"
#include "protocols/SmallInputs.h"

namespace csom {
namespace {

namespace fs = std::filesystem;
using test::ProgramResult;
using test::runCsom;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

class EvalTest : public testing::Test {
 protected:
  ProgramResult csom(const std::vector<std::string>& arguments) {
    return runCsom(folder_.path(), arguments);
  }

  void expectFailure(const ProgramResult& result, int exit_code, const std::string& reason) {
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_THAT(result.errors, HasSubstr(reason));
    ASSERT_EQ(result.errorLines().size(), 1U) << result.errors;
  }

  /// A map of the small world and its truth, made once.
  void makeMap() {
    const std::string world = test::smallWorld(folder_, test::kPointSampler);
    ASSERT_EQ(csom({"simulate", world, "-o", folder_ / "x.rawlog", "--truth", truth()}).exit_code,
              0);
    const ProgramResult mapped =
        csom({"map", folder_ / "x.rawlog", "-c", CSOM_SOURCE_DIR "/config/room.ini", "-o",
              folder_ / "out", "--no-html"});
    ASSERT_EQ(mapped.exit_code, 0) << mapped.errors;
  }
  std::string map() const { return folder_ / "out/map.csom"; }
  std::string truth() const { return folder_ / "truth.csom"; }

  test::TempFolder folder_;
};

TEST_F(EvalTest, VoxelsHaveConfusionAndF1) {
  makeMap();
  const ProgramResult result =
      csom({"eval", "voxels", "--map", map(), "--truth", truth(), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_GT(json["w_average_iou"], 0.2);
  EXPECT_GT(json["f1"]["wall"], json["iou"]["wall"]);
  EXPECT_EQ(json["confusion"]["classes"][0], "free");
  EXPECT_EQ(json["confusion"]["counts"].size(), json["confusion"]["classes"].size());
  EXPECT_GT(json["free_iou"], 0.5);
  const ProgramResult text = csom({"eval", "voxels", "--map", map(), "--truth", truth()});
  EXPECT_THAT(text.output, HasSubstr("F1"));
}

TEST_F(EvalTest, RocHasAreaAndCurve) {
  makeMap();
  const ProgramResult result = csom({"eval", "roc", "--map", map(), "--truth", truth(), "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_GT(json["auc"], 0.9);
  EXPECT_GT(json["tpr_at_fpr_0.2"], 0.8);
  EXPECT_EQ(json["roc"].front(), nlohmann::json({0.0, 0.0}));
  EXPECT_EQ(json["roc"].back(), nlohmann::json({1.0, 1.0}));
  EXPECT_LT(json["ece"], 0.2);
  EXPECT_THAT(csom({"eval", "roc", "--map", map(), "--truth", truth()}).output, HasSubstr("AUC"));
}

TEST_F(EvalTest, RocNeedsATruthThatKnowsFreeVoxels) {
  test::writeBytes(folder_ / "1.pcd", test::pcdFile("0.01 0.01 0.01 1\n", 1));
  ASSERT_EQ(csom({"import", "pcd", folder_ / "1.pcd", "-o", folder_ / "p.rawlog"}).exit_code, 0);
  // A method that says nothing about what lies beside surfaces.
  test::writeBytes(folder_ / "counts.ini",
                   "[MappingApplication]\nsemanticContinuousMap_count = 1\n"
                   "[MappingApplication_semanticContinuousMap_00_creationOpts]\n"
                   "label_set = stanford\nmethod = s-csm\n"
                   "[MappingApplication_semanticContinuousMap_00_insertOpts]\n"
                   "point_labels = intensity\n");
  ASSERT_EQ(csom({"map", folder_ / "p.rawlog", "-c", folder_ / "counts.ini", "-o", folder_ / "out",
                  "--no-html"})
                .exit_code,
            0);
  expectFailure(csom({"eval", "roc", "--map", map(), "--truth", map()}), 1, "knows no free voxels");
}

TEST_F(EvalTest, PointsAreScoredByTheVoxelsThatHoldThem) {
  fs::create_directory(folder_ / "clouds");
  test::writeBytes(folder_ / "clouds/1.pcd",
                   test::pcdFile("0.01 0.01 0.01 1\n0.02 0.01 0.01 1\n0.51 0.01 0.01 3\n", 3));
  ASSERT_EQ(csom({"import", "pcd", folder_ / "clouds", "-o", folder_ / "p.rawlog"}).exit_code, 0);
  ASSERT_EQ(csom({"map", folder_ / "p.rawlog", "-c", CSOM_SOURCE_DIR "/config/stanford.ini", "-o",
                  folder_ / "out", "--no-html"})
                .exit_code,
            0);
  test::writeBytes(folder_ / "clouds/2.pcd", test::pcdFile("9.01 0.01 0.01 2\n", 1));
  const std::string clouds = folder_ / "clouds";
  const ProgramResult result =
      csom({"eval", "points", "--map", map(), "--scans", clouds, "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const auto json = nlohmann::json::parse(result.output);
  EXPECT_EQ(json["points"], 4);
  EXPECT_DOUBLE_EQ(json["accuracy_points"], 0.75);
  EXPECT_DOUBLE_EQ(json["coverage"], 0.75);
  EXPECT_DOUBLE_EQ(json["miou_points"], 2.0 / 3);
  EXPECT_THAT(csom({"eval", "points", "--map", map(), "--scans", clouds}).output,
              HasSubstr("accuracy               75.00 %"));
  expectFailure(csom({"eval", "points", "--map", map(), "--scans", folder_ / "out"}), 1,
                "holds neither velodyne/");
}

TEST_F(EvalTest, RunWritesTablesAndJson) {
  const std::string world = test::smallWorld(folder_, test::kPointSampler);
  const ProgramResult result = csom({"eval", "run", "P4", "-o", folder_ / "out", "--world", world,
                                     "--methods", "see-csom,see-csom:rvfm=off"});
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_THAT(result.errorLines(), IsEmpty());
  EXPECT_EQ(test::readBytes(folder_ / "out/evaluation.md"), result.output);
  EXPECT_THAT(result.output, HasSubstr("| see-csom:rvfm=off |"));
  const auto json = nlohmann::json::parse(test::readBytes(folder_ / "out/evaluation.json"));
  ASSERT_EQ(json["protocols"]["P4"]["results"].size(), 2U);
  EXPECT_GT(json["protocols"]["P4"]["results"][0]["auc"], 0.9);
  EXPECT_THAT(json["command"], HasSubstr("eval run P4"));
}

TEST_F(EvalTest, RunLeavesOutAndNamesWhatHasNoData) {
  test::writeBytes(folder_ / "1.pcd", test::pcdFile("0.01 0.01 0.01 1\n", 1));
  const ProgramResult result = csom({"eval", "run", "P1,P3", "-o", folder_ / "out", "--data",
                                     folder_.path(), "--methods", "s-csm"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.errors, HasSubstr("left out P3"));
  const auto json = nlohmann::json::parse(test::readBytes(folder_ / "out/evaluation.json"));
  EXPECT_EQ(json["protocols"]["P1"]["results"].size(), 4U);
  EXPECT_EQ(json["left_out"][0]["protocol"], "P3");
}

TEST_F(EvalTest, RunWithWrongArgumentsWritesNothing) {
  const std::string out = folder_ / "out";
  expectFailure(csom({"eval", "run", "P9", "-o", out}), 2, "no protocol 'P9'");
  expectFailure(csom({"eval", "run", "P4", "-o", out, "--methods", "best"}), 2, "no method 'best'");
  expectFailure(csom({"eval", "run", "P4,P5", "-o", out, "--world", "x.yaml"}), 2,
                "--world is the world of P4, P5 or P8");
  expectFailure(csom({"eval", "run", "P4", "-o", out, "--world", folder_ / "none.yaml"}), 2,
                "none.yaml");
  EXPECT_FALSE(fs::exists(out));
}

}  // namespace
}  // namespace csom
