// SPDX-License-Identifier: BSD-3-Clause
// csom report: the page and the pictures of a run, made again.
#include <csom/io/MapFile.h>
#include <csom/io/TextParser.h>
#include <csom/report/Report.h>
#include <csom/report/RunRecordReader.h>

#include <cstdio>
#include <memory>
#include <string>

#include "OutputFolder.h"
#include "commands.h"

namespace csom {
namespace {

struct ReportArguments {
  std::string folder;
  std::string output;
  bool no_html = false;
  bool color_blind = false;
};

void runReport(const ReportArguments& arguments) {
  const std::string map_file = arguments.folder + "/map.csom";
  ReportOptions options;
  options.json = false;
  options.pictures = false;
  options.html = !arguments.no_html;
  options.map_picture.color_blind_safe = arguments.color_blind;
  const OutputFolder target(arguments.output.empty() ? arguments.folder : arguments.output,
                            reportFiles(options));
  const MapDocument document = loadMap(map_file);
  const SavedRun run = loadRun(arguments.folder, document);

  StagedResults results(target);
  writeReport(run.record, document, run.figures, results.path(), options);
  results.commit();
  for (const std::string& name : target.results())
    std::printf("%s\n", detail::printable(target.file(name)).c_str());
}

}  // namespace

void addReportCommand(CLI::App& program) {
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command = program.add_subcommand("report", "Make the report of a run again");
  command->add_option("FOLDER", arguments->folder, "What csom map wrote: map.csom and run.json")
      ->required();
  command->add_option("-o,--output", arguments->output,
                      "Folder for report.html and the pictures (default: FOLDER)");
  command->add_flag("--no-html", arguments->no_html, "Write the pictures alone");
  command->add_flag("--color-blind", arguments->color_blind,
                    "Pictures in colours that people with colour-blind eyes tell apart, instead of "
                    "those of the label set");
  command->footer(
      "Reads map.csom and run.json of the folder, and what cameras saw if the pictures are still\n"
      "there.\n\n"
      "Examples:\n"
      "  csom report out\n"
      "  csom report out -o elsewhere --color-blind");
  command->callback([arguments] { runReport(*arguments); });
}

}  // namespace csom
