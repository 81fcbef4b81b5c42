// SPDX-License-Identifier: BSD-3-Clause
// csom: rawlogs in; maps, exports and reports out.
#include <csom/core/Error.h>
#include <csom/core/Options.h>
#include <csom/io/TextParser.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <iostream>
#include <new>
#include <string>

#include "CommandLine.h"
#include "StopSignal.h"
#include "commands.h"

namespace {

/// The first word that should be a command and is none, with those that there are; empty if all is
/// well. CLI11 would only say that a sub-command is missing.
std::string unknownCommand(const CLI::App& program, int argc, char** argv) {
  const CLI::App* app = &program;
  for (int i = 1; i < argc && argv[i][0] != '-'; ++i) {
    const auto commands = app->get_subcommands([](const CLI::App*) { return true; });
    if (commands.empty()) return "";
    std::string names;
    const CLI::App* chosen = nullptr;
    for (const CLI::App* command : commands) {
      names += (names.empty() ? "" : ", ") + command->get_name();
      if (command->get_name() == argv[i]) chosen = command;
    }
    if (chosen == nullptr) return "no command '" + std::string(argv[i]) + "'; there are " + names;
    app = chosen;
  }
  return "";
}

/// Texts that were asked for (--help, --version, --print-config) are a success like any other: they
/// must have been written.
void parse(CLI::App& program, int argc, char** argv) {
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& end) {
    if (end.get_exit_code() != 0) throw;
    program.exit(end);
    std::cout.flush();
    if (!std::cout) throw csom::FileError("standard output", "cannot be written");
  }
}

}  // namespace

int main(int argc, char** argv) {
  constexpr int kFailed = 1;
  constexpr int kUsage = 2;
  constexpr int kInterrupted = 128 + SIGINT;
  // A file that may not grow any more is an error like a full disk, not a reason to die.
  std::signal(SIGXFSZ, SIG_IGN);
  const csom::SignalCleanup cleanup;

  CLI::App program{"Continuous semantic occupancy maps from MRPT rawlogs."};
  program.set_version_flag("--version", "csom " CSOM_VERSION);
  program.require_subcommand(1);
  program.footer(
      "'csom COMMAND --help' shows the options and examples of a command.\n"
      "Exit codes: 0 done, 1 failed, 2 wrong usage or configuration, 130 stopped by Ctrl-C.");
  for (csom::AddCommand* add : csom::kCommands) add(program);

  if (const std::string unknown = unknownCommand(program, argc, argv); !unknown.empty()) {
    std::fprintf(stderr, "csom: %s\n", csom::detail::printable(unknown).c_str());
    return kUsage;
  }
  try {
    parse(program, argc, argv);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
      throw csom::FileError("standard output", "cannot be written");
    return 0;
  } catch (const CLI::RuntimeError& error) {
    return error.get_exit_code();
  } catch (const CLI::ParseError& error) {
    program.exit(error);
    return kUsage;
  } catch (const csom::Error& error) {
    std::fprintf(stderr, "csom: %s\n",
                 csom::detail::printable(csom::withFlags(error.what(), error.options())).c_str());
    if (dynamic_cast<const csom::ConfigError*>(&error) != nullptr) return kUsage;
    return dynamic_cast<const csom::Interrupted*>(&error) != nullptr ? kInterrupted : kFailed;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "csom: memory is used up\n");
    return kFailed;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "csom: %s\n", csom::detail::printable(error.what()).c_str());
    return kFailed;
  }
}
