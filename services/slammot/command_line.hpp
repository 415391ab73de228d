#pragma once

namespace slammot {

/// What the program returns to the shell.
enum ExitCode : int {
  kExitDone = 0,
  kExitFault = 1,     ///< Nothing was made, or not everything could be written; one line on stderr
                      ///< says why.
  kExitDoubtful = 2,  ///< `check`: the log can be run, and something in it is doubtful.
  kExitLogIsCut = 3,  ///< The log ends early; what could be read of it was processed and written.
  kExitInterrupted = 130,  ///< By SIGINT or SIGTERM; `run` has written what it had processed by
                           ///< then.
};

/// The command `slammot`: one subcommand a file, each adds itself.
int run_command_line(int argc, char** argv);

}  // namespace slammot
