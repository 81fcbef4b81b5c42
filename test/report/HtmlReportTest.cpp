// SPDX-License-Identifier: BSD-3-Clause
// The page: well-formed, self-contained, safe, and saying what happened.
#include <csom/report/Html.h>
#include <csom/report/HtmlReport.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cctype>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "SampleMaps.h"

namespace csom {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string pageOf(const RunRecord& record, const MapDocument& document) {
  return htmlReport(record, document, computeFigures(document),
                    {{MapView::Top, mapPicturePng(document, MapView::Top)}});
}

std::string samplePage() {
  return pageOf(test::sampleRecord(), test::mapOf({{{0, 0, 0}, 1}, {{1, 0, 0}, 0}}));
}

/// The page without what its scripts and style sheet say, to look for texts and tags.
std::string markupOf(const std::string& page) {
  std::string markup;
  std::size_t at = 0;
  for (;;) {
    const std::size_t begin = page.find("<script>", at);
    if (begin == std::string::npos) return markup + page.substr(at);
    markup += page.substr(at, begin - at) + "<script>";
    at = page.find("</script>", begin);
  }
}

/// Opening and closing tags must match, as in XML, but for the elements that HTML never closes.
void expectBalanced(const std::string& whole_page) {
  const std::string page = markupOf(whole_page);
  static const std::set<std::string> kVoid{"meta", "img", "input"};
  std::vector<std::string> open;
  // Not by std::regex: its recursion overflows the stack at a picture in an attribute.
  for (std::size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at + 1)) {
    const bool closing = page[at + 1] == '/';
    const std::size_t begin = at + (closing ? 2 : 1);
    std::size_t end = begin;
    while (end < page.size() && std::isalnum(static_cast<unsigned char>(page[end]))) ++end;
    const std::string name = page.substr(begin, end - begin);
    if (name.empty() || kVoid.count(name) != 0) continue;  // <!DOCTYPE html>
    if (!closing) {
      open.push_back(name);
      continue;
    }
    ASSERT_FALSE(open.empty()) << "</" << name << "> closes nothing";
    ASSERT_EQ(open.back(), name);
    open.pop_back();
  }
  EXPECT_TRUE(open.empty()) << "<" << (open.empty() ? "" : open.back()) << "> is never closed";
}

TEST(HtmlReportTest, IsBalancedWithAndWithoutContent) {
  expectBalanced(samplePage());
  expectBalanced(htmlReport({}, test::mapOf({}), {}, {}));
}

TEST(HtmlReportTest, NeedsNothingFromOutside) {
  const std::string page = markupOf(samplePage());
  EXPECT_THAT(page, Not(HasSubstr("http:")));
  EXPECT_THAT(page, Not(HasSubstr("https:")));
  EXPECT_THAT(page, Not(HasSubstr("<script src")));
  EXPECT_THAT(page, Not(HasSubstr("<link")));
  EXPECT_THAT(page, Not(HasSubstr("@import")));
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
}

TEST(HtmlReportTest, ThePictureIsInsideAndHasAnAltText) {
  const MapDocument document = test::mapOf({{{0, 0, 0}, 1}});
  const std::vector<std::uint8_t> png = mapPicturePng(document, MapView::Side);
  const std::string page =
      htmlReport(test::sampleRecord(), document, computeFigures(document), {{MapView::Side, png}});
  EXPECT_THAT(page, HasSubstr("src=\"data:image/png;base64," + encodeBase64(png) + "\""));
  EXPECT_THAT(page, HasSubstr("alt=\"The map from the side"));
  EXPECT_THAT(htmlReport(test::sampleRecord(), document, computeFigures(document), {}),
              Not(HasSubstr("<img")));
}

TEST(HtmlReportTest, NoTextOfARunBecomesMarkup) {
  const std::string attack = "\"'><script>alert(1)</script>&";
  RunRecord record = test::sampleRecord();
  record.program_version = record.command = record.config_file = attack;
  record.pose_source = record.label_set = attack;
  record.inputs = {attack, attack};
  record.parameters = {{attack, attack, attack, attack}};
  record.refused = {{attack, attack, 1}};
  record.warnings = {attack};
  const LabelSet labels = LabelSet::fromYaml(R"(
name: hostile
classes:
  - {id: 0, name: free, color: [255, 255, 255]}
  - {id: 1, name: "\"'><script>alert(1)</script>&", color: [1, 2, 3]}
  - {id: 2, name: "<script>absent</script>", color: [3, 2, 1]}
)",
                                             "hostile labels");
  const std::string page = pageOf(record, test::mapOf({{{0, 0, 0}, 1}}, 1.0, labels));
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, Not(HasSubstr("<script>absent")));
  EXPECT_THAT(page, HasSubstr("&quot;&#39;&gt;&lt;script&gt;alert(1)&lt;/script&gt;&amp;"));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;absent&lt;/script&gt;"));
  expectBalanced(page);
}

TEST(HtmlReportTest, SaysInWordsWhatHappened) {
  const std::string page = samplePage();
  EXPECT_THAT(page, HasSubstr("<h1>Semantic map of my drive.rawlog</h1>"));
  EXPECT_THAT(page, HasSubstr("2 observations with 2,000 points went into the map in 12.3 s, "
                              "0.162 observations a second."));
  EXPECT_THAT(page, HasSubstr("50 points (2.5 %) did not go into the map"));
  EXPECT_THAT(page, HasSubstr("50 were farther from the sensor than <code>max_range</code>"));
  EXPECT_THAT(page, HasSubstr("5 observations of 7 did not reach the map"));
  EXPECT_THAT(page, HasSubstr("5 × <code>CObservationGPS</code>: no range data"));
  EXPECT_THAT(page, HasSubstr("unknown key &#39;resolutoin&#39;"));
  EXPECT_THAT(page, HasSubstr("csom map &#39;my drive.rawlog&#39; -o out"));
  EXPECT_THAT(page, HasSubstr(std::string("Method: ") + toString(Options{}.method) +
                              ". Poses: robot-pose:GT."));
}

TEST(HtmlReportTest, ListsThePresentClassesAndNamesTheAbsentOnes) {
  const std::string page = samplePage();
  EXPECT_THAT(page, HasSubstr("background:#c80000\"></span>ground</td><td>1</td>"));
  EXPECT_THAT(page, HasSubstr("Not in this map: tree, wall, ceiling."));
}

TEST(HtmlReportTest, ShowsTheTimesOfEveryStage) {
  const std::string page = samplePage();
  EXPECT_THAT(page, HasSubstr("kernel inference"));
  EXPECT_THAT(page, HasSubstr("<td>10</td><td>10</td><td>30</td><td>30</td>"));
}

TEST(HtmlReportTest, DrawsTheTimeOfEachObservationAndOfTheRun) {
  const std::string page = samplePage();
  EXPECT_THAT(page, HasSubstr("<h3>Time of each observation</h3>"));
  EXPECT_THAT(page, HasSubstr("\"name\":\"whole insertion\",\"marks\":\"line\",\"dashed\":false,"
                              "\"points\":[[1.0,10.0],[2.0,30.0]]"));
  EXPECT_THAT(page, HasSubstr("<h3>Time of the run</h3>"));
  RunRecord record = test::sampleRecord();
  record.scans.resize(3001, record.scans.front());
  record.scans.back().insert_ms = 77;
  const std::string long_page = pageOf(record, test::mapOf({}));
  EXPECT_THAT(long_page, HasSubstr("the slowest of each 3 in succession"));
  EXPECT_THAT(long_page, HasSubstr("[2998.0,10.0],[3001.0,77.0]]"));
}

TEST(HtmlReportTest, ShowsEveryParameterWithItsUnitAndMeaning) {
  const std::string page = samplePage();
  const Options options;
  visitOptions(options, [&](const OptionInfo& option, const auto& field) {
    EXPECT_THAT(page, HasSubstr(std::string("<code>") + option.key + "</code>"));
    EXPECT_THAT(page, HasSubstr(escapeHtml(fullHelp(option, field))));
  });
  EXPECT_THAT(page, HasSubstr(">0.2 m</td>"));
}

TEST(HtmlReportTest, AnEmptyMapIsExplained) {
  const std::string page = pageOf(test::sampleRecord(), test::mapOf({}));
  EXPECT_THAT(page, HasSubstr("The map is empty"));
  expectBalanced(page);
}

TEST(HtmlReportTest, AFloodOfWarningsIsCutAndCounted) {
  RunRecord record = test::sampleRecord();
  record.warnings.assign(10'000, "the same again");
  const std::string page = pageOf(record, test::mapOf({}));
  EXPECT_THAT(page, HasSubstr("10,000 warnings"));
  EXPECT_THAT(page, HasSubstr("9,800 more are in <code>run.json</code>"));
  EXPECT_LT(markupOf(page).size(), 200'000u);
}

std::string pageOfCameraRun(RunRecord record) {
  return pageOf(record, test::mapOf({{{0, 0, 0}, 1}}));
}

TEST(HtmlReportTest, WithoutCamerasThereIsNothingAboutThem) {
  const std::string page = markupOf(samplePage());
  for (const char* word :
       {"camera", "What became of the points", "registered", "de-skewed", "jpeg"})
    EXPECT_THAT(page, Not(HasSubstr(word)));
}

TEST(HtmlReportTest, ShowsWhatTheCameraSawWithALegendOfItsClasses) {
  RunRecord record = test::sampleRecord();
  record.pictures = {test::samplePicture(CameraPicture::Moment::First, "left"),
                     test::samplePicture(CameraPicture::Moment::Last, "left")};
  record.pictures.back().segmentation = {'o', 't', 'h', 'e', 'r'};
  const std::string page = pageOfCameraRun(record);
  EXPECT_THAT(page, HasSubstr("<h2>What the camera saw</h2>"));
  EXPECT_THAT(page, HasSubstr("data:image/jpeg;base64," + encodeBase64({'s', 'e', 'g'}) + "\""));
  EXPECT_THAT(page,
              HasSubstr("data:image/jpeg;base64," + encodeBase64({'d', 'o', 't', 's'}) + "\""));
  EXPECT_THAT(page, HasSubstr(encodeBase64({'o', 't', 'h', 'e', 'r'})));
  EXPECT_THAT(page, HasSubstr("The first image of <code>left</code>: number 7, time "
                              "1700000000.250 s"));
  EXPECT_THAT(page, HasSubstr("The last image of"));
  EXPECT_THAT(page, HasSubstr("background:#c80000\"></span>ground</li>"));
  EXPECT_THAT(page, HasSubstr("wall</li>"));
  EXPECT_THAT(page, Not(HasSubstr("tree</li>")));
  expectBalanced(page);
}

TEST(HtmlReportTest, SaysWhatBecameOfThePointsInView) {
  RunRecord record = test::sampleRecord();
  record.camera_labels = test::sampleCameraLabels();
  const std::string page = pageOfCameraRun(record);
  EXPECT_THAT(page, HasSubstr("got a label</td><td>6,000</td><td>75 %</td>"));
  EXPECT_THAT(page, HasSubstr("something nearer</td><td>1,000</td><td>12.5 %</td>"));
  EXPECT_THAT(page, HasSubstr("10,000 points of 18,000 (55.6 %) lay in the view of no camera."));
  EXPECT_THAT(page, Not(HasSubstr("as unlabelled")));
  EXPECT_THAT(page, HasSubstr("18 scans got labels from images. 4 scans had no image"));
  EXPECT_THAT(page, HasSubstr("1 of these came when"));
  EXPECT_THAT(page, Not(HasSubstr("time stamps went back")));
  EXPECT_THAT(page, HasSubstr("<code>left</code></td><td class=\"text\">network</td><td>20</td>"
                              "<td>15</td><td>12</td><td>3</td><td>1</td><td>4</td>"));
  EXPECT_THAT(page, HasSubstr("The network alone took 10 s; the rest of the run added 23.4 %"));
  EXPECT_THAT(page, HasSubstr("1,500 were hidden from the camera, or at a label border"));
  EXPECT_THAT(page, HasSubstr("10,000 points outside of the view of all cameras were left out"));
  EXPECT_THAT(page, HasSubstr("200 had a label that the label set ignores"));
  expectBalanced(page);
}

TEST(HtmlReportTest, SaysThatPointsWereKeptAsUnlabelledAndThatTheClockWentBack) {
  RunRecord record = test::sampleRecord();
  record.camera_labels = test::sampleCameraLabels();
  record.camera_labels->points.kept_unlabelled = 11'750;
  record.camera_labels->clock_restarts = 3;
  record.camera_labels->seconds.network = 0;
  const std::string page = pageOfCameraRun(record);
  EXPECT_THAT(page, HasSubstr("11,750 went into the map as unlabelled"));
  EXPECT_THAT(page, HasSubstr("The time stamps went back 3 times."));
  EXPECT_THAT(page, Not(HasSubstr("were hidden from the camera")));
  EXPECT_THAT(page, Not(HasSubstr("were left out")));
  EXPECT_THAT(page, Not(HasSubstr("The network alone")));
}

TEST(HtmlReportTest, SaysHowScansWereRegisteredAndDeskewed) {
  RunRecord record = test::sampleRecord();
  record.registration = RegistrationStatistics{100, 3, 12.5};
  record.deskew = DeskewStatistics{97, 2, 1};
  const std::string page = pageOfCameraRun(record);
  EXPECT_THAT(page, HasSubstr("100 scans registered in 12.5 s, of which 3 fit poorly."));
  EXPECT_THAT(page, HasSubstr("Scans de-skewed: 97, not needed: 2, not possible: 1."));
}

TEST(HtmlReportTest, NoTextOfACameraBecomesMarkup) {
  const std::string attack = "\"'><script>alert(1)</script>&";
  RunRecord record = test::sampleRecord();
  record.camera_labels = test::sampleCameraLabels();
  record.camera_labels->cameras.front().sensor_label = attack;
  record.camera_labels->cameras.front().source = attack;
  record.pictures = {test::samplePicture(CameraPicture::Moment::First, attack)};
  record.pictures.front().timestamp = std::numeric_limits<double>::infinity();
  const std::string page = pageOfCameraRun(record);
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, HasSubstr("&quot;&#39;&gt;&lt;script&gt;"));
  expectBalanced(page);
}

TEST(HtmlTest, Base64MatchesTheVectorsOfRfc4648) {
  const auto encoded = [](const std::string& text) {
    return encodeBase64(std::vector<std::uint8_t>(text.begin(), text.end()));
  };
  EXPECT_EQ(encoded(""), "");
  EXPECT_EQ(encoded("f"), "Zg==");
  EXPECT_EQ(encoded("fo"), "Zm8=");
  EXPECT_EQ(encoded("foo"), "Zm9v");
  EXPECT_EQ(encoded("foobar"), "Zm9vYmFy");
  EXPECT_EQ(encoded("\xff\xfe\xfd"), "//79");
}

TEST(HtmlTest, EscapingKeepsTextAndRemovesControlCharacters) {
  EXPECT_EQ(escapeHtml("a & b"), "a &amp; b");
  EXPECT_EQ(escapeHtml(std::string("a\0b\x1b[1m", 7)), "a b [1m");
  EXPECT_EQ(escapeHtml("naïve"), "naïve");
}

}  // namespace
}  // namespace csom
