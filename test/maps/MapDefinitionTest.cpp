// SPDX-License-Identifier: BSD-3-Clause
// The map as ini files define it: every key, and every mistake named.
#include <csom/core/Error.h>
#include <csom/maps/CSemanticContinuousMap.h>
#include <csom/maps/DefaultIni.h>
#include <gmock/gmock.h>
#include <mrpt/config/CConfigFile.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CMultiMetricMap.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "SampleObservations.h"

namespace csom {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using Definition = CSemanticContinuousMap::TMapDefinition;

class MapDefinition : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("csom_map_definition_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "sample.yaml") << sample::sampleLabels().toYaml();
  }

  std::string file(const std::string& text) const {
    const std::string name = (folder_ / "map.ini").string();
    std::ofstream(name) << text;
    return name;
  }
  static std::string section(const std::string& suffix) {
    return "[MappingApplication_semanticContinuousMap_00_" + suffix + "]\n";
  }
  /// An ini with one map and these sections.
  std::string iniOf(const std::string& sections) const {
    return file("[MappingApplication]\nsemanticContinuousMap_count = 1\n" + sections);
  }
  Definition load(const std::string& sections) const {
    return CSemanticContinuousMap::definitionFromIni(iniOf(sections));
  }
  std::string errorOf(const std::string& sections) const {
    try {
      load(sections);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
};

TEST_F(MapDefinition, MinimalIniGivesAnOccupancyMap) {
  const Definition definition = load(section("creationOpts") + "resolution = 0.35\n");
  const CSemanticContinuousMap map(definition);
  EXPECT_EQ(map.map().options().resolution, 0.35);
  EXPECT_EQ(map.map().options().number_of_classes, 2);
  EXPECT_EQ(map.labels().name(), LabelSet::occupancy().name());
  EXPECT_THAT(definition.unknownKeys(), ElementsAre());
}

/// A value other than the default, as text.
struct OtherValue {
  std::string operator()(const std::string& key, double) const {
    return key == "max_range" ? "50.5" : key == "surface_gap" ? "2.5" : "0.5";
  }
  std::string operator()(const std::string& key, int) const {
    return key == "context_neighbours" ? "18" : "3";
  }
  std::string operator()(const std::string&, bool) const { return "off"; }
  std::string operator()(const std::string&, Method) const { return "s-bki"; }
  std::string operator()(const std::string&, Kernel) const { return "linear"; }
  std::string operator()(const std::string&, Neighbourhood) const { return "extended-block"; }
  std::string operator()(const std::string&, FreeSpace) const { return "raycast"; }
};

/// The label set decides, not a key of its own.
bool comesFromLabelSet(const std::string& key) {
  return key == "number_of_classes" || key == "unlabelled_class_id";
}

TEST_F(MapDefinition, EveryCoreOptionIsReadFromEverySection) {
  for (const char* suffix : {"creationOpts", "insertOpts", "insertionOpts"}) {
    std::string keys = section(suffix);
    const Options defaults;
    visitOptions(defaults, [&](const OptionInfo& option, const auto& field) {
      if (!comesFromLabelSet(option.key))
        keys += std::string(option.key) + " = " + OtherValue()(option.key, field) + "\n";
    });
    const Definition definition = load(keys);
    EXPECT_THAT(definition.unknownKeys(), ElementsAre()) << suffix;
    visitOptions(definition.options, [&](const OptionInfo& option, const auto& field) {
      if (comesFromLabelSet(option.key)) return;
      EXPECT_EQ(toString(field), OtherValue()(option.key, field)) << suffix << " " << option.key;
    });
  }
}

TEST_F(MapDefinition, KeysOfTheMap) {
  const Definition definition =
      load(section("creationOpts") + "label_set = sample.yaml ; beside the ini\n" +
           "enableObservationLikelihood = false\n" + section("insertOpts") +
           "point_labels = intensity // comment\n" + "unlabelled_class = road # comment\n" +
           "scan_2d_class = wall\n" + section("likelihoodOpts") +
           "decimation = 3\nmax_distance = 0.5\nsigma = 0.125\nmethod = beam\n"
           "semantic_weight = 2.5\nlabel_error = 0.25\n" +
           section("renderOpts") +
           "occupied_voxels = off\nfree_voxels = on\nunknown_voxels = on\ncolor_by = height\n"
           "visible_only = off\n");
  EXPECT_THAT(definition.unknownKeys(), ElementsAre());
  const CSemanticContinuousMap map(definition);
  EXPECT_EQ(map.labels().name(), "sample");
  EXPECT_EQ(map.map().options().number_of_classes, 4);
  EXPECT_FALSE(map.genericMapParams.enableObservationLikelihood);
  EXPECT_EQ(map.insertionOptions.point_labels, PointLabels::ByIntensity);
  EXPECT_EQ(map.insertionOptions.unlabelled_class, "road");
  EXPECT_EQ(map.insertionOptions.scan_2d_class, "wall");
  EXPECT_EQ(map.likelihoodOptions.decimation, 3);
  EXPECT_EQ(map.likelihoodOptions.max_distance, 0.5);
  EXPECT_EQ(map.likelihoodOptions.sigma, 0.125);
  EXPECT_EQ(map.likelihoodOptions.method, LikelihoodMethod::Beam);
  EXPECT_EQ(map.likelihoodOptions.semantic_weight, 2.5);
  EXPECT_EQ(map.likelihoodOptions.label_error, 0.25);
  EXPECT_FALSE(map.renderingOptions.occupied_voxels);
  EXPECT_TRUE(map.renderingOptions.free_voxels);
  EXPECT_TRUE(map.renderingOptions.unknown_voxels);
  EXPECT_EQ(map.renderingOptions.color_by, VoxelColor::Height);
  EXPECT_FALSE(map.renderingOptions.visible_only);
}

TEST_F(MapDefinition, UnknownKeysAndSectionsAreListed) {
  const std::string prefix =
      (folder_ / "map.ini").string() + " [MappingApplication_semanticContinuousMap_00_";
  const Definition definition =
      load(section("creationOpts") + "resolutoin = 0.3\n" + section("insertOpts") +
           "min_range = 1\nsigma = 1\n" + section("inserOpts") + "max_range = 5\n");
  EXPECT_THAT(definition.unknownKeys(),
              ElementsAre(prefix + "creationOpts] resolutoin", prefix + "insertOpts] sigma",
                          prefix + "inserOpts] max_range"));
}

TEST_F(MapDefinition, WrongValuesAreNamed) {
  EXPECT_THAT(errorOf(section("creationOpts") + "resolution = fine\n"),
              AllOf(HasSubstr("map.ini [MappingApplication_semanticContinuousMap_00_creationOpts]"),
                    HasSubstr("resolution"), HasSubstr("fine")));
  EXPECT_THAT(errorOf(section("insertOpts") + "method = fast\n"),
              AllOf(HasSubstr("method"), HasSubstr("fast"), HasSubstr("s-bki")));
  EXPECT_THAT(errorOf(section("insertOpts") + "point_labels = colour\n"),
              AllOf(HasSubstr("point_labels = colour"), HasSubstr("color")));
  EXPECT_THAT(errorOf(section("insertOpts") + "rvfm = perhaps\n"), HasSubstr("perhaps"));
  EXPECT_THAT(errorOf(section("insertOpts") + "min_range =\n"), HasSubstr("min_range"));
  EXPECT_THAT(errorOf(section("creationOpts") + "resolution = -1\n"), HasSubstr("resolution"));
  EXPECT_THAT(errorOf(section("insertOpts") + "unlabelled_class = lawn\n"),
              HasSubstr("unlabelled_class = lawn"));
  EXPECT_THAT(errorOf(section("likelihoodOpts") + "sigma = 0\n"), HasSubstr("sigma = 0"));
  EXPECT_THAT(errorOf(section("likelihoodOpts") + "decimation = 1.5\n"), HasSubstr("decimation"));
}

TEST_F(MapDefinition, ErrorsAreOneLine) {
  for (const char* keys : {"resolution = fine\n", "label_set = nowhere.yaml\n",
                           "number_of_classes = 7\n", "prior = -2\n"})
    EXPECT_EQ(errorOf(section("creationOpts") + keys).find('\n'), std::string::npos) << keys;
}

TEST_F(MapDefinition, NumberOfClassesComesFromTheLabelSet) {
  EXPECT_THAT(errorOf(section("creationOpts") + "label_set = sample.yaml\nnumber_of_classes = 5\n"),
              AllOf(HasSubstr("number_of_classes = 5"), HasSubstr("'sample' has 4")));
  EXPECT_EQ(load(section("creationOpts") + "label_set = sample.yaml\nnumber_of_classes = 4\n")
                .options.number_of_classes,
            4);
}

TEST_F(MapDefinition, LabelSourcesAndTheirOptions) {
  std::ofstream(folder_ / "network.yaml") << "a description";
  std::ofstream(folder_ / "model.onnx") << "a model";
  const Definition definition =
      load(section("creationOpts") + "label_set = sample.yaml\n" + section("labelSource_00") +
           "sensor_label = front\nsource = network\nnetwork = network.yaml\nmodel = model.onnx\n" +
           section("labelSource_01") +
           "sensor_label = rear\nsource = label_image\nlabel_image = rear_ids\n" +
           section("labelSource_02") + "sensor_label = lidar\nsource = point_labels\n" +
           section("labelOpts") + "label_mode = soft\ntemperature = 2\nmin_confidence = 0.25\n" +
           "low_confidence = soft\nmax_time_offset = 0.5\noutside_view = unlabelled\n" +
           "visibility = off\nvisibility_margin = 0.75\nedge_margin = 4\n" +
           "several_cameras = vote\nlabel_cache = kept\n");
  EXPECT_THAT(definition.unknownKeys(), ElementsAre());
  const LabelOptions& options = definition.labelOpts;
  ASSERT_EQ(options.sources.size(), 3U);
  EXPECT_EQ(options.sources[0].sensor_label, "front");
  EXPECT_EQ(options.sources[0].network, (folder_ / "network.yaml").string());
  EXPECT_EQ(options.sources[0].model, (folder_ / "model.onnx").string());
  EXPECT_EQ(options.sources[1].kind, LabelSource::Kind::LabelImage);
  EXPECT_EQ(options.sources[1].label_image, "rear_ids");
  EXPECT_EQ(options.sources[2].kind, LabelSource::Kind::PointLabels);
  EXPECT_TRUE(options.usesCameras());
  EXPECT_EQ(options.points.label_mode, PointLabellingOptions::LabelMode::Soft);
  EXPECT_EQ(options.points.temperature, 2);
  EXPECT_EQ(options.points.min_confidence, 0.25);
  EXPECT_EQ(options.points.low_confidence, PointLabellingOptions::LowConfidence::Soft);
  EXPECT_EQ(options.max_time_offset, 0.5);
  EXPECT_EQ(options.outside_view, OutsideView::Unlabelled);
  EXPECT_FALSE(options.points.visibility);
  EXPECT_EQ(options.points.visibility_margin, 0.75);
  EXPECT_EQ(options.points.edge_margin, 4);
  EXPECT_EQ(options.points.several_cameras, PointLabellingOptions::SeveralCameras::Vote);
  EXPECT_EQ(options.label_cache, "kept");
}

TEST_F(MapDefinition, PointsOutsideOfViewGiveTheLabelSetAClassForThem) {
  const std::string camera =
      section("labelSource_00") + "sensor_label = a\nsource = label_image\nlabel_image = b\n";
  const Definition definition = load(camera);
  EXPECT_EQ(definition.labels.classByName("unlabelled"), ClassId{2});
  EXPECT_EQ(definition.options.number_of_classes, 3);
  EXPECT_EQ(definition.options.unlabelled_class_id, 2);
  EXPECT_FALSE(load(camera + section("labelOpts") + "outside_view = drop\n")
                   .labels.classByName("unlabelled"));
  EXPECT_FALSE(load("").labels.classByName("unlabelled"))
      << "no camera, nothing outside of its view";
}

TEST_F(MapDefinition, A1_theClassOfUnlabelledPointsIsAddedIfItIsNamedSo) {
  for (const char* key : {"unlabelled_class", "scan_2d_class"}) {
    const Definition definition = load(section("insertOpts") + key + " = unlabelled\n");
    EXPECT_EQ(definition.labels.classByName("unlabelled"), ClassId{2}) << key;
    EXPECT_EQ(definition.options.unlabelled_class_id, 2);
  }
}

TEST_F(MapDefinition, WrongLabelSourcesAreNamed) {
  const std::string first = section("labelSource_00");
  EXPECT_THAT(errorOf(first + "source = network\n"), HasSubstr("sensor_label is missing"));
  EXPECT_THAT(errorOf(first + "sensor_label = a\nsource = network\n"),
              HasSubstr("needs the key network"));
  EXPECT_THAT(
      errorOf(first + "sensor_label = a\nsource = network\nnetwork = nowhere.yaml\n"),
      AllOf(HasSubstr("map.ini [MappingApplication_semanticContinuousMap_00_labelSource_00]"),
            HasSubstr("network = nowhere.yaml: no such file")));
  EXPECT_THAT(errorOf(first + "sensor_label = a\nsource = label_image\n"),
              HasSubstr("needs the key label_image"));
  EXPECT_THAT(errorOf(first + "sensor_label = a\nsource = pixel_labels\nlabel_image = b\n"),
              HasSubstr("label_image = b has no meaning"));
  EXPECT_THAT(errorOf(first + "sensor_label = a\nsource = magic\n"),
              HasSubstr("network | label_image | pixel_labels | point_labels"));
  EXPECT_THAT(errorOf(first + "sensor_label = a\nsource = label_image\nlabel_image = b\n" +
                      section("labelSource_01") + "sensor_label = a\nsource = pixel_labels\n"),
              HasSubstr("sensor_label = a has two label sources"));
  EXPECT_THAT(errorOf(section("labelOpts") + "max_time_offset = -1\n"),
              HasSubstr("max_time_offset = -1"));
  EXPECT_THAT(errorOf(section("labelOpts") + "temperature = 0\n"), HasSubstr("temperature = 0"));
}

TEST_F(MapDefinition, ALabelSourceBehindAGapIsNotOverlooked) {
  EXPECT_THAT(load(section("labelSource_01") + "sensor_label = a\n").unknownKeys(),
              ElementsAre(HasSubstr("labelSource_01] sensor_label")));
}

TEST_F(MapDefinition, MissingLabelSetIsNamed) {
  EXPECT_THAT(errorOf(section("creationOpts") + "label_set = nowhere.yaml\n"),
              HasSubstr("label_set = nowhere.yaml"));
}

TEST_F(MapDefinition, ExactlyOneMapIsNeeded) {
  EXPECT_THROW(CSemanticContinuousMap::definitionFromIni(file("[MappingApplication]\n")),
               ConfigError);
  EXPECT_THROW(CSemanticContinuousMap::definitionFromIni(
                   file("[MappingApplication]\nsemanticContinuousMap_count = 2\n")),
               ConfigError);
  // What MRPT itself throws for an ini; once it went through to the end of the program.
  EXPECT_THROW(
      CSemanticContinuousMap::definitionFromIni(file("[MappingApplication]\na = $eval{\n")),
      ConfigError);
  EXPECT_THROW(CSemanticContinuousMap::definitionFromIni((folder_ / "none.ini").string()),
               ConfigError);
}

TEST_F(MapDefinition, CountsAreAddedUpNotBelieved) {
  const auto error_of = [&](const std::string& counts) -> std::string {
    try {
      CSemanticContinuousMap::definitionFromIni(file("[MappingApplication]\n" + counts));
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(error_of("semanticContinuousMap_count = 2000000000\n"),
              HasSubstr("defines 2000000000 semantic maps"));
  EXPECT_THAT(error_of("semanticContinuousMap_count = 2147483647\n"
                       "CSemanticContinuousMap_count = 2147483647\n"),
              HasSubstr("defines 4294967294 semantic maps"));
  EXPECT_THAT(error_of("semanticContinuousMap_count = 1\nCSemanticContinuousMap_count = -1\n"),
              HasSubstr("CSemanticContinuousMap_count = -1 must not be negative"));
}

TEST_F(MapDefinition, CaseOfSectionsAndKeysDoesNotMatter) {
  const Definition definition = load(section("CreationOpts") + "Resolution = 0.35\n");
  EXPECT_EQ(definition.options.resolution, 0.35);
  EXPECT_THAT(definition.unknownKeys(), ElementsAre());
  EXPECT_THAT(load("[mappingapplication_semanticcontinuousmap_00_inserOpts]\nmax_range = 5\n")
                  .unknownKeys(),
              ElementsAre(HasSubstr("inserOpts] max_range")));
}

TEST_F(MapDefinition, OtherNamesOfTheMapWorkToo) {
  const Definition definition = CSemanticContinuousMap::definitionFromIni(
      file("[M]\nCSemanticContinuousMap_count = 1\n"
           "[M_CSemanticContinuousMap_00_creationOpts]\nresolution = 0.4\n"),
      "M");
  EXPECT_EQ(definition.options.resolution, 0.4);
}

TEST_F(MapDefinition, ApplicationsOfMrptAreWarned) {
  const mrpt::config::CConfigFile ini(
      iniOf(section("creationOpts") + "resolutoin = 0.3\nresolution = 0.5\n"));
  mrpt::maps::TSetOfMetricMapInitializers definitions;
  testing::internal::CaptureStderr();
  definitions.loadFromConfigFile(ini, "MappingApplication");
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              AllOf(HasSubstr("warning"), HasSubstr("resolutoin")));

  mrpt::maps::CMultiMetricMap maps;
  maps.setListOfMaps(definitions);
  const auto map = maps.mapByClass<CSemanticContinuousMap>();
  ASSERT_TRUE(map);
  EXPECT_EQ(map->map().options().resolution, 0.5);
}

TEST_F(MapDefinition, ConfigurationsInMemoryHaveNoFile) {
  mrpt::config::CConfigFileMemory ini;
  ini.setContent("[X_creationOpts]\nresolutoin = 1\n");
  Definition definition;
  definition.load(ini, "X");
  EXPECT_THAT(definition.unknownKeys(), ElementsAre("ini [X_creationOpts] resolutoin"));
}

TEST_F(MapDefinition, DumpShowsEveryKey) {
  std::ostringstream text;
  load(section("creationOpts") + "label_set = sample.yaml\n").dumpToTextStream(text);
  for (const char* key : {"label_set", "resolution", "method", "point_labels", "decimation",
                          "occupied_voxels", "threads"})
    EXPECT_THAT(text.str(), HasSubstr(key));
}

TEST_F(MapDefinition, DefaultIniSaysWhatIsSoAnyway) {
  const Definition read = CSemanticContinuousMap::definitionFromIni(file(defaultIni()));
  EXPECT_THAT(read.unknownKeys(), ElementsAre());
  const auto textOf = [](const Definition& definition) {
    std::ostringstream text;
    definition.dumpToTextStream(text);
    return text.str();
  };
  EXPECT_EQ(textOf(read), textOf(Definition()));
}

}  // namespace
}  // namespace csom
