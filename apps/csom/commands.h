// SPDX-License-Identifier: BSD-3-Clause
// The sub-commands: each adds itself to the program and runs when chosen. Failures are exceptions:
// ConfigError, OptionError and CLI::Error end with exit code 2, CLI::RuntimeError with its own, any
// other with 1.
#pragma once

#include <CLI/CLI.hpp>

namespace csom {

void addSimulateCommand(CLI::App& program);
void addImportCommand(CLI::App& program);
void addMapCommand(CLI::App& program);
void addInfoCommand(CLI::App& program);
void addQueryCommand(CLI::App& program);
void addMergeCommand(CLI::App& program);
void addRepairCommand(CLI::App& program);
void addEvalCommand(CLI::App& program);
/// Below `csom eval`.
void addEvalCameraCommand(CLI::App& eval);
void addEvalPointsCommand(CLI::App& eval);
void addEvalRocCommand(CLI::App& eval);
void addEvalRunCommand(CLI::App& eval);
void addExportCommand(CLI::App& program);
void addReportCommand(CLI::App& program);
void addWithCommand(CLI::App& program);

}  // namespace csom
