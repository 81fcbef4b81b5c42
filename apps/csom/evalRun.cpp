// SPDX-License-Identifier: BSD-3-Clause
// csom eval run: protocols that compare methods, their scores as tables and JSON.
#include <csom/core/Error.h>
#include <csom/io/OutputFile.h>
#include <csom/io/TextParser.h>
#include <csom/protocols/EvaluationJson.h>
#include <csom/protocols/EvaluationPage.h>
#include <csom/protocols/EvaluationTables.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <thread>
#include <utility>

#include "CommandLine.h"
#include "OutputFolder.h"
#include "Progress.h"
#include "commands.h"

namespace csom {
namespace {

constexpr char kJsonFile[] = "evaluation.json";
constexpr char kTablesFile[] = "evaluation.md";
constexpr char kPageFile[] = "evaluation.html";

struct EvalRunArguments {
  std::string protocols;
  std::string output;
  std::string data;
  std::string world;
  std::string methods;
  int threads = 0;
  bool json = false;
};

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

std::vector<std::string> protocolsOf(const std::string& text) {
  if (text != "all") return split(text);
  std::vector<std::string> names;
  for (const ProtocolInfo& info : allProtocols()) names.push_back(info.name);
  return names;
}

EvaluationRequest makeRequest(const EvalRunArguments& arguments) {
  EvaluationRequest request;
  request.protocols = protocolsOf(arguments.protocols);
  const auto methods = arguments.methods.empty() ? defaultMethods() : split(arguments.methods);
  for (const std::string& method : methods) request.methods.push_back(MethodSpec::parse(method));
  request.data = arguments.data;
  if (!arguments.world.empty()) {
    std::vector<std::string*> worlds;
    for (const auto& [name, world] :
         {std::pair{"P4", &request.room_world}, std::pair{"P5", &request.robot_world},
          std::pair{"P8", &request.moving_world}})
      if (std::count(request.protocols.begin(), request.protocols.end(), name) > 0)
        worlds.push_back(world);
    if (worlds.size() != 1)
      throw ConfigError("--world is the world of P4, P5 or P8: run one of them, not " +
                        std::string(worlds.empty() ? "none" : "several"));
    *worlds.front() = arguments.world;
  }
  request.threads = arguments.threads > 0
                        ? arguments.threads
                        : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return request;
}

Evaluation evaluateWithProgress(const EvaluationRequest& request) {
  Progress progress("evaluating");
  return runEvaluation(request, [&](std::size_t done, std::size_t total, const std::string& what) {
    progress.update(done, total, [&](double) { return what; });
  });
}

void write(const std::string& file, const std::string& text) {
  OutputFile output(file);
  output.write(text);
  output.commit();
}

void runEval(const EvalRunArguments& arguments) {
  const EvaluationRequest request = makeRequest(arguments);
  const OutputFolder folder(arguments.output, {kJsonFile, kTablesFile, kPageFile});
  const Evaluation evaluation = evaluateWithProgress(request);
  for (const std::string& warning : evaluation.warnings)
    std::fprintf(stderr, "csom: warning: %s\n", detail::printable(warning).c_str());

  nlohmann::ordered_json json;
  json["created_by"] = "csom " CSOM_VERSION;
  json["command"] = commandLine();
  json.update(toJson(evaluation));
  const std::string json_text =
      json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  const std::string tables = toMarkdown(evaluation);
  StagedResults results(folder);
  write(results.file(kJsonFile), json_text);
  write(results.file(kTablesFile), tables);
  write(results.file(kPageFile), evaluationPage(evaluation));
  results.commit();

  std::fputs(arguments.json ? json_text.c_str() : tables.c_str(), stdout);
  if (evaluation.left_out.empty()) return;
  std::string left_out;
  for (const LeftOutProtocol& left : evaluation.left_out)
    left_out += (left_out.empty() ? "" : "; ") + left.name + ": " + left.reason;
  throw std::runtime_error("left out " + left_out);
}

}  // namespace

void addEvalRunCommand(CLI::App& eval) {
  auto arguments = std::make_shared<EvalRunArguments>();
  if (const char* data = std::getenv("CSOM_DATA")) arguments->data = data;
  CLI::App* command = eval.add_subcommand("run", "Compare methods by the protocols of the docs");
  std::string protocols;
  for (const ProtocolInfo& info : allProtocols())
    protocols += "\n  " + info.name + ": " + info.title;
  command->description("Runs methods on the same inputs and scores them by the same truths:" +
                       protocols);
  command->add_option("PROTOCOLS", arguments->protocols, "Protocols separated by commas, or all")
      ->required();
  command
      ->add_option(
          "-o,--output", arguments->output,
          "Folder for evaluation.json, evaluation.md and evaluation.html; created if missing")
      ->required();
  command->add_option(
      "--data", arguments->data,
      "Folder that holds stanford_conference/ and semantickitti_08/, or is itself a "
      "room (*.pcd with labels) or a street (layout of SemanticKITTI) (default: "
      "$CSOM_DATA)");
  command->add_option("--world", arguments->world,
                      "World file of P4, P5 or P8 (default: room, campus and crossing.yaml)");
  command->add_option("--methods", arguments->methods,
                      "Methods separated by commas, each with options of its own if it is one of "
                      "csom map's: see-csom:rvfm=off:block_depth=1 (default: all)");
  command
      ->add_option("--threads", arguments->threads,
                   "Runs of methods at a time, 0 = a processor each; changes no score")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--json", arguments->json, "Print JSON instead of tables");
  command->footer(
      "Times are those of one thread's processor. A protocol whose data are missing is left out\n"
      "and named, and the exit code is 1.\n"
      "Examples:\n"
      "  csom eval run all -o out/evaluation --data DATA\n"
      "  csom eval run P4 -o out/room --world my-room.yaml --methods see-csom,s-bki\n"
      "  csom eval run P1 -o out/ablation --methods see-csom,see-csom:rvfm=off");
  command->callback([arguments] { runEval(*arguments); });
}

}  // namespace csom
