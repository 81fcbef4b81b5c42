// SPDX-License-Identifier: BSD-3-Clause
// csom import: data sets become rawlogs.
#include <csom/io/TextParser.h>
#include <csom/rawlog/ImportKittiRaw.h>
#include <csom/rawlog/ImportPcd.h>
#include <csom/rawlog/ImportSemanticKitti.h>
#include <csom/report/Format.h>

#include <cstdio>
#include <map>
#include <memory>

#include "Arguments.h"
#include "CommandLine.h"
#include "OutputPaths.h"
#include "Progress.h"
#include "commands.h"

namespace csom {
namespace {

struct CommonArguments {
  std::string output;
  std::string scans;
  std::size_t every = 1;

  ScanSelection selection() const { return ScanSelection::parse(scans, every); }
};

void addCommonOptions(CLI::App& command, CommonArguments& arguments) {
  command.add_option("-o,--output", arguments.output, "Rawlog to write (gz-compressed)")
      ->required();
  command.add_option("--scans", arguments.scans, "Take the scans a to b-1 of a:b, counted from 0");
  command.add_option("--every", arguments.every, "Take only every N-th scan")
      ->check(CLI::Range(1, 1000000000));
}

ImportProgress shownBy(Progress& progress) {
  return [&progress](std::size_t done, std::size_t total) { progress.update(done, total); };
}

void printSummary(const ImportSummary& summary, const std::string& rawlog) {
  for (const std::string& warning : summary.warnings)
    std::fprintf(stderr, "csom: warning: %s\n", detail::printable(warning).c_str());
  if (summary.points == 0)
    std::fprintf(stderr, "csom: warning: %s holds no point\n", detail::printable(rawlog).c_str());
  std::printf("%s: %s, %s", detail::printable(rawlog).c_str(),
              formatCount(summary.scans, "scan").c_str(),
              formatCount(summary.points, "point").c_str());
  if (summary.images > 0) std::printf(", %s", formatCount(summary.images, "image").c_str());
  std::printf("\nlabels: %s\n",
              detail::printable(withFlags(summary.labels, summary.options)).c_str());
}

void addSemanticKitti(CLI::App& import_command) {
  struct Arguments : CommonArguments {
    SemanticKittiImport request;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = import_command.add_subcommand(
      "semantickitti", "A sequence of SemanticKITTI: velodyne/, poses.txt, calib.txt and labels");
  command->add_option("DIR", arguments->request.folder, "Folder of the sequence")->required();
  command->add_option("--labels", arguments->request.labels,
                      "labels | predictions | FOLDER of *.label files; without it points carry "
                      "their reflectance");
  static const std::map<std::string, SemanticKittiWorld> kWorlds{
      {"velodyne", SemanticKittiWorld::Velodyne}, {"camera", SemanticKittiWorld::Camera}};
  command
      ->add_option(
          "--world", arguments->request.world,
          "Frame of the map: camera (that of poses.txt, y down, default) | velodyne (z up)")
      ->transform(oneOf(kWorlds))
      ->option_text("FRAME");
  addCommonOptions(*command, *arguments);
  command->footer(
      "Examples:\n"
      "  csom import semantickitti sequences/08 --labels predictions -o k.rawlog\n"
      "  csom import semantickitti sequences/08 --labels labels --world velodyne -o z-up.rawlog");
  command->callback([arguments] {
    arguments->request.selection = arguments->selection();
    Progress progress("importing");
    printSummary(importSemanticKitti(arguments->request, arguments->output, shownBy(progress)),
                 arguments->output);
  });
}

void addKittiRaw(CLI::App& import_command) {
  struct Arguments : CommonArguments {
    KittiRawImport request;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = import_command.add_subcommand(
      "kitti-raw", "A drive of the KITTI raw data: velodyne_points/, image_00/ to image_03/");
  command->add_option("DIR", arguments->request.folder, "Folder of the drive")->required();
  command->add_option("--calib", arguments->request.calibration,
                      "Folder of calib_*.txt (default: DIR/calib, DIR, or a folder above it)");
  command->add_flag("--embed-images", arguments->request.embed_images,
                    "Images into the rawlog, without loss, instead of files beside it");
  addCommonOptions(*command, *arguments);
  command->footer(
      "The data set has no poses: give csom map --poses icp, or a trajectory.\n"
      "Example:\n"
      "  csom import kitti-raw 2011_09_26_drive_0001_sync --scans 0:50 -o raw.rawlog");
  command->callback([arguments] {
    arguments->request.selection = arguments->selection();
    Progress progress("importing");
    printSummary(importKittiRaw(arguments->request, arguments->output, shownBy(progress)),
                 arguments->output);
  });
}

void addPcd(CLI::App& import_command) {
  struct Arguments : CommonArguments {
    PcdImport request;
  };
  static const std::map<std::string, PcdRowPolicy> kPolicies{
      {"refuse", PcdRowPolicy::Refuse},
      {"skip", PcdRowPolicy::SkipRow},
      {"ignore-extra", PcdRowPolicy::IgnoreExtra}};
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = import_command.add_subcommand(
      "pcd", "Point clouds in PCD files of any kind, one scan a file");
  command->add_option("FILE", arguments->request.files, "PCD files, or folders of them")
      ->required();
  command->add_flag("--single-scan", arguments->request.single_scan, "All files are one scan");
  command
      ->add_option("--labels", arguments->request.label_field,
                   "Field that holds the class, such as classification or intensity, in any case "
                   "(default: label, if there)")
      ->option_text("FIELD");
  command
      ->add_option("--irregular-rows", arguments->request.row_policy,
                   "Rows with a wrong number of columns, always reported: ignore-extra columns and "
                   "skip shorter rows (default) | skip the row | refuse the file")
      ->transform(oneOf(kPolicies))
      ->option_text("POLICY");
  addCommonOptions(*command, *arguments);
  command->footer(
      "VIEWPOINT is the position of the sensor; points are in the frame of the map.\n"
      "Examples:\n"
      "  csom import pcd scans/*.pcd -o scans.rawlog\n"
      "  csom import pcd room/ --single-scan -o room.rawlog");
  command->callback([arguments] {
    arguments->request.selection = arguments->selection();
    Progress progress("importing");
    requireSeparateOutputs({arguments->output}, arguments->request.files);
    printSummary(importPcd(arguments->request, arguments->output, shownBy(progress)),
                 arguments->output);
  });
}

}  // namespace

void addImportCommand(CLI::App& program) {
  CLI::App* command = program.add_subcommand("import", "Turn a data set into a rawlog");
  command->require_subcommand(1);
  addSemanticKitti(*command);
  addKittiRaw(*command);
  addPcd(*command);
}

}  // namespace csom
