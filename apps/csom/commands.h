// SPDX-License-Identifier: BSD-3-Clause
// The sub-commands: each adds itself to the program and runs when chosen. Failures are exceptions:
// ConfigError, OptionError and CLI::Error end with exit code 2, CLI::RuntimeError with its own, any
// other with 1.
#pragma once

#include <CLI/CLI.hpp>

namespace csom {

using AddCommand = void(CLI::App& program);

AddCommand addMapCommand, addInfoCommand, addQueryCommand, addExportCommand, addReportCommand,
    addEvalCommand, addMergeCommand, addRepairCommand, addImportCommand, addSimulateCommand,
    addWithCommand;
/// All, in the order of the help.
constexpr AddCommand* kCommands[] = {addMapCommand,      addInfoCommand,   addQueryCommand,
                                     addExportCommand,   addReportCommand, addEvalCommand,
                                     addMergeCommand,    addRepairCommand, addImportCommand,
                                     addSimulateCommand, addWithCommand};

/// Below `csom eval`.
AddCommand addEvalRunCommand, addEvalPointsCommand, addEvalCameraCommand, addEvalRocCommand;

}  // namespace csom
