// The signal kind `recorder`: acceleration along one direction from the file of a shock recorder, read as in reader.h.
//
// Its fields have the names of the options of the command `record`; missing information is an error, never guessed. The samples are
// conditioned (conditioner.h), a window is cut out and its drift corrected as requested. The signal is linear between samples and 0
// outside. The record is held in memory. Rotation of the recorder is not considered.
#pragma once

#include "mbd/model/signal.h"

namespace steplap {

[[nodiscard]] const SignalKind& recorder_signal_kind();

} // namespace steplap
