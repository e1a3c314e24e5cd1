// A run that is stopped from outside, by Ctrl-C or by whoever ends the session, is saved as far as it came.
#pragma once

#include <string>

namespace steplap {

/// While one of these lives, the first SIGINT, SIGTERM, SIGHUP or SIGXCPU is noted instead of ending the program; a second one ends
/// it at once.
class InterruptionGuard {
public:
  InterruptionGuard();
  InterruptionGuard(const InterruptionGuard&) = delete;
  InterruptionGuard& operator=(const InterruptionGuard&) = delete;
  ~InterruptionGuard();
};

/// What cannot be written, beyond a file's allowed size or to a reader that has gone, is an error that can be told, not the end of
/// the program with temporary files left behind. To be called once, first.
void let_writing_fail();
/// Ends the program by SIGPIPE, as others end, if nobody reads from `descriptor` any more.
void end_if_nobody_reads(int descriptor);

/// The signal noted, 0 if there was none.
[[nodiscard]] int noted_signal();
/// Why to stop: "stopped by SIGINT"; "" if no signal was noted (RunOptions::stop).
[[nodiscard]] std::string interruption();
/// Ends the program by the signal noted, as if nobody had minded it: so that a shell's loop ends, too. Nothing if none was.
void end_by_noted_signal();

} // namespace steplap
