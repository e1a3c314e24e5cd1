// The signal kind `recorder`: acceleration along one direction from the file of a shock recorder, as reader.h reads it.
//
// Its fields are the options of the command `record` by their names: what the file does not say is asked for, nothing is guessed.
// The samples are conditioned (conditioner.h), a window is cut out, its drift corrected as asked; the signal is linear between
// samples, and 0 outside. Limits: the record is held in memory; a drive by it knows nothing of the recorder's turns.
#pragma once

#include "mbd/model/signal.h"

namespace steplap {

[[nodiscard]] const SignalKind& recorder_signal_kind();

} // namespace steplap
