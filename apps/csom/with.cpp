// SPDX-License-Identifier: BSD-3-Clause
// csom with: one of MRPT's programs, with the plug-in.
#include <csom/core/Error.h>
#include <csom/io/MapFile.h>
#include <csom/io/TextParser.h>
#include <csom/maps/ApplicationIni.h>
#include <csom/maps/PluginFile.h>
#include <csom/report/Format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "ChildProcess.h"
#include "WrittenMaps.h"
#include "commands.h"

namespace csom {
namespace {

void say(const std::string& text) {
  std::fprintf(stderr, "csom: %s\n", detail::printable(text).c_str());
}

bool isIni(const std::string& argument) {
  return std::filesystem::path(argument).extension() == ".ini";
}

/// The ini files that the program will read, as far as the command tells.
std::vector<std::string> iniFiles(const std::vector<std::string>& command,
                                  const MrptApplication* application) {
  if (application != nullptr && !application->ini.empty()) return {application->ini};
  std::vector<std::string> files;
  std::copy_if(command.begin() + 1, command.end(), std::back_inserter(files), isIni);
  return files;
}

/// Throws what is wrong with the first ini file if none of them is as the program needs it.
void check(const std::vector<std::string>& command, const MrptApplication* application,
           const std::vector<std::string>& inis) {
  if (application != nullptr && application->section.empty()) return;  // it reads no ini
  if (inis.empty()) {
    say(command.front() + ": no .ini among its arguments: nothing to check");
    return;
  }
  std::exception_ptr wrong;
  bool found = false;
  for (const std::string& ini : inis) {
    try {
      for (const std::string& warning : checkApplicationIni(ini, application))
        say("warning: " + warning);
      found = true;
    } catch (const ConfigError&) {
      if (!wrong) wrong = std::current_exception();
    }
  }
  if (!found) std::rethrow_exception(wrong);
}

/// The plug-in before what is to be preloaded anyway.
std::string preloaded() {
  const std::string plugin = pluginFile();
  // The dynamic linker splits the variable there, and knows no quotes.
  if (plugin.find_first_of(": ") != std::string::npos)
    throw ConfigError(plugin +
                      " cannot be preloaded: its path has a blank or a colon; install it " +
                      "somewhere else");
  const char* const already = std::getenv("LD_PRELOAD");
  return already == nullptr || *already == '\0' ? plugin : plugin + ":" + already;
}

/// Beginnings of the paths under which the program may leave maps.
std::vector<std::string> resultPrefixes(const std::vector<std::string>& command,
                                        const std::vector<std::string>& inis) {
  std::vector<std::string> prefixes(command.begin() + 1, command.end());
  for (const std::string& ini : inis)
    for (const std::string& folder : listOutputFolders(ini)) prefixes.push_back(folder);
  return prefixes;
}

void tellMap(const std::string& file) {
  try {
    const MapDocument document = loadMap(file);
    say("wrote " + file + ": " + formatCount(document.scans.size(), "observation") + ", " +
        formatCount(document.map.knownVoxelCount(), "known voxel"));
  } catch (const FileError& error) {
    say(std::string("warning: wrote a map that is damaged: ") + error.what());
  }
}

void tellResults(const std::vector<std::string>& command, const MrptApplication* application,
                 const WrittenMaps& maps) {
  const std::vector<std::string> written = maps.sinceThen();
  for (const std::string& file : written) tellMap(file);
  if (!written.empty()) return;
  if (application != nullptr && !application->saves_maps) {
    say(application->program + " has ended; it saves no maps");
  } else {
    say("warning: " + command.front() + " left no map (.csom) in the working folder, under its " +
        "arguments, or in logOutput_dir");
  }
}

/// Returns the program's exit code.
int runWith(const std::vector<std::string>& command) {
  const MrptApplication* const application = findApplication(command.front());
  const std::vector<std::string> inis = iniFiles(command, application);
  check(command, application, inis);
  const std::string preload = preloaded();
  const WrittenMaps maps(resultPrefixes(command, inis));
  const ProgramEnd end = runToItsEnd(command, "LD_PRELOAD", preload);
  if (end.signal != 0)
    say(command.front() + " was ended by signal " + std::to_string(end.signal) + " (" +
        strsignal(end.signal) + ")");
  tellResults(command, application, maps);
  return end.exit_code;
}

}  // namespace

void addWithCommand(CLI::App& program) {
  auto command_line = std::make_shared<std::vector<std::string>>();
  CLI::App* command = program.add_subcommand(
      "with", "Run one of MRPT's programs with the semantic map loaded into it");
  command
      ->add_option("PROGRAM", *command_line,
                   "program and its arguments, after -- if any of them begins with a dash")
      ->required()
      ->expected(1, CLI::detail::expected_max_vector_size);
  command->footer(
      "Sets LD_PRELOAD to the plug-in that belongs to this csom, checks first that an .ini among\n"
      "the arguments defines the map in a way that the program will find (MRPT passes over what\n"
      "it does not know), and tells afterwards which maps came out. The exit code is that of the\n"
      "program, 128 + N if signal N ended it; 2 if nothing was run.\n\n"
      "Examples:\n"
      "  csom with -- icp-slam config/mrpt/icp-slam.ini drive.rawlog\n"
      "  csom with -- observations2map config/mrpt/observations2map.ini drive.simplemap out_\n"
      "  csom with -- rbpf-slam config/mrpt/rbpf-slam.ini drive.rawlog </dev/null\n"
      "  csom with -- SceneViewer3D scene.3Dscene");
  command->callback([command_line] {
    const int exit_code = runWith(*command_line);
    if (exit_code != 0) throw CLI::RuntimeError(exit_code);
  });
}

}  // namespace csom
