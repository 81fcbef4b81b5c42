// SPDX-License-Identifier: BSD-3-Clause
#include <csom/core/Options.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

namespace csom {
namespace {

using testing::HasSubstr;

std::string messageOf(const std::string& key, const std::string& text) {
  Options options;
  try {
    EXPECT_TRUE(setOption(options, key, text)) << key;
    options.validate();
  } catch (const OptionError& error) {
    return error.what();
  }
  return "accepted";
}

std::map<std::string, std::string> textsOf(const Options& options) {
  std::map<std::string, std::string> texts;
  visitOptions(options, [&](const OptionInfo& option, const auto& value) {
    texts[option.key] = toString(value);
  });
  return texts;
}

TEST(Options, EveryFieldSurvivesAsText) {
  Options changed;
  changed.number_of_classes = 20;
  changed.resolution = 0.1 + 0.2;  // 17 digits
  changed.block_depth = 3;
  changed.method = Method::SBki;
  changed.see_csom.rvfm = changed.kernel.aklm = false;
  changed.kernel.shape = Kernel::Linear;
  changed.see_csom.neighbourhood = Neighbourhood::ExtendedBlock;
  changed.scan.ds_resolution = 1.0 / 3;
  changed.free_space.mode = FreeSpace::Raycast;
  Options read;
  for (const auto& [key, text] : textsOf(changed)) ASSERT_TRUE(setOption(read, key, text)) << key;
  EXPECT_EQ(textsOf(read), textsOf(changed));
  EXPECT_EQ(read.resolution, changed.resolution);
  EXPECT_NE(textsOf(read), textsOf(Options()));
}

TEST(Options, DefaultsAreValidAndDerivedLengthsFollowTheResolution) {
  Options options;
  EXPECT_NO_THROW(options.validate());
  options.resolution = 0.3;
  EXPECT_DOUBLE_EQ(options.kernelLengthMin(), 0.9);
  EXPECT_DOUBLE_EQ(options.kernelLengthMax(), 1.5);
  options.kernel.length_max = 2;
  EXPECT_DOUBLE_EQ(options.kernelLengthMax(), 2);
}

TEST(Options, ErrorsNameKeyValueAndWhatIsAccepted) {
  EXPECT_EQ(messageOf("method", "octomap"),
            "method = octomap: expected surface-csom | see-csom | s-bki | s-csm");
  EXPECT_THAT(messageOf("resolution", "0,2"),
              HasSubstr("resolution = 0,2: expected a finite number"));
  EXPECT_THAT(messageOf("resolution", "nan"), HasSubstr("resolution = nan"));
  EXPECT_THAT(messageOf("resolution", "-1"), HasSubstr("resolution = -1: expected a number from"));
  EXPECT_THAT(messageOf("block_depth", "7"), HasSubstr("block_depth = 7: expected 1 to 4"));
  EXPECT_THAT(messageOf("block_depth", "2.5"), HasSubstr("whole number"));
  EXPECT_THAT(messageOf("number_of_classes", "1"), HasSubstr("2 to 256"));
  EXPECT_THAT(messageOf("number_of_classes", "99999999999999"), HasSubstr("whole number"));
  EXPECT_THAT(messageOf("context_neighbours", "8"), HasSubstr("6, 18 or 26"));
  EXPECT_THAT(messageOf("rvfm", "maybe"), HasSubstr("on | off"));
  EXPECT_THAT(messageOf("rvfm", "2"), HasSubstr("on | off"));
  // The words of MRPT's ini files, and what its formulas give.
  for (const char* word : {"yes", "True", "ON", "1.000000e+00", "No", "0"})
    EXPECT_EQ(messageOf("rvfm", word), "accepted") << word;
  EXPECT_EQ(messageOf("block_depth", "2.000000e+00"), "accepted");
  EXPECT_THAT(messageOf("kernel_length_max", "0.1"), HasSubstr("at least kernel_length_min"));
  EXPECT_THAT(messageOf("kernel_length", "1000"), HasSubstr("kernel_length = 1000"));
  EXPECT_THAT(messageOf("prior", "0"), HasSubstr("prior = 0"));
  EXPECT_THAT(messageOf("threads", "-2"), HasSubstr("threads = -2"));
  EXPECT_EQ(messageOf("threads", "0"), "accepted");
  Options options;
  EXPECT_FALSE(setOption(options, "resolutoin", "0.1"));
}

TEST(Options, MergeableMeansSameGridClassesAndPrior) {
  Options a;
  Options b;
  b.method = Method::SBki;
  b.threads = 4;
  EXPECT_TRUE(mergeable(a, b));
  b.resolution = 0.3;
  EXPECT_FALSE(mergeable(a, b));
}

}  // namespace
}  // namespace csom
