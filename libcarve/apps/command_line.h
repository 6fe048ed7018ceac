#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <span>

#include "carve/core/options.h"

namespace carve {

/// Exit codes of every program of the project.
enum ExitCode { kDone = 0, kFailed = 1, kBadInput = 2, kCheckFailed = 3 };

/// One flag a field: "smooth.steps" is --smooth-steps; the choice of a stage's arm, "consistency.arm", is
/// --consistency. The fields' structs must outlive the app.
void add_flags(CLI::App& app, std::span<const Field> fields);

/// --threads of the programs that work in parallel: as soon as it is read it holds for every stage.
void add_threads_flag(CLI::App& app);

/// --reference, which must be given: the mesh that others are measured against.
void add_reference_flag(CLI::App& app, std::filesystem::path& reference);

/// Parses, runs, and turns what went wrong into one line on stderr and an exit code: bad usage or input kBadInput, work
/// that could not be done kFailed. `work` returns the exit code otherwise.
int run_program(CLI::App& app, int argc, char** argv, const std::function<int()>& work);

}  // namespace carve
