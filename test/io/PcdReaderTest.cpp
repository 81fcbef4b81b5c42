// SPDX-License-Identifier: BSD-3-Clause
#include <csom/io/PcdReader.h>

#include <cmath>
#include <limits>
#include <random>

#include "io/IoFixtures.h"

namespace csom::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A header; each part can be replaced.
struct Header {
  std::string fields = "x y z label";
  std::string size = "4 4 4 4";
  std::string type = "F F F U";
  std::string count = "1 1 1 1";
  std::string width = "2";
  std::string height = "1";
  std::string points = "2";
  std::string viewpoint = "VIEWPOINT 0 0 0 1 0 0 0\n";
  std::string data = "ascii";

  std::string text() const {
    return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " +
           size + "\nTYPE " + type + "\nCOUNT " + count + "\nWIDTH " + width + "\nHEIGHT " +
           height + "\n" + viewpoint + "POINTS " + points + "\nDATA " + data + "\n";
  }
};

class PcdReaderTest : public testing::Test {
 protected:
  PcdCloud read(const std::string& bytes, PcdRowPolicy policy = PcdRowPolicy::Refuse) const {
    writeBytes(file_, bytes);
    return readPcd(file_, policy);
  }
  std::string errorOf(const std::string& bytes, PcdRowPolicy policy = PcdRowPolicy::Refuse) const {
    return fileErrorOf([&] { read(bytes, policy); });
  }

  TempFolder folder_;
  std::string file_ = folder_ / "cloud.pcd";
};

TEST_F(PcdReaderTest, ReadsAsciiWithLabels) {
  Header header;
  header.viewpoint = "VIEWPOINT 1 2 3 0 0 0 1\n";
  const PcdCloud cloud = read(header.text() + "1 -2.5 3e1 7\n\n0.125 +4 nan 40\r\n");
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3d(1, -2.5, 30));
  EXPECT_EQ(cloud.points[1].head<2>(), Eigen::Vector2d(0.125, 4));
  EXPECT_TRUE(std::isnan(cloud.points[1].z()));
  EXPECT_THAT(cloud.labels, ElementsAre(7, 40));
  EXPECT_EQ(cloud.label_field, "label");
  EXPECT_THAT(cloud.fields, ElementsAre("x", "y", "z", "label"));
  EXPECT_EQ(cloud.viewpoint, Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(cloud.viewpoint_rotation.isApprox(Eigen::Quaterniond(0, 0, 0, 1)));
  EXPECT_EQ(cloud.irregular_rows, 0U);
}

TEST_F(PcdReaderTest, LastLineNeedsNoEnd) {
  EXPECT_EQ(read(Header().text() + "1 2 3 4\n5 6 7 8").points.size(), 2U);
}

TEST_F(PcdReaderTest, FieldsInAnyOrderAmongOthers) {
  Header header;
  header.fields = "intensity normal z label y x";
  header.size = "4 4 4 2 4 4";
  header.type = "F F F U F F";
  header.count = "1 3 1 1 1 1";
  const PcdCloud cloud = read(header.text() + "0.5 9 9 9 3 6 2 1\n0.25 9 9 9 -3 5 -2 -1\n");
  EXPECT_EQ(cloud.points[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(cloud.points[1], Eigen::Vector3d(-1, -2, -3));
  EXPECT_THAT(cloud.labels, ElementsAre(6, 5));
}

TEST_F(PcdReaderTest, ShortHeaderIsEnough) {
  const PcdCloud cloud =
      read("VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3\n");
  EXPECT_EQ(cloud.points[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(cloud.viewpoint, Eigen::Vector3d(0, 0, 0));
  EXPECT_THAT(cloud.labels, IsEmpty());
}

TEST_F(PcdReaderTest, ReadsBinaryOfEveryTypeAndSize) {
  Header header;
  header.data = "binary";
  header.points = header.width = "1";
  header.fields = "label z x pad y intensity";
  header.size = "1 8 4 1 2 4";
  header.type = "U F F U I U";
  header.count = "1 1 1 3 1 1";
  const PcdCloud cloud =
      read(header.text() + bytesOf(std::uint8_t{200}) + bytesOf(1e-9) + bytesOf(2.5F) + "abc" +
           bytesOf(std::int16_t{-300}) + bytesOf(std::uint32_t{4000000000U}));
  EXPECT_EQ(cloud.points[0], Eigen::Vector3d(2.5, -300, 1e-9));
  EXPECT_THAT(cloud.labels, ElementsAre(200));
  EXPECT_EQ(cloud.trailing_bytes, 0U);
}

TEST_F(PcdReaderTest, A7_PaddingOfCountZeroTakesNoBytes) {
  Header header;
  header.data = "binary";
  header.points = header.width = "1";
  header.fields = "x y z _ label _ noise _";
  header.size = "4 4 4 1 2 1 4 1";
  header.type = "F F F U U U U U";
  header.count = "1 1 1 4 1 0 0 3";
  const std::string point =
      bytesOf(1.F) + bytesOf(2.F) + bytesOf(3.F) + "pads" + bytesOf(std::uint16_t{9}) + "pad";
  const PcdCloud cloud = read(header.text() + point);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_THAT(cloud.labels, ElementsAre(9));
  EXPECT_THAT(cloud.fields, ElementsAre("x", "y", "z", "label", "noise"));
  EXPECT_EQ(cloud.trailing_bytes, 0U);
}

TEST_F(PcdReaderTest, A7_NamesInAnyCaseOlderHeadersAndByteOrderMarks) {
  const std::string row = "1 2 3 7\n";
  for (const std::string& header :
       {std::string("VERSION .7\nFIELDS X Y Z Label\nPOINTS 1\nDATA ascii\n"),
        std::string("VERSION .5\nCOLUMNS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\nPOINTS 1\n"
                    "DATA ascii\n"),
        std::string("VERSION 0.6\nFIELDS x y z label\nWIDTH 1\nDATA ascii\n"),
        std::string("version 0.7\nfields x y z LABEL\nwidth 1\nheight 1\ndata ASCII\n"),
        std::string("\xef\xbb\xbf# .PCD v0.7\r\nVERSION 0.7\r\nFIELDS x y z label\r\nPOINTS "
                    "1\r\nDATA ascii\r\n")}) {
    SCOPED_TRACE(header);
    const PcdCloud cloud = read(header + row);
    ASSERT_EQ(cloud.points.size(), 1U);
    EXPECT_EQ(cloud.points[0], Eigen::Vector3d(1, 2, 3));
    EXPECT_THAT(cloud.labels, ElementsAre(7));
  }
  // The exact name wins.
  const PcdCloud both = read("FIELDS LABEL x y z label\nPOINTS 1\nDATA ascii\n5 1 2 3 7\n");
  EXPECT_THAT(both.labels, ElementsAre(7));
}

TEST_F(PcdReaderTest, A7_AnyFieldMayHoldTheLabels) {
  const std::string text = "FIELDS x y z Class ring\nPOINTS 1\nDATA ascii\n1 2 3 7 8\n";
  EXPECT_THAT(read(text).labels, IsEmpty());
  EXPECT_EQ(read(text).label_field, "");
  writeBytes(file_, text);
  EXPECT_THAT(readPcd(file_, PcdRowPolicy::Refuse, "class").labels, ElementsAre(7));
  EXPECT_EQ(readPcd(file_, PcdRowPolicy::Refuse, "class").label_field, "Class");
  EXPECT_THAT(readPcd(file_, PcdRowPolicy::Refuse, "ring").labels, ElementsAre(8));
}

/// The values of each field one after the other, as LZF without any compression: runs of up to 32
/// bytes, each with its length before it.
std::string compressed(const std::string& values) {
  std::string packed;
  for (std::size_t begin = 0; begin < values.size(); begin += 32) {
    const std::string run = values.substr(begin, 32);
    packed += static_cast<char>(run.size() - 1);
    packed += run;
  }
  return bytesOf(static_cast<std::uint32_t>(packed.size())) +
         bytesOf(static_cast<std::uint32_t>(values.size())) + packed;
}

TEST_F(PcdReaderTest, A7_CompressedDataIsRead) {
  Header header;
  header.data = "binary_compressed";
  header.fields = "x y _ z label";
  header.size = "4 4 1 4 2";
  header.type = "F F U F U";
  header.count = "1 1 3 1 1";
  const std::string x = bytesOf(1.F) + bytesOf(4.F);
  const std::string y = bytesOf(2.F) + bytesOf(5.F);
  const std::string z = bytesOf(3.F) + bytesOf(6.F);
  const std::string labels = bytesOf(std::uint16_t{7}) + bytesOf(std::uint16_t{8});
  for (const char* padding : {"", "paddng"}) {  // PCL leaves it out
    const PcdCloud cloud = read(header.text() + compressed(x + y + padding + z + labels) + "rest");
    ASSERT_EQ(cloud.points.size(), 2U);
    EXPECT_EQ(cloud.points[0], Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(cloud.points[1], Eigen::Vector3d(4, 5, 6));
    EXPECT_THAT(cloud.labels, ElementsAre(7, 8));
    EXPECT_EQ(cloud.trailing_bytes, 4U);
  }
}

TEST_F(PcdReaderTest, A7_DamagedCompressedDataIsRefused) {
  Header header;
  header.data = "binary_compressed";
  const std::string good = compressed(std::string(2 * 16, 'v'));
  EXPECT_EQ(read(header.text() + good).points.size(), 2U);
  const auto errorOf = [&](const std::string& data) {
    return fileErrorOf([&] { read(header.text() + data); });
  };
  EXPECT_THAT(errorOf(good.substr(0, 7)), HasSubstr("without its two sizes"));
  EXPECT_THAT(errorOf(good.substr(0, good.size() - 1)), HasSubstr("the file is truncated"));
  EXPECT_THAT(errorOf(compressed(std::string(31, 'v'))), HasSubstr("cannot be 2 points of 16"));
  EXPECT_THAT(errorOf(bytesOf(std::uint32_t{0}) + bytesOf(std::uint32_t{32})),
              HasSubstr("its compressed data is damaged"));
  EXPECT_THAT(errorOf(bytesOf(std::uint32_t{0}) + bytesOf(std::uint32_t{64})),
              HasSubstr("cannot be 2 points"));
  std::string damaged = good;
  damaged[8] = static_cast<char>(0xff);
  EXPECT_THAT(errorOf(damaged), HasSubstr("its compressed data is damaged"));
}

template <class Number>
PcdCloud readOneLabel(const TempFolder& folder, const std::string& type, Number label) {
  Header header;
  header.data = "binary";
  header.points = header.width = "1";
  header.size = "4 4 4 " + std::to_string(sizeof label);
  header.type = "F F F " + type;
  writeBytes(folder / "label.pcd",
             header.text() + bytesOf(1.F) + bytesOf(2.F) + bytesOf(3.F) + bytesOf(label));
  return readPcd(folder / "label.pcd", PcdRowPolicy::Refuse);
}

TEST_F(PcdReaderTest, BinaryLabelsOfEveryType) {
  EXPECT_THAT(readOneLabel(folder_, "U", std::uint16_t{65535}).labels, ElementsAre(65535));
  EXPECT_THAT(readOneLabel(folder_, "U", std::uint64_t{77}).labels, ElementsAre(77));
  EXPECT_THAT(readOneLabel(folder_, "I", std::int8_t{12}).labels, ElementsAre(12));
  EXPECT_THAT(readOneLabel(folder_, "I", std::int32_t{13}).labels, ElementsAre(13));
  EXPECT_THAT(readOneLabel(folder_, "I", std::int64_t{14}).labels, ElementsAre(14));
  EXPECT_THAT(readOneLabel(folder_, "F", 15.F).labels, ElementsAre(15));
  EXPECT_THAT(readOneLabel(folder_, "F", 16.0).labels, ElementsAre(16));
}

TEST_F(PcdReaderTest, LabelsThatAreNoClassIdsAreMarkedAndCounted) {
  for (const double label :
       {-1.0, 1.5, 4294967295.0, 1e30, std::numeric_limits<double>::quiet_NaN()}) {
    const PcdCloud cloud = readOneLabel(folder_, "F", label);
    EXPECT_THAT(cloud.labels, ElementsAre(kNoPcdLabel)) << label;
    EXPECT_EQ(cloud.invalid_labels, 1U);
  }
  EXPECT_THAT(readOneLabel(folder_, "I", std::int32_t{-1}).labels, ElementsAre(kNoPcdLabel));
}

TEST_F(PcdReaderTest, BytesAfterTheLastBinaryPointAreCounted) {
  Header header;
  header.data = "binary";
  header.points = header.width = "1";
  EXPECT_EQ(read(header.text() + std::string(16 + 3889, '\0')).trailing_bytes, 3889U);
}

TEST_F(PcdReaderTest, EmptyCloud) {
  Header header;
  header.points = header.width = "0";
  EXPECT_THAT(read(header.text()).points, IsEmpty());
  header.data = "binary";
  EXPECT_THAT(read(header.text()).points, IsEmpty());
}

// ---- rows with a wrong number of columns --------------------------------------------------------

const std::string kIrregular = Header{}.text() + "1 2 3 4 -1\n5 6 7\n";  // lines 12 and 13

TEST_F(PcdReaderTest, RefusePolicyNamesTheFirstIrregularRow) {
  EXPECT_THAT(errorOf(kIrregular),
              AllOf(HasSubstr("cloud.pcd: line 12: 5 columns"), HasSubstr("announces 4")));
}

TEST_F(PcdReaderTest, SkipPolicyLeavesThemOutAndCounts) {
  const PcdCloud cloud = read(kIrregular, PcdRowPolicy::SkipRow);
  EXPECT_THAT(cloud.points, IsEmpty());
  EXPECT_EQ(cloud.irregular_rows, 2U);
  EXPECT_EQ(cloud.skipped_rows, 2U);
  EXPECT_EQ(cloud.first_irregular_line, 12U);
}

TEST_F(PcdReaderTest, IgnorePolicyUsesRowsWithSurplusColumns) {
  const PcdCloud cloud = read(kIrregular, PcdRowPolicy::IgnoreExtra);
  ASSERT_EQ(cloud.points.size(), 1U);
  EXPECT_EQ(cloud.points[0], Eigen::Vector3d(1, 2, 3));
  EXPECT_THAT(cloud.labels, ElementsAre(4));
  EXPECT_EQ(cloud.irregular_rows, 2U);
  EXPECT_EQ(cloud.skipped_rows, 1U);
}

TEST_F(PcdReaderTest, RowsThatAreNoNumbersNameTheLine) {
  EXPECT_THAT(errorOf(Header().text() + "1 2 3 4\n1 two 3 4\n"),
              HasSubstr("line 13: field 'y' is 'two', expected a number"));
  EXPECT_THAT(errorOf(Header().text() + "1 2 3 4\n1 2 3 4x\n"), HasSubstr("'4x'"));
  EXPECT_THAT(errorOf(Header().text() + "1 2 3 4\n1,5 2 3 4\n"), HasSubstr("'1,5'"));
}

// ---- headers that lie --------------------------------------------------------------------------

struct BadHeader {
  const char* name;
  std::string bytes;
  const char* reason;
};

/// How GoogleTest shows the parameter.
void PrintTo(const BadHeader& value, std::ostream* out) {
  *out << value.name;
}

Header with(std::string Header::*part, const std::string& value) {
  Header header;
  header.*part = value;
  return header;
}

std::string huge(const std::string& data) {
  Header header;
  header.points = header.width = "1000000000000000000";
  header.data = data;
  return header.text() + "1 2 3 4\n";
}

std::string overflowing() {
  Header header;
  header.width = header.height = "10000000000";
  return header.text() + "1 2 3 4\n";
}

std::string hugeCount() {
  Header header = with(&Header::count, "1 1 1 18446744073709551615");
  header.data = "binary";
  return header.text() + std::string(64, '\0');
}

class BadHeaders : public PcdReaderTest, public testing::WithParamInterface<BadHeader> {};

TEST_P(BadHeaders, AreRefusedInOneLine) {
  const std::string message = errorOf(GetParam().bytes, PcdRowPolicy::IgnoreExtra);
  EXPECT_THAT(message, HasSubstr("cloud.pcd: "));
  EXPECT_THAT(message, HasSubstr(GetParam().reason));
  EXPECT_THAT(message, testing::Not(HasSubstr("\n")));
}

const std::string kRows = "1 2 3 4\n5 6 7 8\n";

INSTANTIATE_TEST_SUITE_P(
    All, BadHeaders,
    testing::Values(
        BadHeader{"Empty", "", "is no PCD file"},
        BadHeader{"Zeros", std::string(1000, '\0'), "line 1: unknown entry"},
        BadHeader{"OtherText", "hello world\n", "line 1: unknown entry 'hello'"},
        BadHeader{"HugePointsAscii", huge("ascii"), "more than the 8 bytes after it can hold"},
        BadHeader{"HugePointsBinary", huge("binary"), "only 8 bytes follow"},
        BadHeader{"WidthTimesHeight", overflowing(), "impossibly large"},
        BadHeader{"HugeCount", hugeCount(), "COUNT of field 'label'"},
        BadHeader{"ZeroCount", with(&Header::count, "0 1 1 1").text() + kRows, "FIELDS lacks 'x'"},
        BadHeader{"NegativePoints", with(&Header::points, "-2").text() + kRows,
                  "line 10: POINTS must be followed by one whole number"},
        BadHeader{"PointsNotWidth", with(&Header::points, "3").text() + kRows,
                  "POINTS 3 is not WIDTH 2 times HEIGHT 1"},
        BadHeader{"Size3", with(&Header::size, "4 4 4 3").text() + kRows, "SIZE of field 'label'"},
        BadHeader{"TypeX", with(&Header::type, "F F F X").text() + kRows, "TYPE 'X'"},
        BadHeader{"HalfFloat", with(&Header::size, "4 4 2 4").text() + kRows, "TYPE F and SIZE 2"},
        BadHeader{"FewTypes", with(&Header::type, "F F F").text() + kRows,
                  "TYPE has 3 entries for 4 FIELDS"},
        BadHeader{"NoZ", with(&Header::fields, "x y w label").text() + kRows, "FIELDS lacks 'z'"},
        BadHeader{"Compressed", with(&Header::data, "binary_compressed").text(),
                  "compressed data without its two sizes"},
        BadHeader{"OtherData", with(&Header::data, "morse").text(), "DATA must be"},
        BadHeader{"OtherVersion", "VERSION 0.8\n",
                  "line 1: PCD version '0.8'; versions up to 0.7 are read"},
        BadHeader{"FieldTwice", with(&Header::fields, "x y z x").text(),
                  "two FIELDS are called 'x'"},
        BadHeader{"ViewpointShort", with(&Header::viewpoint, "VIEWPOINT 0 0 0\n").text() + kRows,
                  "line 9: VIEWPOINT must be"},
        BadHeader{"ViewpointNan",
                  with(&Header::viewpoint, "VIEWPOINT nan 0 0 1 0 0 0\n").text() + kRows,
                  "VIEWPOINT must be"},
        BadHeader{"ViewpointZeroRotation",
                  with(&Header::viewpoint, "VIEWPOINT 0 0 0 0 0 0 0\n").text() + kRows,
                  "VIEWPOINT must be"},
        BadHeader{"TooFewRows", Header().text() + "1 2 3 4          \n",
                  "ends after 1 of the 2 points"},
        BadHeader{"TooManyRows", Header().text() + kRows + "9 9 9 9\n",
                  "line 14: more rows than the 2 POINTS"},
        BadHeader{"TruncatedBinary", with(&Header::data, "binary").text() + std::string(31, '\0'),
                  "only 31 bytes follow; the file is truncated"}),
    [](const auto& test) { return test.param.name; });

TEST_F(PcdReaderTest, DamagedHeadersNeverCrash) {
  const std::string good = Header().text() + kRows;
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i) {
    std::string bytes = good;
    for (int k = 0; k < 3; ++k) bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
    writeBytes(file_, bytes);
    try {
      EXPECT_LE(readPcd(file_, PcdRowPolicy::IgnoreExtra).points.size(), 10U);
    } catch (const FileError&) {
    }
  }
}

}  // namespace
}  // namespace csom::test
