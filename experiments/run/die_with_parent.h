#pragma once
#include <sys/prctl.h>

#include <boost/process/extend.hpp>
#include <csignal>

namespace carve::experiments {

/// The kernel kills the child when this process dies, however it dies.
struct DieWithParent : boost::process::extend::handler {
  template <class Executor>
  void on_exec_setup(Executor&) const {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
  }
};

}  // namespace carve::experiments
