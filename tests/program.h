#pragma once
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "carve/core/file.h"
#include "temporary_folder.h"

namespace carve {

/// What a program did: exit code (128 + signal if it crashed) and what it printed.
struct Outcome {
  int code = 0;
  std::string out, err;
};

/// Runs a shell command.
inline Outcome run_program(const std::string& command) {
  const TemporaryFolder folder;
  const std::string redirected =
      "(" + command + ") >" + (folder / "out").string() + " 2>" + (folder / "err").string() + " </dev/null";
  const int status = std::system(redirected.c_str());
  if (status == -1) throw std::runtime_error("no shell");
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_file(folder / "out"),
          read_file(folder / "err")};
}

}  // namespace carve
