// SPDX-License-Identifier: BSD-3-Clause
// csom: rawlogs in; maps, exports and reports out.
#include <csom/core/Error.h>
#include <csom/core/Options.h>

#include <cstdio>
#include <exception>

#include "commands.h"

int main(int argc, char** argv) {
  constexpr int kFailed = 1;
  constexpr int kUsage = 2;

  CLI::App program{"Continuous semantic occupancy maps from MRPT rawlogs."};
  program.set_version_flag("--version", "csom " CSOM_VERSION);
  program.require_subcommand(1);
  program.footer("'csom COMMAND --help' shows the options and examples of a command.\n"
                 "Exit codes: 0 done, 1 failed, 2 wrong usage or configuration.");
  csom::addMapCommand(program);
  csom::addInfoCommand(program);
  csom::addQueryCommand(program);
  csom::addExportCommand(program);
  csom::addEvalCommand(program);
  csom::addMergeCommand(program);
  csom::addImportCommand(program);
  csom::addSimulateCommand(program);

  try {
    program.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : kUsage;
  } catch (const csom::ConfigError& error) {
    std::fprintf(stderr, "csom: %s\n", error.what());
    return kUsage;
  } catch (const csom::OptionError& error) {
    std::fprintf(stderr, "csom: %s\n", error.what());
    return kUsage;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "csom: %s\n", error.what());
    return kFailed;
  }
}
