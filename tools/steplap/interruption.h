// Handles signals that stop a run, such as Ctrl-C: the run ends and its results so far are saved.
#pragma once

#include "mbd/base/stop.h"

#include <string>

namespace steplap {

/// During the lifetime of an object, the first SIGINT, SIGTERM, SIGHUP or SIGXCPU is recorded instead of ending the program. A second
/// signal ends it at once.
class InterruptionGuard {
public:
  InterruptionGuard();
  InterruptionGuard(const InterruptionGuard&) = delete;
  InterruptionGuard& operator=(const InterruptionGuard&) = delete;
  ~InterruptionGuard();
};

/// Makes write errors (file size limit, closed pipe) return an error instead of ending the program by a signal, which would leave temporary
/// files behind. Must be called once, first.
void report_write_errors();
/// Ends the program by SIGPIPE if no process reads from `descriptor` any more.
void end_if_pipe_is_closed(int descriptor);

/// Returns the recorded signal; 0 if there was none.
[[nodiscard]] int recorded_signal();
/// Returns the reason to stop, "stopped by SIGINT"; "" if no signal was recorded. Suitable for RunOptions::stop.
[[nodiscard]] std::string interruption();
/// Ends the program by the recorded signal, so that a calling shell loop ends, too. Does nothing if there was none.
void end_by_recorded_signal();

} // namespace steplap
