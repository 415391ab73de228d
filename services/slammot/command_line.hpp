#pragma once

namespace slammot {

/// Exit codes.
enum ExitCode : int {
  kExitDone = 0,
  kExitFault = 1,      ///< Failed, or outputs are incomplete; one line on stderr gives the reason.
  kExitUsage = 2,      ///< The command line is wrong; one line on stderr states what is expected.
  kExitDoubtful = 2,   ///< `check`: the log can be processed and has doubtful findings.
  kExitLogIsCut = 3,   ///< The log is truncated or damaged; the readable part was processed and
                       ///< written.
  kExitNotJoined = 4,  ///< `map merge`: the two maps share no place that is certain enough; nothing
                       ///< was written.
  kExitInterrupted = 130,  ///< By SIGINT or SIGTERM; `run` has written the processed part.
};

/// Runs the command line `slammot` and returns its exit code.
int run_command_line(int argc, char** argv);

}  // namespace slammot
